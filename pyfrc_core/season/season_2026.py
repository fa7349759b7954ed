"""The 2026 season: WPILib 2026 on the roboRIO."""

from __future__ import annotations

from datetime import datetime, timezone

from .record import ControllerSoftware, MatchLengths, Packages, Season, SeasonField

SEASON_2026 = Season(
    year=2026,
    kickoff=datetime(2026, 1, 10, 17, tzinfo=timezone.utc),  # noon, Eastern time
    match=MatchLengths(autonomous=15.0, pause=3.0, teleop=135.0),
    field=SeasonField(54.25, 26 + 5 / 12),  # the game manual: 54 ft 3 in by 26 ft 5 in
    controller=ControllerSoftware(
        name="roboRIO",
        images=("2026_v1.2",),
        python=(3, 14),
        home="/home/lvuser",
    ),
    packages=Packages(
        wpilib="2026.2.2",
        commands="robotpy-commands-v2~=2026.2",
        utilities="robotpy-wpilib-utilities~=2026.1",
    ),
    cli_plugins="robotpy_cli.2026",
)
