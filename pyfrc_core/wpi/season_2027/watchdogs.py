"""The two C++ threads that WPILib starts on its own, and how they are taken out of a robot's run.

Each waits for something of the HAL's that has a handle: the motor-safety thread for an event, the watchdogs' thread for
a notifier. WPILib keeps the handles to itself, so they are searched for, and a handle that is found is proved to be the
right one before anything is done with it.
"""

from __future__ import annotations

import time
from functools import cache

# The original names are bound here: `runtime.patches` replaces them for robot code.
import hal
import hal.simulation
import wpilib
from wpiutil.sync import destroy_event, make_event, reset_event, set_event, wait_for_object

from ...compat.private_name import IncompatibleLibraryError

#: How often to look whether the thread waits for its event, and for how long, in wall seconds. It nearly always does
#: after one look; the limit is longer than a busy machine keeps any thread from running.
_LOOK_SECONDS, _PATIENCE = 0.0001, 30.0

#: The type of a handle, an event or a notifier, is its first byte; the rest counts up from 0.
_TYPE = 0xFF00_0000

_sleep, _wall = time.sleep, time.monotonic
_create, _destroy = hal.create_notifier, hal.destroy_notifier
_RealWatchdog = wpilib.Watchdog


class _AnyMotor(wpilib.MotorSafety):
    def stop_motor(self) -> None:
        """Do nothing: there is no motor."""

    def get_description(self) -> str:
        return "none"


@cache
def motor_safety_event() -> int:
    """Return the handle of the event that WPILib's motor-safety thread waits for. Start the thread if need be.

    With every driver-station packet the HAL sets this event. A process has one such thread. To be called before the
    robot's own threads run, since those may wait for events, too.

    :raises IncompatibleLibraryError: when there is no such thread
    """
    motor = _AnyMotor()  # the first motor starts the thread; one that a robot's module has made may have done so
    give_up = _wall() + _PATIENCE
    while _wall() < give_up:
        end = make_event(False, False)
        destroy_event(end)
        for handle in range(end - 1, (end & _TYPE) - 1, -1):  # the thread's is nearly always the newest
            if _is_waited_for(handle):
                return handle
        _sleep(_LOOK_SECONDS)
    del motor
    from importlib.metadata import version

    raise IncompatibleLibraryError(
        f"no thread of WPILib's checks motor safety: wpilib {version('wpilib')} differs from what pyfrc knows",
        remedy="Install an earlier version of wpilib, or a later one of pyfrc.",
    )


def unsubscribe_motor_safety() -> None:
    """Have packets no longer wake WPILib's motor-safety thread: `check_motors` does its work."""
    hal.remove_new_data_event_handle(motor_safety_event())


def check_motors() -> None:
    """Stop, with WPILib's own message, each motor that was not fed in time."""
    wpilib.MotorSafety.check_motors()


def _is_waited_for(handle: int) -> bool:
    """Return whether a thread waits for this event: such a thread resets it when it is set.

    Other events stay as they are. A thread of another library's may be found, too: what
    `runtime.time.motor_safety` does then harms it only if it waits for packets.
    """
    is_set, timed_out = wait_for_object(handle, 0)
    if is_set:
        set_event(handle)  # as it was
    if not timed_out:  # set, or there is no such event
        return False
    set_event(handle)
    _sleep(_LOOK_SECONDS)
    is_set, timed_out = wait_for_object(handle, 0)
    if is_set:
        reset_event(handle)  # as it was
    return timed_out


@cache
def end_watchdog_thread() -> bool:
    """End the thread that all of WPILib's watchdogs share, and return whether it was found.

    It waits for a notifier of the HAL's, and ends when that is destroyed. A process has one such thread.
    """
    there_before = hal.simulation.get_num_notifiers()
    free = _first_free_handle()
    _RealWatchdog(1.0, lambda: None)  # the first one starts the thread
    handle = _first_notifier_named("Watchdog")
    if handle is None:  # not the first notifier: then it is the only new one, and has got the handle that was free
        is_new = hal.simulation.get_num_notifiers() == there_before + 1 and _first_free_handle() != free
        handle = free if is_new else None
    if handle is not None:
        _destroy(handle)
    return handle is not None


def _first_free_handle() -> int:
    """Return the handle that the next notifier gets."""
    handle, _ = _create()
    _destroy(handle)
    return handle


def _first_notifier_named(name: str) -> int | None:
    """Return the handle of the HAL's first notifier, the only one that it shows Python, if that has this name."""
    info = hal.simulation.NotifierInfo()
    if hal.simulation.get_notifier_info(info, 1) == 0:
        return None
    found = bytes(info.name).partition(b"\0")[0].decode(errors="replace")
    return int(info.handle) if found == name else None
