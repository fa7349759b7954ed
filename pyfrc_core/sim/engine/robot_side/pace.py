"""The speed of robot time compared with the wall clock."""

from __future__ import annotations

import time
from collections import deque

from ....runtime.robot_time import PACKET_US

wall = time.perf_counter

#: A robot that is late by more than this, in wall seconds, does not catch up.
_GIVEN_UP = 1.0
#: The reached speed is measured over this time, in wall seconds.
_RECENT = 0.5
_PACKETS_A_SECOND = 1_000_000 // PACKET_US


class Pace:
    """An absolute schedule: robot time does not drift from the wall clock, however late single packets are.

    :param speed: robot seconds per second; 0 is as fast as possible
    """

    def __init__(self, speed: float, paused: bool) -> None:
        self.speed = speed
        self.paused = paused
        self.packet_seconds = 0.0
        self.late_packets = 0
        self._began_wall, self._began_us = wall(), 0
        self._at_wall, self._at_us = self._began_wall, 0
        self._run_wall, self._run_us = 0.0, 0
        self._recent: deque[tuple[float, int]] = deque()
        self._packets: deque[float] = deque(maxlen=_PACKETS_A_SECOND)

    def begin(self, now_us: int) -> None:
        """Begin a new schedule, after a change of speed or after a pause."""
        self._began_wall, self._began_us = wall(), now_us
        self._at_wall, self._at_us = self._began_wall, now_us
        self._recent.clear()

    def wait_for(self, due_us: int) -> float:
        """Return the wall seconds until robot time may be `due_us`; negative when it is late."""
        if self.speed == 0:
            return 0.0
        due = self._began_wall + (due_us - self._began_us) / 1_000_000 / self.speed
        wait = due - wall()
        if wait < -_GIVEN_UP:
            self._began_wall -= wait
        return wait

    def ran(self, now_us: int) -> None:
        """Note that robot time is at `now_us`."""
        now = wall()
        self._run_wall += now - self._at_wall
        self._run_us += now_us - self._at_us
        self._at_wall, self._at_us = now, now_us
        self._recent.append((now, now_us))
        while now - self._recent[0][0] > _RECENT and len(self._recent) > 2:
            self._recent.popleft()

    def took(self, seconds: float, packets: int = 1) -> None:
        """Note the wall seconds that the robot took for each of these packets."""
        self.packet_seconds = seconds
        if seconds > PACKET_US / 1_000_000:
            self.late_packets += packets
        self._packets.append(seconds)

    @property
    def reached(self) -> float:
        """The robot seconds per second in the recent past."""
        if self.paused or len(self._recent) < 2:
            return 0.0
        (first_wall, first_us), (last_wall, last_us) = self._recent[0], self._recent[-1]
        return (last_us - first_us) / 1_000_000 / max(1e-9, last_wall - first_wall)

    @property
    def average(self) -> float:
        """The robot seconds per second since the robot first ran, without pauses."""
        return self._run_us / 1_000_000 / max(1e-9, self._run_wall)

    @property
    def worst_packet_seconds(self) -> float:
        """The longest time for a packet in the recent past, in wall seconds."""
        return max(self._packets, default=0.0)
