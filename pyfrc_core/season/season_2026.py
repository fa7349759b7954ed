"""The 2026 season: WPILib 2026 on the roboRIO."""

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
)

SEASON_2026 = Season(
    year=2026,
    kickoff=datetime(2026, 1, 10, 17, tzinfo=timezone.utc),  # noon, Eastern time
    match=MatchLengths(autonomous=15.0, pause=3.0, teleop=135.0),
    field=FIELD_2026,
    controller=ControllerSoftware(
        name="roboRIO",
        images=("2026_v1.2",),
        python=(3, 14),
        home="/home/lvuser",
        channels="The roboRIO has PWM 0 to 9, DIO 0 to 9, analog inputs 0 to 3, and relays 0 to 3. Its expansion port "
        "(MXP) has PWM 10 to 19, DIO 10 to 25, and analog inputs 4 to 7. Solenoids: 0 to 7 (CTRE), 0 to 15 (REV).",
        few="8 encoders, 8 counters, 8 interrupts and 1 AddressableLED",
        analog_volts=5.0,
    ),
    packages=Packages(
        wpilib="2026.2.2",
        commands="robotpy-commands-v2~=2026.2",
        utilities="robotpy-wpilib-utilities~=2026.1",
    ),
    downloads=RobotDownloads(  # as robotpy-installer 2026.0.2 asks for them; never seen on a roboRIO
        python="3.14.2",
        python_url="https://github.com/robotpy/roborio-python/releases/download/2026-3.14.2-r1/"
        "python314_3.14.2-r1_cortexa9-vfpv3.ipk",
        python_cache="opkg_cache",
        index="https://wpilib.jfrog.io/artifactory/api/pypi/wpilib-python-release-2026/simple",
        packages="robotpy",
        abi="cp314",
        platforms=("linux_roborio",),
        marker_machine="roborio",
    ),
    dashboards=Dashboards(
        tables=("/SmartDashboard",),
        choice="selected",
        robot_on_field="nt:/SmartDashboard/Field/Robot",
        publishing="SmartDashboard.putData",
    ),
    gamepad=GamepadOrder(
        axes=("left_x", "left_y", "left_trigger", "right_trigger", "right_x", "right_y"),
        buttons=("a", "b", "x", "y", "left_bumper", "right_bumper", "back", "start", "left_stick", "right_stick"),
    ),
    cli_plugins="robotpy_cli.2026",
)
