"""Records a run's input script: the differences between before and after each external write."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from importlib.metadata import version
from typing import Any

from ...compat.unrepeatable import is_real_time
from ...hal.change_reader import MISSING, Change, same
from ...hal.rows import beside, row_of
from ...wpi import network, station
from ..robot import RobotRun
from .network_targets import NETWORK, numbers_of, struct_target
from .script import InputScript, Step
from .targets import MATCH_TIME, MODE, PACKET, REMAINING, Countdown, plugged

_RECORDED_PACKAGES = ("pyfrc", "wpilib")

#: Leaves that scripts contain in another form: `mode`.
_LEAVES_OF_THE_MODE = {"control.enabled", "control.autonomous", "control.test"}

#: The types that entries of NetworkTables have for people. Of all others, only structs of doubles are recorded.
_PLAIN = (bool, int, float, str)

#: How many packets in a row, of which only the match time is recorded, end the reports from NetworkTables.
_PACKETS_UNREAD = 50


class Recorder:
    """Listens to a run: to be made as soon as the run is open.

    What the robot's own code does, its physics and all else that runs in robot time, is not recorded: a replay has it
    again.
    """

    def __init__(self, run: RobotRun) -> None:
        self._run = run
        self._hal_data = run.hal_data
        self._changes = run.hal_data.changes()
        self._network = _Network()
        self._mode = ""
        self._sticks: dict[str, Any] = {}
        self._counts: list[tuple[int, int, int]] = []
        self._left = 0.0
        self._steps: list[Step] = []
        self._forgotten = 0
        self._match_time = _MatchTime()
        self._named_targets = {MODE, *map(plugged, range(station.JOYSTICKS))}
        self._start_us = 0
        #: When the step that is being taken from outside began, if one is.
        self._stepping_since: int | None = None
        self._skip()
        run.recorder = self

    def begin_outside(self, stepping: bool = False, only_time: bool = False) -> None:
        """Begin external writes.

        :param stepping: whether they come before a packet, which delivers them
        :param only_time: whether nothing is written but the match time: then nothing else is read
        """
        if stepping:
            self._stepping_since = self._run.clock.now_us
        if only_time:
            self._left = station.match_time()
            self._network.skip_later()
            return
        self._skip()

    def on_packet_out_of_turn(self) -> None:
        """Deliver a packet with the external writes up to now."""
        self.end_outside()
        self._steps.append(Step(self._at_us(), {PACKET: True}))
        self.begin_outside()

    def end_outside(self, stepping: bool = False, only_time: bool = False) -> None:
        """End external writes; the arguments are those of `begin_outside`."""
        at_us = self._at_us()
        if stepping:
            self._stepping_since = None
        if not self._run.started:
            self._start_us = at_us
        left_before = self._left
        writes: dict[str, Any] = {}
        if only_time:
            self._left = station.match_time()
        else:
            writes.update(self._writes(self._look()))
        self._match_time.add_to(writes, left_before, self._left, at_us, stepping)
        if writes:
            self._steps.append(Step(at_us, writes))

    def _at_us(self) -> int:
        """When what is written now is to be written."""
        now_us = self._run.clock.now_us
        if not self._run.started or self._stepping_since == now_us:
            return now_us
        # Everything due has been done: what comes after it is not to come with it.
        return now_us + 1

    def script(self, robot: str, seed: int, trace: str | None) -> InputScript:
        """What was recorded, up to now."""
        end_us = self._at_us() if self._run.started else self._run.clock.now_us + 1
        packages = {name: version(name) for name in _RECORDED_PACKAGES}
        return InputScript(tuple(self._steps), end_us, self._start_us, robot, seed, packages, trace)

    def steps_from(self, index: int) -> tuple[Step, ...]:
        """What was recorded, from its step with this number on. The last step may still change."""
        return tuple(self._steps[max(0, index - self._forgotten) :])

    def forget_before(self, index: int) -> None:
        """Drop the steps before the one with this number: a simulation, which has been given them, keeps them."""
        del self._steps[: index - self._forgotten]
        self._forgotten = index

    def _skip(self) -> None:
        """Look at everything, to know what changes from now on."""
        self._mode = station.mode_name()
        self._changes.skip()
        self._left = station.match_time()
        list(self._look_at_sticks())
        self._network.skip()

    def _look(self) -> list[Change]:
        """Return what has changed since the last look, in the order in which a script has it."""
        found: list[Change] = []
        mode = station.mode_name()
        if mode != self._mode:
            found.append((MODE, self._mode, mode))
            self._mode = mode
        changed, gone = self._changes.look()
        if changed or gone:
            found += self._look_at_sticks()
            self._left = next((new for path, _, new in changed if path == REMAINING), self._left)
        return [*found, *changed, *self._network.look()]

    def _look_at_sticks(self) -> Iterator[Change]:
        """Return which joysticks were plugged in or unplugged, and have other numbers of controls."""
        counts = [stick.counts() for stick in self._hal_data["joysticks"]]
        if counts == self._counts:
            return
        self._counts = counts
        before, self._sticks = self._sticks, {}
        for port, (axes, buttons, povs) in enumerate(counts):
            there = self._sticks[plugged(port)] = bool(axes or buttons or povs)
            if there:
                path = f"joysticks[{port}]"
                self._sticks[f"{path}.axis_count"] = axes
                self._sticks[f"{path}.button_count"] = buttons
                self._sticks[f"{path}.pov_count"] = povs
        for target, value in self._sticks.items():
            if before.get(target, MISSING) != value:
                yield target, before.get(target, MISSING), value

    def _writes(self, changes: list[Change]) -> Iterator[tuple[str, Any]]:
        for target, old, value in changes:
            if target in _LEAVES_OF_THE_MODE or target == REMAINING:
                continue
            if target.startswith("CAN[") and is_real_time(target):  # a thread of its library may have written it
                continue
            if value == math.inf and (row := row_of(target)) is not None and row.field.stopped:
                # JSON has no infinity; the HAL keeps an encoder's rate as its period.
                target, value = beside(target, row.field.stopped), 0.0
            if target.startswith(NETWORK) or target in self._named_targets:
                yield target, value
            elif self._hal_data.can_write(target):
                yield from _parts(target, old, value)


class _MatchTime:
    """Records the match time as one countdown. The code that runs a match writes it before each packet."""

    def __init__(self) -> None:
        self._countdown = Countdown()
        self._counting = False
        #: What was last written to stand still, and may turn out to be the beginning of a countdown.
        self._last: dict[str, Any] = {}

    def add_to(self, writes: dict[str, object], before: float, left: float, at_us: int, stepping: bool) -> None:
        """Add to `writes` what has to be said of the seconds that are left now."""
        if self._counting:
            if not stepping or left == self._countdown.left(at_us):
                return
            self._counting = False
        elif left == before:
            return
        elif REMAINING in self._last and left == self._countdown.left(at_us):
            self._last[MATCH_TIME] = self._last.pop(REMAINING)
            self._counting = True
            return
        writes[REMAINING] = left
        self._countdown.start(left, at_us)
        self._last = writes


def _parts(target: str, before: object, value: object) -> Iterator[tuple[str, Any]]:
    """Of a list, the entries that have changed; an unplugged joystick has none."""
    if not isinstance(value, list):
        yield target, value
        return
    old = before if isinstance(before, list) else []
    for index, each in enumerate(value):
        if index >= len(old) or not same(old[index], each):
            yield f"{target}[{index}]", _shortest(each) if target.endswith(".axes") else each


def _shortest(axis: float) -> float:
    """The number with the fewest digits that is the same as a C float: WPILib keeps axes as those."""
    wanted = struct.pack("f", axis)
    for digits in range(1, 9):
        short = float(f"{axis:.{digits}g}")
        if struct.pack("f", short) == wanted:
            return short
    return axis


class _Network:
    """The values that entries of NetworkTables have, heard of as they change: to ask for each takes far longer."""

    def __init__(self) -> None:
        self._news = network.listen_for_values(current=True, gone=True)
        self._found: dict[str, Any] = {}
        #: The packets whose values have not been read.
        self._waiting = 0

    def look(self) -> list[Change]:
        """Return the entries that have changed since the last look, in the order in which they were first heard of."""
        if self._waiting >= _PACKETS_UNREAD:
            self.skip()
        before: dict[str, Any] = {}
        for target, value in self._read_news():
            before.setdefault(target, self._found.get(target, MISSING))
            self._note(target, value)
        changed = [target for target in before if target in self._found]
        if len(changed) > 1:
            places = {target: place for place, target in enumerate(self._found)}
            changed.sort(key=places.__getitem__)
        return [
            (target, before[target], self._found[target])
            for target in changed
            if not same(before[target], self._found[target])
        ]

    def skip(self) -> None:
        """Look without finding what has changed."""
        paused = self._waiting >= _PACKETS_UNREAD
        self._waiting = 0
        if not paused:
            for target, value in self._read_news():
                self._note(target, value)
            return
        before, self._found = self._found, {}
        self._news.resume()  # reports all current values
        for target, value in self._read_news():
            self._note(target, value)
        self._found = {target: self._found[target] for target in before if target in self._found} | self._found

    def skip_later(self) -> None:
        """Skip with one of the next calls. Call `skip` before `look`.

        After many of these calls, nothing is heard until then: `skip` gets all current values.
        """
        self._waiting += 1
        if self._waiting == _PACKETS_UNREAD:
            self._news.pause()

    def _read_news(self) -> Iterator[tuple[str, Any]]:
        """Return the news since the last look: targets, with their plain values or `MISSING`."""
        for update in self._news.read():
            value = update.value
            if value is None:
                yield struct_target(update.name, update.type_name) or NETWORK + update.name, MISSING
            elif isinstance(value, bytes):
                target = struct_target(update.name, update.type_name)
                if target is not None:
                    yield target, numbers_of(value) or MISSING
            else:
                is_plain = isinstance(value, _PLAIN) or all(isinstance(each, _PLAIN) for each in value)
                yield NETWORK + update.name, value if is_plain else MISSING

    def _note(self, target: str, value: object) -> None:
        if value is MISSING:
            self._found.pop(target, None)
        else:
            self._found[target] = value
