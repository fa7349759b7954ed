"""What pyfrc uses of WPILib's Python packages without their promise to keep it.

WPILib is imported only when one of these functions is called.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .private_name import IncompatibleLibraryError, PrivateName

if TYPE_CHECKING:
    import wpilib

LOOP_FUNCTION = PrivateName(
    "wpilib:IterativeRobotBase._loopFunc", "runtime.time.timed_loop runs one turn of the robot's loop by it"
)
SIMULATION_INIT = PrivateName(
    "wpilib:IterativeRobotBase._simulationInit",
    "runtime.time.timed_loop calls it after robotInit, as WPILib's own loop does",
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
STACK_TRACE_HOOK = PrivateName(
    "wpiutil._stacktrace:_stack_trace_hook", "runtime.patches.robot_stack puts it back when the patches are undone"
)
SET_STACK_TRACE_HOOK = PrivateName(
    "wpiutil._wpiutil:_setup_stack_trace_hook",
    "runtime.patches.robot_stack has WPILib's errors come with the robot's lines by it",
)
NATIVE_HAL = PrivateName(
    "native.wpihal._init_robotpy_native_wpihal:__lib",
    "hal_data shows the channels of an encoder by it",
)
NETWORK_LOG = PrivateName(
    "ntcore._logutil:NtLogForwarder.onInstanceStart",
    "NetworkTables calls it when it starts: fuzz.match_executor replaces it, since no one reads what matches log",
)

#: Those that are attributes of modules and classes.
NAMES = (
    LOOP_FUNCTION,
    SIMULATION_INIT,
    SIMULATION_PERIODIC,
    MAGIC_SIMULATION_INIT,
    MAGIC_SIMULATION_PERIODIC,
    STACK_TRACE_HOOK,
    SET_STACK_TRACE_HOOK,
    NATIVE_HAL,
    NETWORK_LOG,
)


def simulation_periodic_of(robot: object) -> Callable[[Any], None] | None:
    """Return the robot class's own `_simulationPeriodic`; None when it has WPILib's, which is empty."""
    import wpilib

    own: Callable[[Any], None] | None = getattr(type(robot), SIMULATION_PERIODIC.name, None)
    return None if own is SIMULATION_PERIODIC.of(wpilib.IterativeRobotBase) else own


def end_competition(robot: wpilib.TimedRobot) -> None:
    """Call `TimedRobot.endCompetition`, WPILib's own, even where the robot's class overrides it."""
    import wpilib

    # The bindings recognize a call through `super()`, which is not to reach the override, by the name of the calling
    # function and by its first argument.
    def endCompetition(robot: wpilib.TimedRobot) -> None:
        wpilib.TimedRobot.endCompetition(robot)

    endCompetition(robot)


def show_stack(lines: Callable[[], str]) -> None:
    """Have what WPILib's C++ code reports from now on come with these lines, if this version has such a hook.

    :param lines: called for each report, on the stack that led to it
    """
    _set_stack_trace_hook(lambda offset: lines())


def show_whole_stack() -> None:
    """Undo `show_stack`."""
    _set_stack_trace_hook(STACK_TRACE_HOOK.find())


def _set_stack_trace_hook(hook: Callable[[int], str]) -> None:
    import wpiutil._wpiutil

    if hasattr(wpiutil._wpiutil, SET_STACK_TRACE_HOOK.name):  # without it reports come with all lines, no more
        SET_STACK_TRACE_HOOK.of(wpiutil._wpiutil)(hook)


def encoder_channels(index: int) -> tuple[int, int] | None:
    """Return the two digital channels of an encoder of the simulated HAL; None where the HAL does not say.

    :param index: of an encoder that is initialized
    """
    # The HAL's C interface has them, its Python interface has not. Its library is loaded already.
    try:
        library = NATIVE_HAL.find()
        a, b = library.HALSIM_GetEncoderDigitalChannelA, library.HALSIM_GetEncoderDigitalChannelB
    except (IncompatibleLibraryError, AttributeError):
        return None
    return int(a(index)), int(b(index))
