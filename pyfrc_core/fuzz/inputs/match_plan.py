"""Plan a fuzzed match: its modes and their lengths, the field's messages, and disturbances."""

from __future__ import annotations

import random
import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from ...config.settings import MatchSettings
from ...runtime.clock import PACKET_US
from ...runtime.scripts.script import InputScript
from ...runtime.scripts.sensors import written_once
from ...runtime.scripts.targets import MATCH_TIME, MODE, PACKET, REMAINING, RESTART, plugged
from ...wpi import station
from .values import Value

#: The length of a short match in seconds: most failures need no more, and a real robot's loop takes long.
SHORT_SECONDS = 5.0
#: What a seed ends with whose match is short.
SHORT = " short"
#: How many times as fast as usual its drivers are: it has room for little.
_HASTES = (1.0, 2.0)
#: The share of the other matches that are as long as real ones, half of them as two in a row, and how much longer than
#: usual these are at most.
_WHOLE, _LONGER = 1 / 30, 12

#: The functions of a robot for each of its modes.
MODE_FUNCTIONS = tuple(
    f"{mode}{part}" for mode in ("autonomous", "teleop", "test") for part in ("Init", "Periodic", "Exit")
)
#: How often one mode is repeated, and how often then.
_REPEATED, _TIMES = 0.15, (3, 3, 4, 5)

#: How often each port's joystick is unplugged, relative to the others: the driver's most often.
_UNPLUGGED = (20, 6, 1, 1, 1, 1)

#: The disabled mode that comes before each mode.
_BEFORE = {"autonomous": "disabled autonomous", "teleop": "disabled", "test": "disabled test"}


_STATIONS = ("red1", "red2", "red3", "blue1", "blue2", "blue3")

#: Names of events, as the field sends them.
_EVENTS = ("CASJ", "2026casj", "NYRO", "Einstein")
#: The highest match numbers of large events.
_MOST_MATCHES = {"practice": 60, "qualification": 130, "elimination": 16}
_REPLAYS = (1, 1, 1, 2, 3)

#: How often the robot is ready before its driver station, and the driver station before it knows the alliance; and for
#: how many seconds at most it does not: also for the whole match.
_NO_STATION, _NO_ALLIANCE = 0.1, 0.2
_UNKNOWN_FOR = (0.1, 2.0, 20.0, 1000.0)
#: How often the driver station counts the time without a field, in its practice mode; else it sends -1.
_PRACTICE = 0.6

#: The seconds left that the driver station sends when it does not count them.
NOT_COUNTED = -1.0


class FieldData:
    """What is known of one match.

    :ivar at_start: what is written before the robot starts
    :ivar later: what is written later, and when, in seconds
    :ivar counts: whether the time left is known
    """

    def __init__(self, rng: random.Random) -> None:
        self.at_start: dict[str, Value] = {}
        self.later: tuple[float, dict[str, Value]] | None = None
        station, how = rng.choice(_STATIONS), rng.random()
        if how < _NO_STATION:
            self.at_start |= {"control.dsAttached": False, "alliance_station": "unknown"}
            self.later = (rng.uniform(0.1, 0.5), {"control.dsAttached": True, "alliance_station": station})
        elif how < _NO_STATION + _NO_ALLIANCE:
            self.at_start["alliance_station"] = "unknown"
            self.later = (rng.choice(_UNKNOWN_FOR) * rng.random(), {"alliance_station": station})
        else:
            self.at_start["alliance_station"] = station
        if rng.random() < 0.5:
            self.counts = True
            self.at_start |= {
                "control.fmsAttached": True,
                "event.match_type": (sort := rng.choice(("qualification", "qualification", "elimination", "practice"))),
                "event.match_number": rng.randint(1, _MOST_MATCHES[sort]),
                "event.replay_number": rng.choice(_REPLAYS),
                "event.name": rng.choice(_EVENTS),
            }
        else:
            self.counts = rng.random() < _PRACTICE
            if self.counts:
                self.at_start["event.match_type"] = "practice"
            if rng.random() < 0.5:
                self.at_start["event.name"] = ""


@dataclass(frozen=True)
class MatchEvent:
    """An event of a match.

    :param at_us: its time, which is that of a packet
    :param writes: what it writes, by target
    """

    at_us: int
    writes: dict[str, Value]


@dataclass(frozen=True)
class _Period:
    """A period of a match.

    :param undisturbed: whether nothing happens in it except its drivers' and sensors' inputs
    """

    mode: str
    seconds: float
    undisturbed: bool = False


def plan_match(
    rng: random.Random,
    seconds: float,
    settings: MatchSettings,
    messages: Sequence[str] = (),
    overrides: Collection[str] = (),
) -> list[MatchEvent]:
    """Return all events of a match, in order.

    :param seconds: the length of the match; its periods are as long as `settings` says, or shorter
    :param messages: the messages that the field may send, if they are known
    :param overrides: those of `MODE_FUNCTIONS` that the robot has, as far as it is known
    """
    planner = _Planner(rng, settings, tuple(messages))
    now = 0.0
    planner.before()
    periods, restarts = _periods(rng, seconds, settings, overrides)
    for period in periods:
        planner.period(now, period)
        now += period.seconds
    if restarts:
        planner.restart(rng.uniform(0.15, 0.85) * seconds)
    if rng.random() < 0.03:
        planner.stop_for_good(rng.uniform(0.9, 1) * seconds)
    return sorted(planner.events, key=lambda event: event.at_us)


def without_restarts(events: Sequence[MatchEvent]) -> list[MatchEvent]:
    """Return the events for a robot whose program cannot be started again."""
    for event in events:
        event.writes.pop(RESTART, None)
    return list(events)


def _periods(
    rng: random.Random, seconds: float, settings: MatchSettings, overrides: Collection[str]
) -> tuple[list[_Period], bool]:
    """Return the periods of a match, and whether the robot program is started again in it.

    In some cases, the periods are those of a pit test, of a match that is restarted or the second one of a robot
    program, or of a program that starts in the middle of a match; or one mode is repeated, as in a pit.
    """
    if seconds > 1.5 * seconds_of(settings):  # two in a row, without a restart of the robot program
        first, _ = _periods(rng, seconds / 2, settings, overrides)
        second, _ = _periods(rng, seconds / 2, settings, overrides)
        return [*first, *second], False
    # What depends on the number of times is in what is called once each time.
    entered = [mode for mode in _BEFORE if {f"{mode}Init", f"{mode}Exit"}.intersection(overrides)]
    if entered and rng.random() < _REPEATED:
        mode, times = rng.choice(entered), rng.choice(_TIMES)
        part = seconds / times
        return [_Period(_BEFORE[mode], 0.2 * part), _Period(mode, 0.8 * part)] * times, False
    before = min(settings.before, 0.05 * seconds)
    autonomous = min(settings.autonomous, 0.3 * seconds)
    pause = min(settings.pause, 0.05 * seconds)
    teleop = seconds - before - autonomous - pause
    ready = _Period("disabled autonomous" if rng.random() < 0.7 else "disabled", before)
    periods = [ready, _Period("autonomous", autonomous), _Period("disabled", pause)]
    how, restarts = rng.random(), False
    if any(name.startswith("test") for name in overrides) and rng.random() < 0.1:
        how = 0.1
    if how < 0.08:  # no autonomous
        periods = [_Period("disabled", before)]
    elif how < 0.14:  # the pit crew tries test mode
        periods = [_Period("disabled test", before), _Period("test", 0.1 * teleop), *periods]
    elif how < 0.22:  # the first autonomous period is aborted
        periods = [ready, _Period("autonomous", rng.uniform(0.1, 0.9) * autonomous), *periods]
    elif how < 0.27:  # the drivers practise before
        periods = [_Period("disabled", before), _Period("teleop", 0.3 * teleop), *periods]
    elif how < 0.305:  # the robot program is started again, after a crash or a brown-out
        restarts = True
    elif how < 0.34:  # no pause
        periods[-1] = _Period("disabled", PACKET_US / 1_000_000)
    elif how < 0.44:  # autonomous at its real length
        autonomous = max(autonomous, min(settings.autonomous, 0.6 * seconds))
        periods[1] = _Period("autonomous", autonomous, undisturbed=rng.random() < 0.7)
    elif how < 0.51:  # the robot program is first started in teleoperated
        periods = []
    elif how < 0.54:  # in autonomous
        periods = [_Period("autonomous", rng.uniform(0.2, 0.9) * autonomous), _Period("disabled", pause)]
    elif how < 0.61:  # a second match without a restart of the robot program
        first = [ready, _Period("autonomous", 0.5 * autonomous), _Period("disabled", pause)]
        periods = [*first, _Period("teleop", rng.uniform(0.1, 0.4) * teleop), *periods]
    return [*periods, _Period("teleop", seconds - sum(period.seconds for period in periods))], restarts


class _Planner:
    def __init__(self, rng: random.Random, settings: MatchSettings, messages: tuple[str, ...]) -> None:
        self.events: list[MatchEvent] = []
        self._rng = rng
        self._messages = messages
        how = rng.random()
        #: Whether the match time begins with the period's real length.
        self._real_times = how < 0.25
        #: How long the match time is 0 at the end of each period: whole seconds are sent, and the last one is none.
        self._at_zero = 1.0 if how > 0.75 else 0.0
        self._settings = settings
        self._field = FieldData(rng)
        #: When the field sends the game message: before the match, with autonomous, with teleoperated (2020), or never.
        self._message_with = rng.choice(("at once", "autonomous", "autonomous", "autonomous", "teleop", "never"))

    def add(self, at: float, writes: dict[str, Value]) -> None:
        self.events.append(MatchEvent(round(at * 1_000_000 / PACKET_US) * PACKET_US, writes))

    def stop_for_good(self, at: float) -> None:
        """Add an emergency stop: the driver station does not enable the robot again."""
        self.add(at, {"control.eStop": True, MODE: "disabled"})
        stopped_us = self.events[-1].at_us
        for event in self.events[:-1]:
            if event.at_us >= stopped_us:
                event.writes.pop(MODE, None)

    def restart(self, at: float) -> None:
        """Add a restart of the robot program; the driver station is connected again after a while."""
        rng = self._rng
        if rng.random() < 0.5:  # a brown-out
            self.add(
                max(0.0, at - rng.choice((0.02, 0.1, 0.5))), {"power.vin_voltage": round(rng.uniform(4.5, 6.5), 2)}
            )
        self.add(at, {RESTART: True})
        if rng.random() < 0.7:
            self.add(at, {"control.dsAttached": False})
            self.add(at + rng.choice((0.02, 0.1, 0.5, 2.0)), {"control.dsAttached": True})

    def before(self) -> None:
        """Add the state in which the robot starts."""
        now = dict(self._field.at_start)
        if not self._field.counts:
            now[REMAINING] = NOT_COUNTED
        if self._field.later is not None:
            self.add(*self._field.later)
        if self._message_with == "at once":
            now["event.game_specific_message"] = self._message()
        self.add(0, now)

    def period(self, start: float, period: _Period) -> None:
        """Add one period and its disturbances."""
        rng, enabled = self._rng, period.mode in _BEFORE
        now: dict[str, Value] = {MODE: period.mode}
        if self._field.counts:
            now[MATCH_TIME] = round(self._seconds_left(period), 3) if enabled else 0.0
        if period.mode == self._message_with:
            late = 0.0 if rng.random() < 0.7 else rng.uniform(0, period.seconds)
            if late:
                self.add(start + late, {"event.game_specific_message": self._message()})
            else:
                now["event.game_specific_message"] = self._message()
        self.add(start, now)
        if period.undisturbed:
            return
        if period.mode == "autonomous" and rng.random() < 0.05:  # the drivers stop it, and the match goes on
            self.add(start + rng.uniform(0.05, 0.9) * period.seconds, {MODE: "disabled"})
        elif enabled and period.seconds > 1:
            # Each disturbance has its own part of the period, so that no two overlap.
            parts = rng.choice((0, 1, 1, 2, 2, 3, 4))
            for part in range(parts):
                length = period.seconds / parts
                self._disturbance(start + part * length, length, period.mode)

    def _seconds_left(self, period: _Period) -> float:
        real = {"autonomous": self._settings.autonomous, "teleop": self._settings.teleop}.get(period.mode, 0.0)
        return max(period.seconds, real) if self._real_times else max(0.0, period.seconds - self._at_zero)

    def _disturbance(self, start: float, length: float, mode: str) -> None:
        """Add a disturbance that begins after `start` and ends within `length` seconds of it."""
        rng = self._rng
        lasts = min(rng.choice((0.02, 0.04, 0.1, 0.5, 1.0, 2.0)), 0.4 * length)
        begin = start + rng.uniform(0.1, 0.5) * length
        sort = rng.random()
        if sort < 0.45:
            self.add(begin, {MODE: _BEFORE[mode]})
            self.add(begin + lasts, {MODE: mode})
        elif sort < 0.6:
            self.add(begin, {"control.dsAttached": False})
            self.add(begin + lasts, {"control.dsAttached": True})
        else:
            (port,) = rng.choices(range(station.JOYSTICKS), _UNPLUGGED)
            self.add(begin, {plugged(port): False})
            self.add(begin + max(lasts, 0.1), {plugged(port): True})

    def _message(self) -> str:
        rng = self._rng
        known = rng.choice(self._messages) if self._messages else _sides(rng)
        sort = rng.random()
        if sort < 0.75:
            return known
        if sort < 0.8:
            return known.lower()
        if sort < 0.9:
            return ""
        if sort < 0.94 and not self._messages:
            return known * rng.randint(2, 6)
        return "".join(rng.choice("LRXBGY?") for _ in known)


def _sides(rng: random.Random) -> str:
    """Return a message like that of 2018 (a letter for each of three plates), 2020 (a color), or 2024 and 2026 (an
    alliance).
    """
    if rng.random() < 0.6:
        return "".join(rng.choice("LR") for _ in range(3))
    return rng.choice("RGBY")


def haste_of(first_seed: str) -> float:
    """Return how many times as fast as usual the drivers of a match are: more than once in some short ones.

    :param first_seed: the seed with which the match begins
    """
    return random.Random(f"haste {first_seed}").choice(_HASTES) if first_seed.endswith(SHORT) else 1.0


def length_of(first_seed: str, usual: float, settings: MatchSettings) -> float:
    """Return the length of a fuzzed match, in seconds: some are short, some as long as a real one, or two.

    :param first_seed: the seed with which the match begins
    :param usual: the length of the others
    """
    if first_seed.endswith(SHORT):
        return min(usual, SHORT_SECONDS)
    how = random.Random(f"length {first_seed}").random() / _WHOLE
    matches = 0 if how >= 1 else 1 if how < 0.5 else 2
    return max(usual, min(_LONGER * usual, matches * seconds_of(settings)))


def seconds_of(settings: MatchSettings) -> float:
    """Return the length of a whole match, in seconds."""
    return settings.before + settings.autonomous + settings.pause + settings.teleop


#: The inputs that a match keeps when its other inputs are generated: the modes, and what the field does.
_COURSE = re.compile(rf"{MODE}|{MATCH_TIME}|joysticks\[\d\]\.plugged|control\..*|event\..*|time\..*|alliance_station")


@dataclass(frozen=True)
class BaseMatch:
    """A recorded match, and up to when a fuzzed one equals it.

    :param script: the inputs of the whole recorded match
    :param until_us: from then on, inputs are generated; only the modes and the field's messages are still the recorded
        ones
    """

    script: InputScript
    until_us: int

    @classmethod
    def choose(cls, script: InputScript, rng: random.Random) -> BaseMatch:
        """Return a match that leaves the recorded one at a random moment."""
        return cls(script, rng.randrange(0, max(script.end_us, 2 * PACKET_US), PACKET_US))

    def end_us(self, generated_us: int) -> int:
        """Return when the match ends: with the recorded one, or after this time of generated inputs."""
        return min(self.script.end_us, self.until_us + generated_us)

    def plan(self) -> list[MatchEvent]:
        """Return what the match takes from the recorded one, in order."""
        found = []
        for step in self.script.steps:
            writes = {
                target: value
                for target, value in written_once(step.writes).items()
                if target != PACKET and (step.at_us < self.until_us or _COURSE.fullmatch(target))
            }
            if writes:
                found.append(MatchEvent(step.at_us, writes))
        return found
