"""Replace WPILib's functions for driver-station data where its simulation differs from a robot.

In the simulation, match information is available before the first packet; a packet that a test delivers attaches a
driver station that was lost; and waiting for a connection waits in wall time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import hal
import hal.simulation
import wpilib
import wpilib.simulation

from ....patch_table import Patch
from ...clock import to_us
from ...threads import cooperative
from ...threads.robot_threads import RobotThread
from ..active_run import active_run
from ..stepping import delivering


def patches() -> list[Patch]:
    """Return the names of WPILib's to replace."""
    return [*_match_information(), _waiting(), *_packets()]


def _text(characters: memoryview) -> str:
    return characters.tobytes().partition(b"\0")[0].decode(errors="replace")


def _match_information() -> list[Patch]:
    def held_back(name: str, read: Callable[[hal.MatchInfo], object]) -> Patch:
        real = getattr(wpilib.DriverStation, name)

        def get() -> Any:
            run = active_run.run
            held = None if run is None else run.connection.held
            return real() if held is None else read(held)

        return Patch(wpilib.DriverStation, name, get)

    return [
        held_back("getEventName", lambda info: _text(info.eventName)),
        held_back(
            "getGameSpecificMessage",
            lambda info: info.gameSpecificMessage.tobytes()[: info.gameSpecificMessageSize].decode(errors="replace"),
        ),
        held_back("getMatchType", lambda info: wpilib.DriverStation.MatchType(int(info.matchType))),
        held_back("getMatchNumber", lambda info: info.matchNumber),
        held_back("getReplayNumber", lambda info: info.replayNumber),
    ]


def _waiting() -> Patch:
    real = wpilib.DriverStation.waitForDsConnection

    def wait_for_connection(timeout: float) -> bool:
        __tracebackhide__ = True
        threads, run = cooperative.scope.taking_part(), active_run.run
        if threads is None or run is None:
            return bool(real(timeout))
        timeout_us = to_us(timeout) if timeout > 0 else None  # 0: for as long as it takes
        waiters: list[RobotThread] = []

        def wake() -> None:
            threads.notify(waiters)

        run.connection.when_connected.append(wake)
        try:
            return threads.wait(waiters, lambda: run.connection.connected, timeout_us)
        finally:
            run.connection.when_connected.remove(wake)

    return Patch(wpilib.DriverStation, "waitForDsConnection", wait_for_connection)


def _packets() -> list[Patch]:
    """Return the functions by which a test delivers packets out of turn: a recorder must record them."""

    return [
        delivering(wpilib.simulation.DriverStationSim, "notifyNewData", wpilib.DriverStation.refreshData),
        delivering(hal.simulation, "notifyDriverStationNewData", None),
    ]
