"""Observe which of the robot's lines and branches a match is the first to reach. This guides a campaign.

`coverage` measures whole processes for reports. Here only what no match has reached yet is of interest, and when it was
reached; known lines are not observed. Only code in functions counts: all other code runs on import.
"""

from __future__ import annotations

import gc
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import CodeType, FrameType, FunctionType
from typing import Any

from ..compat import line_probes
from ..compat.line_probes import Place
from ..project.robot_files import RobotFiles
from .goals import BRANCH, NEAR, Goal, Line
from .nearness import Nearness

#: One of the tool numbers that `sys.monitoring` leaves unassigned; debuggers and coverage have their own.
_TOOL = 4

_Wanted = Mapping[CodeType, Mapping[Place, Goal]]


class RobotLines:
    """The lines and branches of the robot's functions. Create it after the robot's modules were imported, and before
    `gc.freeze` is called.
    """

    def __init__(self, files: RobotFiles) -> None:
        self._files = files
        self._by_code: dict[CodeType, dict[Place, Goal]] = {}
        self._lines: set[Line] = set()
        self._functions: list[FunctionType] = []
        self._probes = LineProbes()
        self._last: tuple[frozenset[Goal], _Wanted] | None = None
        for thing in gc.get_objects():
            # Not `isinstance`, which reads `__class__`: lazy proxies import their module when it is read.
            if type(thing) is FunctionType and files.is_robot_code(thing.__code__.co_filename):
                self._functions.append(thing)
                self._add(thing.__code__)

    def _add(self, code: CodeType) -> None:
        if code not in self._by_code:
            name = self._files.relative(code.co_filename)
            # The first line is that of `def`: it runs with every call, and holds no code.
            lines = {line for _, _, line in code.co_lines() if line and line != code.co_firstlineno}
            self._lines |= {(name, line) for line in lines}
            places: dict[Place, Goal] = {line: (name, line) for line in lines}
            if line_probes.SUPPORTED:
                for at, line, compares in line_probes.conditional_jumps(code):
                    places |= {(at, jumps): (BRANCH, name, line, at, int(jumps)) for jumps in (False, True)}
                    if compares:
                        places[at, None] = (NEAR, name, line, at)
            self._by_code[code] = places
            for constant in code.co_consts:
                if isinstance(constant, CodeType):
                    self._add(constant)

    @property
    def functions(self) -> Sequence[FunctionType]:
        """Return the robot's functions."""
        return self._functions

    def all(self) -> frozenset[Line]:
        """Return all lines."""
        return frozenset(self._lines)

    @contextmanager
    def watched(
        self, known: frozenset[Goal], known_to_all: frozenset[Goal], now_us: Callable[[], int]
    ) -> Iterator[dict[Goal, int]]:
        """Record which unknown lines and branches are reached and when, until the context ends.

        `known_to_all` are goals among them that other matches, which run in the same way, know too: code is prepared
        for these, once for all the matches.

        Before Python 3.12, code that another tool traces is not observed. Python 3.10 observes only lines. Only Python
        3.11 measures how near comparisons are to another result.
        """
        if line_probes.SUPPORTED and sys.gettrace() is None:
            with self._probes.inserted(self._functions, self._wanted(known_to_all), known, now_us) as reached:
                yield reached
            return
        reached = {}
        if sys.version_info >= (3, 12):
            with _monitored(self._by_code, known, self._files, reached, now_us):
                yield reached
        else:
            with _traced(_only_lines(self._wanted(known)), reached, now_us):
                yield reached

    def prepare(self, known_to_all: frozenset[Goal]) -> None:
        """Prepare `watched` with these known goals: forks of this process then find it prepared."""
        if line_probes.SUPPORTED:
            self._probes.prepare(self._wanted(known_to_all))

    def _wanted(self, known: frozenset[Goal]) -> _Wanted:
        if self._last is None or self._last[0] != known:
            found: dict[CodeType, Mapping[Place, Goal]] = {}
            for code, places in self._by_code.items():
                wanted = {place: goal for place, goal in places.items() if goal not in known}
                # A comparison with two known results cannot come nearer to another one.
                for place in [place for place in wanted if isinstance(place, tuple) and place[1] is None]:
                    if (place[0], False) not in wanted and (place[0], True) not in wanted:
                        del wanted[place]
                if wanted:
                    found[code] = wanted
            self._last = known, found
        return self._last[1]


def _only_lines(wanted: _Wanted) -> dict[CodeType, dict[int, Goal]]:
    return {
        code: {place: goal for place, goal in places.items() if isinstance(place, int)}
        for code, places in wanted.items()
    }


class _Reached(dict[int, None]):
    """The goals that were reached, by their index in `goals`: a number is found sooner than a `Goal`.

    The first lookup of a goal adds it.
    """

    def __init__(self) -> None:
        super().__init__()
        self.goals: list[Goal] = []
        self._indices: dict[Goal, int] = {}
        self.times: dict[Goal, int] = {}
        self.now_us: Callable[[], int] = lambda: 0

    def __missing__(self, index: int) -> None:
        self[index] = None
        self.times.setdefault(self.goals[index], self.now_us())

    def index_of(self, goal: Goal) -> int:
        """Return the index of a goal in `goals`, which it joins if it is new."""
        index = self._indices.setdefault(goal, len(self.goals))
        if index == len(self.goals):
            self.goals.append(goal)
        return index

    # Code objects are hashed with their constants.
    __hash__ = object.__hash__  # type: ignore[assignment]


class LineProbes:
    """Functions' code with probes for unknown goals, for Python 3.11."""

    def __init__(self) -> None:
        self._reached = _Reached()
        self._nearness = Nearness()
        #: The code with probes of each code object, and the places that have one.
        self._made: dict[CodeType, tuple[Mapping[Any, Goal], CodeType]] = {}

    def prepare(self, wanted: _Wanted) -> None:
        """Make the code with probes for these goals, only of functions whose goals have changed."""
        for code in wanted:
            self._with_probes(code, wanted)

    @contextmanager
    def inserted(
        self,
        functions: Iterable[FunctionType],
        wanted: _Wanted,
        known: frozenset[Goal],
        now_us: Callable[[], int],
    ) -> Iterator[dict[Goal, int]]:
        """Give the functions their code with probes until the context ends."""
        reached = self._reached
        reached.clear()
        reached.times, reached.now_us = {}, now_us
        new: dict[Goal, int] = {}
        before = [(function, function.__code__) for function in functions]
        for function, code in before:
            function.__code__ = self._with_probes(code, wanted)
        self._nearness.begin(known, now_us)
        try:
            yield new
        finally:
            new |= {goal: at_us for goal, at_us in reached.times.items() if goal not in known}
            new |= self._nearness.reached(known)
            for function, code in before:
                function.__code__ = code

    def _with_probes(self, code: CodeType, wanted: _Wanted) -> CodeType:
        places = self._all_places(code, wanted)
        if not places:
            return code
        made = self._made.get(code)
        if made is None or made[0] != places:
            parts = [self._with_probes(part, wanted) if isinstance(part, CodeType) else part for part in code.co_consts]
            whole = code.replace(co_consts=tuple(parts))
            keys = {place: self._key(place, goal) for place, goal in wanted.get(code, {}).items()}
            made = places, line_probes.with_probes(whole, keys, self._reached)
            self._made[code] = made
        return made[1]

    def _key(self, place: Place, goal: Goal) -> object:
        if isinstance(place, tuple) and place[1] is None:
            return self._nearness.comparison(goal)
        return self._reached.index_of(goal)

    def _all_places(self, code: CodeType, wanted: _Wanted) -> dict[Any, Goal]:
        """Return the wanted places of a code object and of those inside it."""
        found: dict[Any, Goal] = dict(wanted.get(code, {}))
        for part in code.co_consts:
            if isinstance(part, CodeType):
                found |= {(part, place): goal for place, goal in self._all_places(part, wanted).items()}
        return found


@contextmanager
def _monitored(
    codes: _Wanted,
    known: frozenset[Goal],
    files: RobotFiles,
    reached: dict[Goal, int],
    now_us: Callable[[], int],
) -> Iterator[None]:
    monitoring: Any = sys.monitoring  # type: ignore[attr-defined,unused-ignore]
    events = monitoring.events
    #: Where each branch has gone to.
    gone: dict[tuple[CodeType, int], set[int]] = {}
    # From Python 3.14, each way of a branch has an event of its own.
    both = 2 if not hasattr(events, "BRANCH_LEFT") else 1

    def on_line(code: CodeType, number: int) -> Any:
        goal = codes[code].get(number)
        if goal is not None and goal not in known:
            reached.setdefault(goal, now_us())
        return monitoring.DISABLE

    def on_branch(code: CodeType, offset: int, destination: int) -> Any:
        ways = gone.setdefault((code, offset), set())
        if destination not in ways:
            ways.add(destination)
            goal = (BRANCH, files.relative(code.co_filename), code.co_firstlineno, offset, destination)
            if goal not in known:
                reached.setdefault(goal, now_us())
        return monitoring.DISABLE if len(ways) >= both else None

    branches = [events.BRANCH] if both == 2 else [events.BRANCH_LEFT, events.BRANCH_RIGHT]
    monitoring.use_tool_id(_TOOL, "pyfrc fuzz")
    monitoring.register_callback(_TOOL, events.LINE, on_line)
    for event in branches:
        monitoring.register_callback(_TOOL, event, on_branch)
    for code in codes:
        monitoring.set_local_events(_TOOL, code, events.LINE | sum(branches))
    try:
        yield
    finally:
        monitoring.free_tool_id(_TOOL)


@contextmanager
def _traced(
    wanted: Mapping[CodeType, Mapping[int, Goal]], reached: dict[Goal, int], now_us: Callable[[], int]
) -> Iterator[None]:
    if sys.gettrace() is not None or not wanted:
        yield
        return

    left = {code: set(lines) for code, lines in wanted.items()}

    def on_call(frame: FrameType, event: str, argument: object) -> Any:
        return on_event if frame.f_code in left else None

    def on_event(frame: FrameType, event: str, argument: object) -> Any:
        lines = left.get(frame.f_code)
        if lines is None:
            return None
        if event == "line" and frame.f_lineno in lines:
            lines.discard(frame.f_lineno)
            reached.setdefault(wanted[frame.f_code][frame.f_lineno], now_us())
            if not lines:
                del left[frame.f_code]
        return on_event

    threading.settrace(on_call)
    sys.settrace(on_call)
    try:
        yield
    finally:
        sys.settrace(None)
        threading.settrace(None)  # type: ignore[arg-type, unused-ignore]
