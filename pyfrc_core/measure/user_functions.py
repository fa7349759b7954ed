"""Find the robot's functions to time: those that WPILib, commands2 and magicbot call in each loop or on events.

They are found when their classes are created, and when they are passed as callbacks. So the robot's modules must not
have been imported yet.
"""

from __future__ import annotations

import typing
from collections.abc import Callable, Iterable
from functools import partial
from types import FunctionType
from typing import Any

from ..patch_table import PatchTable
from ..project.robot_files import RobotFiles, is_pyfrc
from ..runtime.patches.notifier import PeriodicThread
from ..runtime.threads.robot_threads import RobotThreads
from ..runtime.time.timed_loop import Periodic, TimedLoop
from ..wpi import callbacks, names, robots
from .figures import WHOLE_LOOP, Measurand
from .stopwatch import Stopwatch


class UserFunctions:
    """Times the functions of a robot."""

    def __init__(self, stopwatch: Stopwatch, files: RobotFiles, wrap: Callable[[Callable[..., Any]], Any]) -> None:
        self._stopwatch = stopwatch
        self._files = files
        self._wrap = wrap

    def install(self, table: PatchTable) -> None:
        """Time the functions that are created from now on, until the table is undone."""
        for base in callbacks.BASES:
            table.patch(base, "__init_subclass__", classmethod(self._when_derived_from(base)))
        table.patch(TimedLoop, "schedule", self._scheduling(TimedLoop.schedule))
        for name in ("__init__", "use_handler"):
            self._time_arguments(table, PeriodicThread, name)
        self.time_callbacks(table)
        for name in ("sleep_until", "wait"):
            table.patch(RobotThreads, name, self._stopwatch.waiting(getattr(RobotThreads, name)))

    def time_callbacks(self, table: PatchTable) -> None:
        """Time the functions that libraries take; those of commands, if the robot has imported commands2 by now."""
        for owner, name in callbacks.functions_taken():
            self._time_arguments(table, owner, name)

    def _timed(self, function: Callable[..., Any], kind: str, name: str = "", period_ns: int = 0) -> Any:
        code, whole = _code_of(function), function.func if isinstance(function, partial) else function
        name = name or str(getattr(whole, "__qualname__", type(whole).__name__)).replace("<locals>.", "")
        own = code is not None and self._files.is_robot_code(code.co_filename)
        place = f"{self._files.relative(code.co_filename)}:{code.co_firstlineno}" if own else ""
        return self._stopwatch.timed(self._wrap(function), Measurand(kind, name, place), period_ns)

    def _when_derived_from(self, base: Any) -> Callable[..., None]:
        def init_subclass(cls: Any, **arguments: Any) -> None:
            super(base, cls).__init_subclass__(**arguments)
            self._time_class(cls)

        return init_subclass

    def _time_class(self, cls: type) -> None:
        """Time the methods of a new class that derives from WPILib's, perhaps through a library's."""
        kind, called = callbacks.called_methods(cls)
        self._time_methods(cls, called, kind)
        if callbacks.has_components(cls):
            self._time_components(cls)

    def _time_methods(self, cls: type, called: Iterable[str], kind: str) -> None:
        for name in sorted(called):
            method = vars(cls).get(name)
            if isinstance(method, FunctionType) and self._is_own(method):
                setattr(cls, name, self._timed(method, kind))

    def _time_components(self, robot: type) -> None:
        """Time the components of a `MagicRobot`, with an `execute` that they inherit from a library's state machine."""
        try:
            hints = typing.get_type_hints(robot)
        except Exception:  # magicbot reports wrong annotations itself
            return
        for cls in dict.fromkeys(hints.values()):
            if not callbacks.is_component(cls):
                continue
            self._time_methods(cls, names.OF_A_COMPONENT, "component")
            inherited = getattr(cls, "execute", None)
            if "execute" not in vars(cls) and isinstance(inherited, FunctionType) and not self._is_own(inherited):
                setattr(cls, "execute", self._timed(inherited, "component", f"{cls.__qualname__}.execute"))  # noqa: B010

    def _scheduling(self, real: Callable[..., Periodic]) -> Callable[..., Periodic]:
        """Wrap `TimedLoop.schedule`, for the loop itself and for callbacks with their own rate."""

        def schedule(
            loop: TimedLoop, call: Callable[[], object], first_due_us: int, period_us: int, *order: int
        ) -> Periodic:
            if getattr(call, "__name__", "") == robots.LOOP_FUNCTION.name:
                call = self._stopwatch.timed(self._wrap(call), WHOLE_LOOP, period_us * 1000)
            elif (code := _code_of(call)) is None or not is_pyfrc(code.co_filename):  # else it calls a timed method
                call = self._timed(call, "periodic", period_ns=period_us * 1000)
            return real(loop, call, first_due_us, period_us, *order)

        return schedule

    def _time_arguments(self, table: PatchTable, owner: type, name: str) -> None:
        """Time the callbacks that a method takes, if they are the robot's own functions."""
        if (owner, name) in table:
            return
        real = getattr(owner, name)

        def call(of: object, *arguments: Any, **by_name: Any) -> Any:
            __tracebackhide__ = True
            return real(of, *map(self._callback, arguments), **{key: self._callback(by_name[key]) for key in by_name})

        table.patch(owner, name, call)

    def _callback(self, argument: Any) -> Any:
        return self._timed(argument, "callback") if callable(argument) and self._is_own(argument) else argument

    def _is_own(self, function: Any) -> bool:
        code = _code_of(function)
        return code is not None and self._files.is_robot_code(code.co_filename)


def _code_of(function: Any) -> Any:
    if isinstance(function, partial):
        function = function.func
    return getattr(getattr(function, "__func__", function), "__code__", None)
