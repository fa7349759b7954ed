"""What a robot publishes, on one timeline: runs and changes, from what a client of NetworkTables receives.

Each value has the time of the robot's clock. The timeline begins, at 0, when the connection to a program is made: what
was published before is there from the beginning.

Whether the same program is there after a lost connection is seen from what it sends first: a program that goes on
still has values that it published before, with their times. One that was started again has none of them, or its clock
is back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from ...wpi.network_news import Gone, Received
from ..engine.changes import Change, RunBegan, frozen
from ..engine.messages import MODE, NO_CONNECTION, VALUE
from ..engine.structs import SCHEMA
from ..engine.topic_values import TopicValues
from .driver_station import DriverStation, driver_station_in, is_match_time

#: What arrives in this time after the connection, in wall seconds, is what the program had published before.
_FIRST_SECONDS = 0.5
#: Changes within this time are one, in microseconds: less than any robot's loop takes.
_TOGETHER_US = 5_000
#: How far the robot's clock may be behind the last value, in microseconds: computers guess it.
_INEXACT_US = 500_000
#: From how many values at once on their times say how late they are: one of them may have any time.
_MANY = 1000

Entry = RunBegan | Change


class RobotRuns:
    """The runs of the programs of one robot.

    :param add_hal: called with what front ends read of `hal_data`, which is only that runs begin
    :param add_network: called with the runs and changes of NetworkTables
    """

    def __init__(self, add_hal: Callable[[Entry], object], add_network: Callable[[Entry], object]) -> None:
        self._add_hal, self._add_network = add_hal, add_network
        #: The number of the present run; 0: there was no connection yet.
        self.number = 0
        #: The present moment, in seconds of the run.
        self.now = 0.0
        self.station = DriverStation(NO_CONNECTION)
        self._begin_topics()
        #: The mode of the last change; and whether that is a moment without a connection.
        self._mode, self._in_gap = NO_CONNECTION, True
        #: The time of the robot's clock at the beginning of the run, in microseconds.
        self.zero_us = 0
        #: The moment of the last change, in seconds of the run, and the latest time of a value on the robot's clock.
        self._end, self._latest_us = 0.0, 0
        #: The first values after a connection, until it is known whether they are another program's; and until when.
        self._first: list[Received | Gone] | None = None
        self._first_until = 0.0
        #: The robot's clock when the connection was made.
        self._connected_us: int | None = None
        #: The topics that are gone, unless the connection is being lost.
        self._going: dict[str, None] = {}
        self.is_connected = False
        #: How long before they were taken over the last values were set, in seconds.
        self.behind = 0.0

    def _begin_topics(self) -> None:
        self._topics = TopicValues()
        #: The path of the seconds left in the match, if the robot publishes them.
        self.match_time_path: str | None = None
        #: When each topic got its value, on the robot's clock.
        self._times: dict[str, int] = {}

    @property
    def values(self) -> dict[str, Any]:
        """All present values, by path."""
        return self._topics.values

    def connect(self, wall: float, clock_us: int | None) -> None:
        """Note that the connection was made."""
        self.is_connected, self._first, self._first_until = True, [], wall + _FIRST_SECONDS
        self._connected_us, self.behind = clock_us, 0.0

    def lose(self) -> None:
        """Note that the connection was lost. What is known stays."""
        self.is_connected, self._first, self._going = False, None, {}
        if self.number:
            self.station, self._mode, self._in_gap = DriverStation(NO_CONNECTION), NO_CONNECTION, True
            self._end = max(self._end, self.now)
            self._add_network(Change(self._end, {MODE: NO_CONNECTION}))

    def take(self, news: Sequence[Received | Gone], wall: float, clock_us: int | None) -> bool:
        """Take over what was received, and return whether a program was found to have started.

        :param wall: the time of this computer, in seconds
        :param clock_us: that of the robot's clock; None: not known
        """
        if not self.is_connected:
            return False
        began = False
        if self._first is not None:
            self._first += news
            self._connected_us = self._connected_us or clock_us
            if wall < self._first_until or (self.number and not self._first):
                return False
            began = self._take_first(self._first)
            self._first = None
        else:
            self._take_values(self._without_gone(news), clock_us)
        moment = 0.0 if clock_us is None else (clock_us - self.zero_us) / 1_000_000
        self.behind = moment - self._end if len(news) >= _MANY else 0.0
        self.now = max(self.now, self._end, moment)
        return began

    def _take_first(self, news: list[Received | Gone]) -> bool:
        """Take over the first values, and return whether they are another program's."""
        values = [each for each in news if isinstance(each, Received)]
        times = {each.name: each.time_us for each in values}
        connected_us = self._connected_us or max(times.values(), default=0)
        goes_on = any(self._times.get(name) == time_us for name, time_us in times.items())
        is_back = connected_us < self._latest_us - _INEXACT_US
        began = not self.number or is_back or not goes_on
        if began:
            self.number += 1
            self.zero_us, self._latest_us, self._end, self.now = connected_us, 0, 0.0, 0.0
            self._begin_topics()
            self._mode = ""
            for add in (self._add_hal, self._add_network):
                add(RunBegan(self.number, 0.0, {}))
        else:
            self._going = dict.fromkeys(name for name in self._times if name not in times)
        self._take_values([each for each in values if each.time_us <= connected_us], connected_us)
        self._end = max(self._end, (connected_us - self.zero_us) / 1_000_000)
        self._in_gap = False
        self._flush()
        self._take_values([each for each in values if each.time_us > connected_us], connected_us)
        return began

    def _without_gone(self, news: Iterable[Received | Gone]) -> list[Received]:
        """Return the values, after those that went away before were removed.

        That a topic is gone holds from the next call on: a connection that is being lost reports it of all topics.
        """
        gone, self._going = self._going, {}
        values = []
        for each in news:
            if isinstance(each, Received):
                values.append(each)
                gone.pop(each.name, None)
                self._going.pop(each.name, None)
            else:
                self._going[each.name] = None
        for name in gone:
            self._times.pop(name, None)
            self._topics.take(name, "", None)
        if gone:
            self._end = max(self._end, self.now)
            self._flush()
        return values

    def _take_values(self, values: list[Received], clock_us: int | None) -> None:
        now_us = self._latest_us if clock_us is None else clock_us
        # Schemas before what they describe.
        values.sort(key=lambda each: (SCHEMA not in each.name, each.time_us or now_us))
        together_until, names = 0, set[str]()
        for name, type_name, value, given_us in values:
            time_us = given_us or now_us
            if names and (time_us > together_until or name in names):
                self._flush()
                names.clear()
            if not names:
                together_until = time_us + _TOGETHER_US
                self._end = max(self._end, (time_us - self.zero_us) / 1_000_000)
            names.add(name)
            if self.match_time_path is None and name not in self._times and is_match_time(VALUE + name):
                self.match_time_path = VALUE + name
            self._times[name] = time_us
            self._latest_us = max(self._latest_us, time_us)
            self._topics.take(name, type_name, value)
        if names:
            self._flush()

    def _flush(self) -> None:
        """Add what has changed, at the moment `_end`."""
        changed, lost = self._topics.changes()
        found = {path: frozen(each) for path, each in changed.items()}
        if not self._in_gap:
            self.station = driver_station_in(self.values)
            if self.station.mode != self._mode:
                self._mode = found[MODE] = self.station.mode
        if found or lost:
            self._add_network(Change(self._end, found, tuple(lost)))
