"""Replace WPILib's functions for driver-station data where its simulation differs from a robot.

In the simulation, match information is available before the first packet, and a packet that a test delivers attaches a
driver station that was lost.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import hal
import hal.simulation
import wpilib
import wpilib.simulation

from ....patch_table import Patch
from ....wpi.season_2027.connection import MatchInfo
from ..active_run import active_run
from ..stepping import delivering


def patches() -> list[Patch]:
    """Return the names of WPILib's to replace."""
    return [*_match_information(), *_packets()]


def _match_information() -> list[Patch]:
    def held_back(owner: Any, name: str, read: Callable[[MatchInfo], object]) -> Patch:
        real = getattr(owner, name)

        def get() -> Any:
            run = active_run.run
            held: Any = None if run is None else run.connection.held
            return real() if held is None else read(held)

        return Patch(owner, name, get)

    table: list[Patch] = []
    for owner in (wpilib.MatchState, wpilib.DriverStationBackend):
        table += [
            held_back(owner, "get_event_name", lambda info: info.event_name),
            held_back(owner, "get_game_data", lambda info: info.game_data or None),
            held_back(owner, "get_match_type", lambda info: wpilib.MatchType(info.match_type)),
            held_back(owner, "get_match_number", lambda info: info.match_number),
            held_back(owner, "get_replay_number", lambda info: info.replay_number),
        ]
    return table


def _packets() -> list[Patch]:
    """Return the functions by which a test delivers packets out of turn: a recorder must record them."""

    return [
        delivering(wpilib.simulation.DriverStationSim, "notify_new_data", wpilib.DriverStationBackend.refresh_data),
        delivering(hal.simulation, "notify_driver_station_new_data", None),
    ]
