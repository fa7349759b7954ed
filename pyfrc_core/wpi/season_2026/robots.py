"""Robots: what kind of robot an object is, and each step of its life."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, TypeGuard

import hal
import wpilib

from ...compat.private_name import PrivateName
from . import names

#: A robot whose loop can run in place, a turn at a time.
Timed = wpilib.TimedRobot
#: All classes of such robots.
TIMED: tuple[type[Any], ...] = (wpilib.TimedRobot, wpilib.TimesliceRobot)

LOOP_FUNCTION = PrivateName(
    "wpilib:IterativeRobotBase._loopFunc", "runtime.time.timed_loop runs one turn of the robot's loop by it"
)
SIMULATION_INIT = PrivateName(
    "wpilib:IterativeRobotBase._simulationInit", "a robot calls it after robotInit, as in WPILib's own loop"
)
SIMULATION_PERIODIC = PrivateName(
    "wpilib:IterativeRobotBase._simulationPeriodic",
    "runtime.time.simulation_periodic switches outputs off while it looks at a disabled robot",
)
MAGIC_SIMULATION_INIT = PrivateName(
    "magicbot:MagicRobot._simulationInit", "it is when a MagicRobot's robotInit is over: then its physics are made"
)
MAGIC_SIMULATION_PERIODIC = PrivateName(
    "magicbot:MagicRobot._simulationPeriodic",
    "runtime.time.simulation_periodic switches outputs off while it looks at a disabled robot",
)

#: Whether callbacks that are due at once are called in the order in which they were added.
CALLBACKS_KEEP_THEIR_ORDER = False

#: WPILib's classes of robots, whose constructors make a robot.
BASES: tuple[type[Any], ...] = (wpilib.RobotBase, wpilib.IterativeRobotBase, wpilib.TimedRobot, wpilib.TimesliceRobot)
#: The functions that make a robot and run it, which robot code of earlier years calls.
RUN_THE_PROGRAM: tuple[tuple[Any, str], ...] = ((wpilib, "run"),)

#: The class that all classes of WPILib's bindings and of commands2 derive from; the last one of all is `object`.
DERIVED_FROM: tuple[type[Any], ...] = (wpilib.RobotBase.__mro__[-2],)

# -- kinds of robots ---------------------------------------------------------------------------------------------------


def is_robot_class(value: object) -> TypeGuard[type[Any]]:
    """Return whether this is a class of robots that is not a library's own base class."""
    if not isinstance(value, type) or not issubclass(value, wpilib.RobotBase):
        return False
    return value.__module__.partition(".")[0] not in names.LIBRARIES


def is_timed(robot: object) -> TypeGuard[wpilib.TimedRobot]:
    """Return whether the robot has WPILib's timed loop, whose turns can be run in place."""
    return isinstance(robot, Timed)


def is_magic(robot: object) -> bool:
    """Return whether this is a `MagicRobot`, whose own loop calls the robot's functions as WPILib's does."""
    return any(base.__module__.partition(".")[0] == "magicbot" for base in type(robot).__mro__)


def has_loop_of_a_library(robot: object) -> bool:
    """Return whether a library's loop calls the robot's functions."""
    return isinstance(robot, wpilib.IterativeRobotBase) or is_magic(robot)


def has_loop_of_its_own(robot: object) -> bool:
    """Return whether the robot has to run on a thread: it has no timed loop, or overrides what runs it."""
    return not is_timed(robot) or type(robot).startCompetition is not wpilib.TimedRobot.startCompetition


def can_have_opmodes(robot_class: type[Any] | None) -> bool:
    """Return whether robots of a class, or of any class, can have opmodes: there are none before 2027."""
    return False


def period(robot: object, default: float) -> float:
    """Return the seconds between two turns of the robot's loop.

    :param default: for a loop that does not say
    """
    if isinstance(robot, wpilib.IterativeRobotBase):
        return robot.getPeriod()
    return float(getattr(robot, "control_loop_wait_time", default))


# -- the life of a robot -----------------------------------------------------------------------------------------------


def initialize(robot: wpilib.TimedRobot) -> None:
    """Run the robot's own initialization: what WPILib's loop does before its first turn."""
    __tracebackhide__ = True
    robot.robotInit()
    SIMULATION_INIT.of(robot)()


def reports_initialization(robot: object) -> bool:
    """Return whether it is known when the robot's own initialization is over."""
    return is_timed(robot) or (
        hasattr(robot, MAGIC_SIMULATION_INIT.name) and not isinstance(robot, wpilib.IterativeRobotBase)
    )


def when_initialized(robot: Any, call: Callable[[], object]) -> None:
    """Call this when the initialization of a robot with a loop of its own is over, if it reports that."""
    if is_timed(robot) or not reports_initialization(robot):
        return
    name = MAGIC_SIMULATION_INIT.name  # a `MagicRobot` calls it then, in simulation
    this = weakref.ref(robot)  # or the robot would hold on to itself

    def initialized() -> None:
        __tracebackhide__ = True
        getattr(type(this()), name)(this())
        call()

    setattr(robot, name, initialized)


def report_start() -> None:
    """Report that the robot program has started, as WPILib's loop does before its first turn."""
    hal.observeUserProgramStarting()


def turn_of(robot: wpilib.TimedRobot) -> Callable[[], None]:
    """Return what runs one turn of the robot's loop. Its ``__name__`` is that of `LOOP_FUNCTION`."""
    turn: Callable[[], None] = LOOP_FUNCTION.of(robot)
    return turn


def compete(robot: Any) -> None:
    """Run a robot that has a loop of its own, until it ends."""
    __tracebackhide__ = True
    robot.startCompetition()


def end(robot: Any) -> None:
    """Have the robot's loop end."""
    __tracebackhide__ = True
    robot.endCompetition()


def release(robot: object) -> None:
    """Have a robot that has ended hold on to none of its parts, which collection cannot see in C++: it has none."""


def cancel_first_alarm(robot: wpilib.TimedRobot) -> None:
    """Cancel the alarm that the robot's constructor has set, by WPILib's own function even if it is overridden."""

    # The bindings recognize a call through `super()`, which is not to reach the override, by the name of the calling
    # function and by its first argument.
    def endCompetition(robot: wpilib.TimedRobot) -> None:
        wpilib.TimedRobot.endCompetition(robot)

    endCompetition(robot)


def own_simulation(robot: object) -> str | None:
    """Return the name of the method with which the robot's class simulates itself; None if it has none of its own."""
    name = SIMULATION_PERIODIC.name
    own = getattr(type(robot), name, None)
    return None if own in (None, SIMULATION_PERIODIC.of(wpilib.IterativeRobotBase)) else name


def print_epochs(robot: wpilib.IterativeRobotBase) -> None:
    """Print how long each part of the last turn took."""
    robot.printWatchdogEpochs()


# -- programs that run without a clock of ours -------------------------------------------------------------------------


def library() -> ModuleType:
    """Return WPILib's main module, as robot code imports it."""
    return wpilib


def run_program(robot_class: type[Any]) -> bool:
    """Run a robot program in real time, until it ends; return whether it ended well."""
    return bool(wpilib.RobotBase.main(robot_class))


def operating_directory() -> str:
    """Return the directory that robot code finds as the program's."""
    return wpilib.getOperatingDirectory()


def set_deploy_directory(directory: Path) -> None:
    """Set the directory in which robot code finds its files."""
    wpilib.getDeployDirectory = lambda: str(directory)


def load_extension(module: str) -> None:
    """Load an extension of WPILib's simulation beside the simulated HAL, such as ``halsim_gui``."""
    import_module(module).loadExtension()


def show_window() -> None:
    """Show the window of WPILib's own simulator, which has been loaded, until it is closed."""
    hal.runMain()
