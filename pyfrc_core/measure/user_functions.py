"""Find the robot's functions to time: those that WPILib, commands2 and magicbot call in each loop or on events.

They are found when their classes are created, and when they are passed as callbacks. So the robot's modules must not
have been imported yet.
"""

from __future__ import annotations

import sys
import typing
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from types import FunctionType
from typing import Any

import wpilib
import wpilib.event
import wpiutil

from ..compat.wpilib_private import LOOP_FUNCTION
from ..project.robot_files import RobotFiles
from ..runtime.patch_table import PatchTable
from ..runtime.robot import RobotRun
from ..runtime.threads.robot_threads import RobotThreads
from ..runtime.time.notifier import Notifier
from ..runtime.time.timed_loop import Periodic, TimedLoop
from .figures import Measurand
from .stopwatch import Stopwatch

_MODES = ("robot", "disabled", "autonomous", "teleop", "test", "simulation", "_simulation")
#: The methods of a robot that are called; not its constructor, which runs before there is a loop.
_OF_A_ROBOT = {f"{mode}{when}" for mode in _MODES for when in ("Init", "Periodic", "Exit")}
_NOT_OF_A_LOOP = {"startCompetition", "endCompetition"}
_OF_A_COMMAND = {"initialize", "execute", "end", "isFinished"}
_OF_A_SUBSYSTEM = {"periodic", "simulationPeriodic"}
_OF_A_COMPONENT = {"execute", "on_enable", "on_disable"}
#: Where commands and triggers take functions: the class, its method, and the arguments by index and by name.
_GIVEN_TO_COMMANDS = (
    ("FunctionalCommand", "__init__", (1, 2, 3, 4), ("onInit", "onExecute", "onEnd", "isFinished")),
    ("ConditionalCommand", "__init__", (3,), ("condition",)),
    ("WaitUntilCommand", "__init__", (1,), ("condition",)),
    ("SelectCommand", "__init__", (2,), ("selector",)),
    ("DeferredCommand", "__init__", (1,), ("supplier",)),
    ("Command", "onlyWhile", (1,), ("condition",)),
    ("Command", "finallyDo", (1,), ("end",)),
    ("Command", "handleInterrupt", (1,), ("handler",)),
    ("Trigger", "__init__", (1, 2), ("condition",)),
)


class UserFunctions:
    """Times the functions of a robot."""

    def __init__(self, stopwatch: Stopwatch, files: RobotFiles, wrap: Callable[[Callable[..., Any]], Any]) -> None:
        self._stopwatch = stopwatch
        self._files = files
        self._wrap = wrap
        self._done: set[type] = set()

    def install(self, table: PatchTable) -> None:
        """Time the functions that are created from now on, until the table is undone."""
        for base in (wpilib.RobotBase, wpiutil.Sendable):
            table.patch(base, "__init_subclass__", classmethod(self._when_derived_from(base)))
        table.patch(TimedLoop, "schedule", self._scheduling(TimedLoop.schedule))
        self._time_arguments(table, wpilib.event.EventLoop, "bind", (1,), ("action",))
        for name in ("__init__", "setCallback"):
            self._time_arguments(table, Notifier, name, (1,), ("handler",))
        for name in ("sleep_until", "wait"):
            table.patch(RobotThreads, name, self._stopwatch.waiting(getattr(RobotThreads, name)))
        real_open = RobotRun.open

        def open_run(run: RobotRun) -> None:
            self._time_callbacks_of_commands(table)
            real_open(run)

        table.patch(RobotRun, "open", open_run)

    def timed(self, function: Callable[..., Any], kind: str, name: str = "", period_ns: int | None = None) -> Any:
        """Return the function with timing."""
        name, place = name or _name_of(function), _place_of(function, self._files)
        return self._stopwatch.timed(self._wrap(function), Measurand(kind, name, place), period_ns)

    def _when_derived_from(self, base: Any) -> Callable[..., None]:
        def init_subclass(cls: Any, **arguments: Any) -> None:
            super(base, cls).__init_subclass__(**arguments)
            self._on_class(cls)

        return init_subclass

    # -- classes --------------------------------------------------------------------------------------------------

    def _on_class(self, cls: type) -> None:
        """Time the methods of a new class that derives from WPILib's, perhaps through a library's."""
        if issubclass(cls, wpilib.RobotBase):
            self._time_robot(cls)
        elif _derives_from(cls, "commands2.command", "Command"):
            self._time_methods(cls, _OF_A_COMMAND, "command")
        elif _derives_from(cls, "commands2.subsystem", "Subsystem"):
            self._time_methods(cls, _OF_A_SUBSYSTEM, "subsystem")

    def _time_robot(self, cls: type) -> None:
        if issubclass(cls, wpilib.IterativeRobotBase):
            self._time_methods(cls, _OF_A_ROBOT, "robot")
        elif _derives_from(cls, "magicbot.magicrobot", "MagicRobot"):
            self._time_methods(cls, _OF_A_ROBOT, "robot")
            for component in _components(cls):
                self._time_component(component)
        else:  # a robot with its own loop: any method may be a part of it
            methods = {name for name, value in vars(cls).items() if isinstance(value, FunctionType)}
            self._time_methods(cls, {name for name in methods if name[:2] != "__"} - _NOT_OF_A_LOOP, "robot")

    def _time_component(self, cls: type) -> None:
        """Time a component of a `MagicRobot`, with methods that it inherits from a library, as a state machine does."""
        if cls in self._done or cls.__module__.partition(".")[0] in ("magicbot", "wpilib"):
            return
        self._done.add(cls)
        self._time_methods(cls, _OF_A_COMPONENT, "component")
        inherited = getattr(cls, "execute", None)
        if "execute" not in vars(cls) and isinstance(inherited, FunctionType):
            if self._files.is_robot_code(inherited.__code__.co_filename):
                return  # timed in its own class
            cls.execute = self.timed(inherited, "component", f"{cls.__qualname__}.execute")  # type: ignore[attr-defined]

    def _time_methods(self, cls: type, names: Iterable[str], kind: str) -> None:
        for name in sorted(names):
            method = vars(cls).get(name)
            if isinstance(method, FunctionType) and self._files.is_robot_code(method.__code__.co_filename):
                setattr(cls, name, self.timed(method, kind))

    # -- callbacks ------------------------------------------------------------------------------------------------

    def _scheduling(self, real: Callable[..., Periodic]) -> Callable[..., Periodic]:
        """Wrap `TimedLoop.schedule`, for the loop itself and for callbacks with their own rate."""

        def schedule(loop: TimedLoop, call: Callable[[], object], first_due_us: int, period_us: int) -> Periodic:
            period_ns = period_us * 1000
            if getattr(call, "__name__", "") == LOOP_FUNCTION.name:
                call = self._stopwatch.timed_whole_loop(self._wrap(call), period_ns)
            else:
                call = self.timed(call, "periodic", period_ns=period_ns)
            return real(loop, call, first_due_us, period_us)

        return schedule

    def _time_callbacks_of_commands(self, table: PatchTable) -> None:
        """Time the functions that commands and triggers take; if the robot uses commands2, it is imported by now."""
        if "commands2" not in sys.modules:
            return
        import commands2.button

        for where, method, positions, names in _GIVEN_TO_COMMANDS:
            owner = getattr(commands2, where, None) or getattr(commands2.button, where)
            self._time_arguments(table, owner, method, positions, names)

    def _time_arguments(
        self, table: PatchTable, owner: type, name: str, positions: Iterable[int], names: Iterable[str]
    ) -> None:
        """Time the callbacks that a method takes, if they are the robot's own functions."""
        if (owner, name) in table:
            return
        real = getattr(owner, name)

        def call(*arguments: Any, **by_name: Any) -> Any:
            __tracebackhide__ = True
            given = list(arguments)
            for position in positions:
                if position < len(given):
                    given[position] = self._callback(given[position])
            for each in names:
                if each in by_name:
                    by_name[each] = self._callback(by_name[each])
            return real(*given, **by_name)

        table.patch(owner, name, call)

    def _callback(self, function: Any) -> Any:
        code = _code_of(function)
        if code is None or not self._files.is_robot_code(code.co_filename):
            return function
        return self.timed(function, "callback")


def _components(cls: type) -> Iterator[type]:
    """Return the classes of a `MagicRobot`'s components, as far as they are known before it runs."""
    try:
        hints = typing.get_type_hints(cls)
    except Exception:  # magicbot reports wrong annotations itself
        return
    for hint in hints.values():
        if isinstance(hint, type) and not issubclass(hint, (wpiutil.Sendable, int, float, str)):
            yield hint


def _derives_from(cls: type, module: str, name: str) -> bool:
    """Return whether a class is or derives from a library's class, without importing the library."""
    return any(base.__module__ == module and base.__name__ == name for base in cls.__mro__)


def _code_of(function: Any) -> Any:
    if isinstance(function, partial):
        function = function.func
    return getattr(getattr(function, "__func__", function), "__code__", None)


def _name_of(function: Any) -> str:
    if isinstance(function, partial):
        function = function.func
    return str(getattr(function, "__qualname__", type(function).__name__)).replace("<locals>.", "")


def _place_of(function: Any, files: RobotFiles) -> str:
    code = _code_of(function)
    if code is None or not files.is_robot_code(code.co_filename):
        return ""
    return f"{files.relative(code.co_filename)}:{code.co_firstlineno}"
