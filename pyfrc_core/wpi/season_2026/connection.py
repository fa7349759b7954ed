"""The connection to the driver station as the robot sees it: none after power-on, or lost."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TypeAlias

import hal
from hal.simulation import (
    getDriverStationAllianceStationId,
    getDriverStationEnabled,
    getDriverStationMatchTime,
    getJoystickCounts,
    getMatchInfo,
    resetDriverStationData,
    setDriverStationAllianceStationId,
    setDriverStationDsAttached,
    setDriverStationEnabled,
    setDriverStationMatchTime,
    setJoystickAxisCount,
    setJoystickButtonCount,
    setJoystickPOVCount,
)
from wpilib import DriverStation, MotorSafety

from .station import JOYSTICKS, deliver_packet, refresh, unplug

#: The match, as the field sends it. Its members are the season's own.
MatchInfo: TypeAlias = hal.MatchInfo


def detach_at_boot() -> None:
    """Show the robot what it sees after power-on: no driver station, alliance, match and joysticks."""
    resetDriverStationData()
    deliver_packet()
    setDriverStationDsAttached(False)
    refresh()


def sent_match() -> MatchInfo:
    """Return the match that packets contain now."""
    info = MatchInfo()
    getMatchInfo(info)
    return info


def deliver_loss() -> None:
    """Show the robot the loss: not attached, disabled, and joysticks without axes, buttons and POVs."""
    with _nothing_new():
        deliver_packet()


def check_motors_after_loss() -> None:
    """Stop the motors that were not updated since the loss.

    WPILib's own check does nothing in a robot that is disabled; on a roboRIO the FPGA cuts the outputs. So WPILib
    sees the robot enabled for as long as the check takes.
    """
    enabled = getDriverStationEnabled()
    with _nothing_new():
        setDriverStationEnabled(True)
        deliver_packet()
        hal.refreshDSData()
        MotorSafety.checkMotors()
        setDriverStationEnabled(enabled)
    hal.refreshDSData()


@contextmanager
def _nothing_new() -> Iterator[None]:
    """Make packets contain no joysticks, and the alliance and match time that the robot has, until the context ends."""
    counts = [getJoystickCounts(stick) for stick in range(JOYSTICKS)]
    alliance, match_time = getDriverStationAllianceStationId(), getDriverStationMatchTime()
    for stick in range(JOYSTICKS):
        unplug(stick)
    setDriverStationAllianceStationId(hal.getAllianceStation()[0])
    setDriverStationMatchTime(DriverStation.getMatchTime())
    try:
        yield
    finally:
        for stick, (axes, buttons, povs) in enumerate(counts):
            setJoystickAxisCount(stick, axes)
            setJoystickButtonCount(stick, buttons)
            setJoystickPOVCount(stick, povs)
        setDriverStationAllianceStationId(alliance)
        setDriverStationMatchTime(match_time)
        setDriverStationDsAttached(False)
