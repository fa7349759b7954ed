"""Observe which of the robot's lines and branches a match is the first to reach. This guides a campaign.

`coverage` measures whole processes for reports. Here only what no match has reached yet is of interest, and when it was
reached; known lines are not observed. Only code in functions counts: all other code runs on import.

Python 3.12 and newer report the lines and branches of the robot's functions alone (`sys.monitoring`). Before that, a
trace function is called for every function of the process, libraries' too. Nearly all of its cost are these calls, so
fewer lines to watch would not help. It gets lines only.
"""

from __future__ import annotations

import gc
import sys
import threading
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import CodeType, FrameType, FunctionType
from typing import Any

from ...project.robot_files import RobotFiles
from .goals import BRANCH, Goal, RobotLine, kind_of

#: One of the tool numbers that `sys.monitoring` leaves unassigned; debuggers and coverage have their own.
_TOOL = 4


class RobotLines:
    """The lines and branches of the robot's functions. Create it after the robot's modules were imported, and before
    `gc.freeze` is called.
    """

    def __init__(self, files: RobotFiles) -> None:
        self._files = files
        #: The robot's functions.
        self.functions: list[FunctionType] = []
        #: Code objects and their lines. They are found by identity: a code object is hashed with all its constants.
        self._codes: dict[int, tuple[CodeType, dict[int, RobotLine]]] = {}
        gc.collect()  # functions that are garbage, such as those that decorators have replaced, go by chance
        for thing in gc.get_objects():
            # Not `isinstance`, which reads `__class__`: lazy proxies import their module when it is read.
            if type(thing) is FunctionType and files.is_robot_code(thing.__code__.co_filename):
                self.functions.append(thing)
                self._add(thing.__code__)
        #: All lines.
        self.all = frozenset(line for _, lines in self._codes.values() for line in lines.values())

    def _add(self, code: CodeType) -> None:
        if id(code) not in self._codes:
            name = self._files.relative(code.co_filename)
            # The first line is that of `def`: it runs with every call, and holds no code.
            numbers = {number for _, _, number in code.co_lines() if number and number != code.co_firstlineno}
            self._codes[id(code)] = code, {number: (name, number) for number in numbers}
            for constant in code.co_consts:
                if isinstance(constant, CodeType):
                    self._add(constant)

    @contextmanager
    def watched(self, known: frozenset[Goal], now_us: Callable[[], int]) -> Iterator[Mapping[Goal, int]]:
        """Record which unknown lines and branches are reached and when, until the context ends.

        Before Python 3.12, only lines are observed, and none while another tool traces the process.
        """
        reached: dict[Goal, int] = {}

        def reach(goal: Goal) -> None:
            if goal not in known:
                reached.setdefault(goal, now_us())

        with self._monitored(known, reach) if sys.version_info >= (3, 12) else self._traced(known, reach):
            yield reached

    @contextmanager
    def _monitored(self, known: frozenset[Goal], reach: Callable[[Goal], None]) -> Iterator[None]:
        monitoring: Any = sys.monitoring  # type: ignore[attr-defined,unused-ignore]
        if monitoring.get_tool(_TOOL) is not None:
            yield
            return
        #: The ways that each branch is known to take, by the branch's goal without its last part.
        taken: defaultdict[Goal, set[object]] = defaultdict(set)
        for goal in known:
            if kind_of(goal) == BRANCH:
                taken[goal[:-1]].add(goal[-1])

        def on_line(code: CodeType, number: int) -> Any:
            if number != code.co_firstlineno:
                reach((self._files.relative(code.co_filename), number))
            return monitoring.DISABLE

        def on_branch(code: CodeType, offset: int, destination: int) -> Any:
            branch = (BRANCH, self._files.relative(code.co_filename), code.co_firstlineno, offset)
            ways = taken[branch]
            if destination not in ways:
                ways.add(destination)
                reach((*branch, destination))
            return monitoring.DISABLE if one_way or len(ways) > 1 else None

        events = monitoring.events
        # From Python 3.14, each way of a branch has an event of its own.
        one_way = hasattr(events, "BRANCH_LEFT")
        branches = [events.BRANCH_LEFT, events.BRANCH_RIGHT] if one_way else [events.BRANCH]
        callbacks = {events.LINE: on_line, **dict.fromkeys(branches, on_branch)}
        monitoring.use_tool_id(_TOOL, "pyfrc fuzz")
        for event, callback in callbacks.items():
            monitoring.register_callback(_TOOL, event, callback)
        for code, _ in self._codes.values():
            monitoring.set_local_events(_TOOL, code, sum(callbacks))
        try:
            yield
        finally:
            for code, _ in self._codes.values():
                monitoring.set_local_events(_TOOL, code, 0)
            for event in callbacks:
                monitoring.register_callback(_TOOL, event, None)
            monitoring.free_tool_id(_TOOL)

    @contextmanager
    def _traced(self, known: frozenset[Goal], reach: Callable[[Goal], None]) -> Iterator[None]:
        #: The lines of each code object that has unknown ones, until all were reached.
        left = {
            number: {line: goal for line, goal in lines.items() if goal not in known}
            for number, (_, lines) in self._codes.items()
            if not known.issuperset(lines.values())
        }
        if sys.gettrace() is not None or not left:
            yield
            return

        modules = {id(function.__globals__) for function in self.functions}

        def on_call(frame: FrameType, event: str, argument: object) -> Any:
            # Most calls are libraries' own. Reading `f_code` is audited, and our audit hook makes that slow.
            return on_event if id(frame.f_globals) in modules and id(frame.f_code) in left else None

        def on_event(frame: FrameType, event: str, argument: object) -> Any:
            if event == "line" and (lines := left.get(id(frame.f_code))) is not None:
                goal = lines.pop(frame.f_lineno, None)
                if goal is not None:
                    reach(goal)
                    if not lines:
                        left.pop(id(frame.f_code), None)
            return on_event

        before = threading.gettrace()
        threading.settrace(on_call)
        sys.settrace(on_call)
        try:
            yield
        finally:
            if sys.gettrace() is on_call:  # not a debugger that the robot's code has started
                sys.settrace(None)
            if threading.gettrace() is on_call:
                threading.settrace(before)  # type: ignore[arg-type, unused-ignore]
