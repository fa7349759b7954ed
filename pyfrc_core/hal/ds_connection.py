"""The connection between the driver station and the robot: none at boot, packets, lost, and back.

`hal_data` shows what the driver station sends. Only a packet brings it to the robot, and packets come only while
``control.dsAttached`` is true. WPILib's simulation has no such connection: there, each packet also attaches the driver
station again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import hal
from hal import simulation as hs
from wpilib import DriverStation, MotorSafety

from .modes import JOYSTICKS, unplug
from .timing import deliver_packet

#: Motors expire after 0.1 s without a new value, unless robot code sets another time: the first packet after that, and
#: then every fourth, as while packets come.
_FIRST_CHECK, _PACKETS_BETWEEN_CHECKS = 6, 4


class DriverStationConnection:
    """The connection of one run.

    Attributes:
        held: the match information that the robot has while no packets come; None while they come
        when_connected: called after the first packet, and after the first one that follows a loss
    """

    def __init__(self) -> None:
        self.held: hal.MatchInfo | None = hal.MatchInfo()
        self.when_connected: list[Callable[[], object]] = []
        self._missed = 0
        self._motors_ran = False

    @property
    def connected(self) -> bool:
        """Return whether the last packet has arrived."""
        return self.held is None

    def boot(self) -> None:
        """Show the robot what it sees after power-on: no driver station, alliance, match and joysticks."""
        hs.resetDriverStationData()
        deliver_packet()
        hs.setDriverStationDsAttached(False)
        DriverStation.refreshData()

    def packet(self) -> None:
        """Deliver a packet if a driver station is attached; otherwise it is missed."""
        if not hs.getDriverStationDsAttached():
            self._miss_packet()
            return
        if hs.getDriverStationEStop():  # as on a real one, until the roboRIO restarts
            hs.setDriverStationEnabled(False)
        if self.held is None:
            deliver_packet()
        else:
            self.held, self._missed = None, 0
            deliver_packet()
            for listener in self.when_connected:
                listener()

    def _miss_packet(self) -> None:
        if self.held is None:
            self._lose()
        self._missed += 1
        since_first_check = self._missed - _FIRST_CHECK
        if self._motors_ran and since_first_check >= 0 and since_first_check % _PACKETS_BETWEEN_CHECKS == 0:
            self._check_motors()

    def _lose(self) -> None:
        """Show the robot the loss: not attached, disabled, and joysticks without axes, buttons and POVs."""
        self.held = hal.MatchInfo()
        hs.getMatchInfo(self.held)
        self._motors_ran = bool(hs.getDriverStationEnabled())
        with _nothing_new():
            deliver_packet()

    def _check_motors(self) -> None:
        """Stop the motors that were not updated since the loss.

        WPILib's own check does nothing in a robot that is disabled; on a roboRIO the FPGA cuts the outputs. So WPILib
        sees the robot enabled for as long as the check takes.
        """
        enabled = hs.getDriverStationEnabled()
        with _nothing_new():
            hs.setDriverStationEnabled(True)
            deliver_packet()
            hal.refreshDSData()
            MotorSafety.checkMotors()
            hs.setDriverStationEnabled(enabled)
        hal.refreshDSData()


@contextmanager
def _nothing_new() -> Iterator[None]:
    """Make packets contain no joysticks, and the alliance and match time that the robot has, until the context ends."""
    counts = [hs.getJoystickCounts(stick) for stick in range(JOYSTICKS)]
    alliance, match_time = hs.getDriverStationAllianceStationId(), hs.getDriverStationMatchTime()
    for stick in range(JOYSTICKS):
        unplug(stick)
    hs.setDriverStationAllianceStationId(hal.getAllianceStation()[0])
    hs.setDriverStationMatchTime(DriverStation.getMatchTime())
    try:
        yield
    finally:
        for stick, (axes, buttons, povs) in enumerate(counts):
            hs.setJoystickAxisCount(stick, axes)
            hs.setJoystickButtonCount(stick, buttons)
            hs.setJoystickPOVCount(stick, povs)
        hs.setDriverStationAllianceStationId(alliance)
        hs.setDriverStationMatchTime(match_time)
        hs.setDriverStationDsAttached(False)
