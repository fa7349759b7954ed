"""The 2027 season: WPILib 2027 on SystemCore."""

from __future__ import annotations

from datetime import datetime, timezone

from .field_2026 import FIELD_2026
from .record import (
    ControllerSoftware,
    Dashboards,
    GamepadOrder,
    MatchLengths,
    Packages,
    RobotDownloads,
    Season,
    SeasonField,
)

#: WPILib is an alpha; the match and the field are 2026's until the kickoff.
SEASON_2027 = Season(
    year=2027,
    kickoff=datetime(2027, 1, 9, 17, tzinfo=timezone.utc),  # noon, Eastern time, on the second Saturday
    match=MatchLengths(autonomous=15.0, pause=3.0, teleop=135.0),
    field=SeasonField(FIELD_2026.w, FIELD_2026.h),
    controller=ControllerSoftware(
        name="SystemCore",
        images=("14",),  # goes with this preview; pyfrc cannot see which one a controller has
        python=(3, 14),
        home="/home/systemcore",
        channels="Solenoids: 0 to 7 (CTRE), 0 to 15 (REV).",
        few="8 encoders",
        analog_volts=3.3,
    ),
    packages=Packages(
        wpilib="2027.0.0a7",
        commands="robotpy-commands-v2~=2027.0.0a7",
        utilities="robotpy-wpilib-utilities~=2027.0.0a7",
        drivers=("wpilib-drivers~=2027.0.0a7",),
    ),
    downloads=RobotDownloads(  # as robotpy-installer 2027.0.0a10 asks for them
        python="3.14.3",
        python_url="https://github.com/astral-sh/python-build-standalone/releases/download/20260310/"
        "cpython-3.14.3+20260310-aarch64-unknown-linux-gnu-install_only_stripped.tar.gz",
        python_cache="pkg_cache",
        index="https://wpilib.jfrog.io/artifactory/api/pypi/wpilib-python-release-2027/simple",
        packages="robotpy",
        abi="cp314",
        platforms=(
            "linux_systemcore",
            *(f"manylinux_2_{minor}_aarch64" for minor in range(38, 16, -1)),
            "linux_aarch64",
        ),
        marker_machine="systemcore",
    ),
    dashboards=Dashboards(
        tables=("/Telemetry", "/Tunables"),
        choice="selected/tune",
        robot_on_field="nt:struct:Pose2d[]:/Tunables/Field/Robot",
        publishing="tunables.publish or telemetry.log",
        in_radians=True,
    ),
    gamepad=GamepadOrder(
        axes=("left_x", "left_y", "right_x", "right_y", "left_trigger", "right_trigger"),
        buttons=(
            *("a", "b", "x", "y", "back", "guide", "start", "left_stick", "right_stick", "left_bumper", "right_bumper"),
            *("up", "down", "left", "right"),
        ),
    ),
    cli_plugins="robotpy_cli.2027",
    opmodes=True,
    first_button=0,
    window_drives=False,  # seen with 2027.0.0a7: it takes pyfrc's packets for those of another driver station
    test_mode="Utility",
)
