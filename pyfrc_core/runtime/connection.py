"""The connection between the driver station and the robot: none at boot, packets, lost, and back.

`hal_data` shows what the driver station sends. Only a packet brings it to the robot, and packets come only while
``control.dsAttached`` is true. WPILib's simulation has no such connection: there, each packet also attaches the driver
station again.
"""

from __future__ import annotations

from collections.abc import Callable

from ..wpi import connection, station

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
        self.held: connection.MatchInfo | None = connection.MatchInfo()
        self.when_connected: list[Callable[[], object]] = []
        self._missed = 0
        self._motors_ran = False

    @property
    def connected(self) -> bool:
        """Return whether the last packet has arrived."""
        return self.held is None

    def boot(self) -> None:
        """Show the robot what it sees after power-on: no driver station, alliance, match and joysticks."""
        connection.detach_at_boot()

    def packet(self) -> None:
        """Deliver a packet if a driver station is attached; otherwise it is missed."""
        if not station.is_attached():
            self._miss_packet()
            return
        if station.is_stopped():  # as on a real one, until the roboRIO restarts
            station.disable()
        if self.held is None:
            station.deliver_packet()
        else:
            self.held, self._missed = None, 0
            station.deliver_packet()
            for listener in self.when_connected:
                listener()

    def _miss_packet(self) -> None:
        if self.held is None:
            self._lose()
        self._missed += 1
        since_first_check = self._missed - _FIRST_CHECK
        if self._motors_ran and since_first_check >= 0 and since_first_check % _PACKETS_BETWEEN_CHECKS == 0:
            connection.check_motors_after_loss()

    def _lose(self) -> None:
        """Show the robot the loss: not attached, disabled, and joysticks without axes, buttons and POVs."""
        self.held, self._motors_ran = connection.sent_match(), station.sends_enabled()
        connection.deliver_loss()
