"""Observe which of the robot's lines a match is the first to reach. This guides a campaign.

`coverage` measures whole processes for reports. Here only lines that no match has reached yet are of interest, and when
they were reached; known lines cost nothing. Only lines in functions count: all others run on import.
"""

from __future__ import annotations

import gc
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from types import CodeType, FrameType, FunctionType
from typing import Any

from ..compat import line_probes
from ..project.robot_files import RobotFiles

#: A file, relative to the project, and the number of a line.
Line = tuple[str, int]

#: One of the tool numbers that `sys.monitoring` leaves unassigned; debuggers and coverage have their own.
_TOOL = 4


class RobotLines:
    """The lines of the robot's functions. Create it after the robot's modules were imported, and before `gc.freeze` is
    called.
    """

    def __init__(self, files: RobotFiles) -> None:
        self._by_code: dict[CodeType, dict[int, Line]] = {}
        self._functions: list[FunctionType] = []
        self._probes = LineProbes()
        for thing in gc.get_objects():
            # Not `isinstance`, which reads `__class__`: lazy proxies import their module when it is read.
            if type(thing) is FunctionType and files.is_robot_code(thing.__code__.co_filename):
                self._functions.append(thing)
                self._add(thing.__code__, files)

    def _add(self, code: CodeType, files: RobotFiles) -> None:
        if code not in self._by_code:
            name = files.relative(code.co_filename)
            self._by_code[code] = {line: (name, line) for _, _, line in code.co_lines() if line}
            # The first line is that of `def`: it runs with every call, and holds no code.
            self._by_code[code].pop(code.co_firstlineno, None)
            for constant in code.co_consts:
                if isinstance(constant, CodeType):
                    self._add(constant, files)

    def all(self) -> frozenset[Line]:
        """Return all lines."""
        return frozenset(line for lines in self._by_code.values() for line in lines.values())

    @contextmanager
    def watched(self, known: frozenset[Line], now_us: Callable[[], int]) -> Iterator[dict[Line, int]]:
        """Record which unknown lines are reached and when, until the context ends.

        Before Python 3.12, code that another tool traces is not observed.
        """
        wanted = self._wanted(known)
        if line_probes.SUPPORTED and sys.gettrace() is None:
            with self._probes.inserted(self._functions, wanted, now_us) as reached:
                yield reached
            return
        reached = {}
        watch = _monitored if sys.version_info >= (3, 12) else _traced
        with watch(wanted, reached, now_us):
            yield reached

    def prepare(self, known: frozenset[Line]) -> None:
        """Prepare `watched` with these known lines: forks of this process then find it prepared."""
        if line_probes.SUPPORTED:
            self._probes.prepare(self._wanted(known))

    def _wanted(self, known: frozenset[Line]) -> dict[CodeType, dict[int, Line]]:
        wanted = {
            code: {number: line for number, line in lines.items() if line not in known}
            for code, lines in self._by_code.items()
        }
        return {code: lines for code, lines in wanted.items() if lines}


class _Reached(dict[int, None]):
    """The lines that were reached, by their index in `lines`: a number is found sooner than a `Line`.

    The first lookup of a line adds it.
    """

    def __init__(self) -> None:
        super().__init__()
        self.lines: list[Line] = []
        self._indices: dict[Line, int] = {}
        self.times: dict[Line, int] = {}
        self.now_us: Callable[[], int] = lambda: 0

    def __missing__(self, index: int) -> None:
        self[index] = None
        self.times.setdefault(self.lines[index], self.now_us())

    def index_of(self, line: Line) -> int:
        """Return the index of a line in `lines`, which it joins if it is new."""
        index = self._indices.setdefault(line, len(self.lines))
        if index == len(self.lines):
            self.lines.append(line)
        return index

    # Code objects are hashed with their constants.
    __hash__ = object.__hash__  # type: ignore[assignment]


class LineProbes:
    """Functions' code with probes for unknown lines, for Python 3.11."""

    def __init__(self) -> None:
        self._reached = _Reached()
        #: The code with probes of each code object, and the lines that have one.
        self._made: dict[CodeType, tuple[dict[int, Line], CodeType]] = {}

    def prepare(self, wanted: Mapping[CodeType, dict[int, Line]]) -> None:
        """Make the code with probes for these lines, only of functions whose lines have changed."""
        for code in wanted:
            self._with_probes(code, wanted)

    @contextmanager
    def inserted(
        self,
        functions: Iterable[FunctionType],
        wanted: Mapping[CodeType, dict[int, Line]],
        now_us: Callable[[], int],
    ) -> Iterator[dict[Line, int]]:
        """Give the functions their code with probes until the context ends."""
        reached = self._reached
        reached.clear()
        reached.times, reached.now_us = {}, now_us
        before = [(function, function.__code__) for function in functions]
        for function, code in before:
            function.__code__ = self._with_probes(code, wanted)
        try:
            yield reached.times
        finally:
            for function, code in before:
                function.__code__ = code

    def _with_probes(self, code: CodeType, wanted: Mapping[CodeType, dict[int, Line]]) -> CodeType:
        lines = self._all_lines(code, wanted)
        if not lines:
            return code
        made = self._made.get(code)
        if made is None or made[0] != lines:
            parts = [self._with_probes(part, wanted) if isinstance(part, CodeType) else part for part in code.co_consts]
            whole = code.replace(co_consts=tuple(parts))
            keys = {number: self._reached.index_of(line) for number, line in wanted.get(code, {}).items()}
            made = lines, line_probes.with_probes(whole, keys, self._reached)
            self._made[code] = made
        return made[1]

    def _all_lines(self, code: CodeType, wanted: Mapping[CodeType, dict[int, Line]]) -> dict[int, Line]:
        """Return the wanted lines of a code object and of those inside it."""
        found = dict(wanted.get(code, {}))
        for part in code.co_consts:
            if isinstance(part, CodeType):
                found |= self._all_lines(part, wanted)
        return found


@contextmanager
def _monitored(
    wanted: Mapping[CodeType, Mapping[int, Line]], reached: dict[Line, int], now_us: Callable[[], int]
) -> Iterator[None]:
    monitoring: Any = sys.monitoring  # type: ignore[attr-defined,unused-ignore]

    def on_line(code: CodeType, number: int) -> Any:
        line = wanted[code].get(number)
        if line is not None:
            reached.setdefault(line, now_us())
        return monitoring.DISABLE

    monitoring.use_tool_id(_TOOL, "pyfrc fuzz")
    monitoring.register_callback(_TOOL, monitoring.events.LINE, on_line)
    for code in wanted:
        monitoring.set_local_events(_TOOL, code, monitoring.events.LINE)
    try:
        yield
    finally:
        monitoring.free_tool_id(_TOOL)


@contextmanager
def _traced(
    wanted: Mapping[CodeType, Mapping[int, Line]], reached: dict[Line, int], now_us: Callable[[], int]
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


def share(reached: Iterable[Line], all_lines: frozenset[Line]) -> float:
    """Return the share of the lines that was reached, from 0 to 1."""
    return len(all_lines.intersection(reached)) / len(all_lines) if all_lines else 1.0
