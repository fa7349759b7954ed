"""The timed callbacks of opmodes, in place.

A turn of an `OpModeRobot`'s loop makes, starts and ends opmodes; but `periodic`, and what an opmode adds with
`add_periodic`, are called by a queue in C++ that only WPILib's own blocking loop serves. So each opmode is watched from
when it is made, and its callbacks are put into the schedule of the run's loop.
"""

from __future__ import annotations

import re
import weakref
from collections.abc import Callable
from datetime import timedelta
from typing import Any

import wpilib

from ....patch_table import Patch
from ....wpi.season_2027 import station, timing
from ...time.timed_loop import Periodic, TimedLoop
from ..active_run import active_run

_TRIED_WITHOUT_ROBOT = re.compile(r"__init__\(\) missing \d+ required positional argument")
_MICROSECOND = timedelta(microseconds=1)


# The bindings recognize a call through `super()`, which is not to reach the override, by the name of the calling
# function and by its first argument.
def start(opmode: Any) -> None:
    """Start an opmode, as its class says."""
    __tracebackhide__ = True
    type(opmode).start(opmode)


def end(opmode: Any) -> None:
    """End an opmode, as its class says."""
    __tracebackhide__ = True
    type(opmode).end(opmode)


class _Callbacks:
    """The callbacks of one opmode, from when it is made until it ends or another one is selected."""

    def __init__(self, opmode: Any, loop: TimedLoop) -> None:
        self._loop, self._opmode = loop, weakref.ref(opmode)
        self.selected = station.selected_opmode()
        # On a robot, where an opmode's constructor takes time, `periodic` is due a little before what it has added.
        self._order = loop.next_order()
        self.started = False
        # Those of `get_callbacks` are wrapped: what runs has no name, and no line.
        callbacks = opmode.get_callbacks()
        own = _added.pop(opmode, ())
        functions = own if len(own) == len(callbacks) else [each.func for each in callbacks]
        self._scheduled: list[Periodic] = [
            loop.schedule(
                function, timing.robot_us(each.expiration_time // _MICROSECOND * 1_000), each.period // _MICROSECOND
            )
            for function, each in zip(functions, callbacks, strict=True)
        ]
        opmode.start = self._watched(start, after=self._on_start)
        opmode.end = self._watched(end, before=self.remove)

    def remove(self) -> None:
        """Call them no longer."""
        scheduled, self._scheduled = self._scheduled, []
        for callback in scheduled:
            self._loop.remove(callback)

    def _on_start(self) -> None:
        self.started = True
        loop = self._loop
        assert loop.main is not None  # the loop's turn has started the opmode
        opmode, period_us = self._opmode, loop.main.period_us

        def periodic() -> None:
            __tracebackhide__ = True
            if (each := opmode()) is not None:
                each.periodic()

        self._scheduled.append(loop.schedule(periodic, loop.loop_start_us + period_us, period_us, self._order))

    def _watched(
        self,
        real: Callable[[Any], None],
        before: Callable[[], None] = lambda: None,
        after: Callable[[], None] = lambda: None,
    ) -> Callable[[], None]:
        opmode = self._opmode  # weak: it would hold on to itself

        def watched() -> None:
            __tracebackhide__ = True
            before()
            if (each := opmode()) is not None:
                real(each)
            after()

        return watched


#: The functions that opmodes have added, until they are scheduled.
_added: weakref.WeakKeyDictionary[Any, list[Callable[[], object]]] = weakref.WeakKeyDictionary()

#: The callbacks of the opmode that was made last.
_current: _Callbacks | None = None


def _made(opmode: Any) -> Any:
    global _current
    run = active_run.run
    if run is not None:
        if _current is not None:
            _current.remove()
        _current = _Callbacks(opmode, run.timed_loop)
        run.at_close(_forget)
    return opmode


def _forget() -> None:
    global _current
    _current = None


def look() -> None:
    """After a turn of the loop: forget an opmode that was not started, and is no longer selected."""
    global _current
    if _current is not None and not _current.started and station.selected_opmode() != _current.selected:
        _current.remove()
        _current = None


def patches() -> list[Patch]:
    """Return the names of WPILib's to replace."""
    real: Callable[..., None] = wpilib.OpModeRobotBase.add_opmode_factory
    real_add: Callable[..., None] = wpilib.PeriodicOpMode.add_periodic

    def add_opmode_factory(robot: Any, *args: Any, **kwargs: Any) -> None:
        *rest, factory = [*args, *kwargs.values()]  # it is the last one of each overload

        def make() -> Any:
            __tracebackhide__ = True
            try:
                opmode = factory()
            except TypeError as error:
                # WPILib calls the class with the robot, and after any TypeError without it: that hides the first one.
                first = error.__context__
                if isinstance(first, TypeError) and _TRIED_WITHOUT_ROBOT.search(str(error)):
                    raise first from None
                raise
            return _made(opmode)

        if "factory" in kwargs:
            real(robot, *args, **{**kwargs, "factory": make})
        else:
            real(robot, *rest, make)

    def add_periodic(opmode: Any, callback: Callable[[], object], *args: Any, **kwargs: Any) -> None:
        __tracebackhide__ = True
        real_add(opmode, callback, *args, **kwargs)
        _added.setdefault(opmode, []).append(callback)

    return [
        Patch(wpilib.OpModeRobotBase, "add_opmode_factory", add_opmode_factory),
        Patch(wpilib.PeriodicOpMode, "add_periodic", add_periodic),
    ]
