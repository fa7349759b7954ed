"""The limit to how long a periodic function may wait.

A robot's loop is one thread: a `teleopPeriodic` that waits for a button with `time.sleep` has stopped the robot, since
nothing else of it runs until then. Robot time counts, which passes in a function only while it waits: so only a loop
that waits is looked at.
"""

from __future__ import annotations

from collections.abc import Callable
from types import CodeType, FrameType

from ...compat.cpython_private import current_frames, get_frame, outwards
from ...config.settings import Settings
from ...project.robot_files import RobotFiles, is_pyfrc
from ...wpi import names, robots, station
from ..clock import OBSERVE, PACKET_US, to_us
from ..robot import RobotRun
from .failures import NamesItsPlace

#: Functions of ours that call a loop's body: what is further out on the stack is not part of the turn.
_LOOP_FUNCTION = robots.LOOP_FUNCTION.name
_CALLERS = {"_turn", _LOOP_FUNCTION}


def _name_of(code: CodeType) -> str:
    """Return the name of a periodic function: of an opmode's, with its class."""
    with_class: str = code.co_qualname if code.co_name in names.OF_AN_OPMODE else code.co_name
    return with_class


class LoopWaitsError(NamesItsPlace):
    """A periodic function has not returned within its limit.

    :param place: the user's line that waits, such as ``robot.py:31``; empty when it is not known
    :param begins_at: the first line of the function that this line is in
    :param function: the periodic function
    :param seconds: the limit, in robot time
    """

    def __init__(self, place: str, begins_at: str, function: str, seconds: float) -> None:
        super().__init__(
            f"{place}{': ' if place else ''}{function} has not returned after {seconds:g} s of robot time: "
            "it waits here.\n"
            "A robot's loop is one thread: while one of its functions waits, all others wait with it, and joysticks "
            "and the mode keep their values. Return instead, and look again at the next call.\n"
            "(loop_seconds under [tool.pyfrc.test] in pyproject.toml changes the limit.)"
        )
        #: The message in one line.
        self.note = " ".join(str(self).splitlines())
        self.place, self.begins_at, self.function = place, begins_at, function


class LoopLimit:
    """Watches one run for periodic functions that do not return.

    A turn of the loop has `loop_seconds`; one that began in autonomous or test mode has the length of the autonomous
    period, where that is longer: a routine that waits from step to step is bad style, but works on the field.
    `robotInit` and loops that the user has written are not limited.

    :param settings: of the project
    :param when_exceeded: called once for each such turn; by default, it ends the run as a failure does
    """

    def __init__(
        self,
        run: RobotRun,
        files: RobotFiles,
        settings: Settings,
        when_exceeded: Callable[[LoopWaitsError], object] | None = None,
    ) -> None:
        self._run = run
        self._files = files
        self._loop_us = to_us(settings.test.loop_seconds)
        self._autonomous_us = max(self._loop_us, to_us(settings.match.autonomous))
        self._when_exceeded = when_exceeded or run.threads.fail
        #: When the turn in which the robot waits began, and in which mode.
        self._turn_us: int | None = None
        self._mode = ""
        #: The same of a loop that is not WPILib's.
        self._own_turn_us: int | None = None
        self._armed = False
        #: When the turn began that was reported last.
        self._reported_us: int | None = None
        run.turn_began = self._began
        run.threads.before_driver_waits.append(self._on_wait)
        run.threads.before_loop_waits = self._on_wait_of_own_loop

    # -- the beginning of a wait ---------------------------------------------------------------------------------

    def _on_wait(self) -> None:
        """The robot's loop is about to wait."""
        began_us = self._began()
        if began_us is None or began_us == self._reported_us:
            return
        if began_us != self._turn_us:
            self._turn_us, self._mode = began_us, station.get_mode()
        if not self._armed:
            # Even where more is allowed, so that a turn in another mode, which has less, finds an alarm early enough.
            self._arm(began_us + self._loop_us + 1)

    def _on_wait_of_own_loop(self) -> None:
        """The thread of a robot with a loop of its own is about to wait."""
        if not self._run.timed_loop.in_turn:
            was_us, now_us = self._own_turn_us, self._run.clock.now_us
            if not self._in_periodic_function(get_frame(1)):
                self._own_turn_us = None
                if was_us is not None and now_us - was_us > self._own_period_us():
                    self._run.overruns.count(now_us - was_us)
            elif was_us is None:
                self._own_turn_us = now_us
        self._on_wait()

    def _began(self) -> int | None:
        loop = self._run.timed_loop
        return loop.loop_start_us if loop.in_turn else self._own_turn_us

    def _own_period_us(self) -> int:
        return to_us(robots.period(self._run.robot, PACKET_US / 1_000_000))

    def _in_periodic_function(self, frame: FrameType | None) -> bool:
        """Whether this stack is that of a function which a library's loop calls again and again."""
        in_robot_code = False
        for call in outwards(frame):
            code = call.f_code
            if code.co_name == _LOOP_FUNCTION and is_pyfrc(code.co_filename):
                return True
            if code.co_name == names.INITIALIZATION:
                return False
            if self._files.is_robot_code(code.co_filename):
                if code.co_name == names.MAIN:
                    return False  # the user's own loop
                in_robot_code = True
        return in_robot_code and robots.is_magic(self._run.robot)

    # -- the end of the limit ------------------------------------------------------------------------------------

    def _arm(self, due_us: int) -> None:
        self._armed = True
        self._run.clock.at(due_us, OBSERVE, self._on_alarm)

    def _on_alarm(self) -> None:
        __tracebackhide__ = True
        self._armed = False
        began_us, now_us = self._began(), self._run.clock.now_us
        if began_us is None or began_us != self._turn_us or self._run.threads.ending:
            return
        limit_us = self._autonomous_us if self._mode in ("autonomous", "test") else self._loop_us
        # A wait that ends just at the limit has returned in time.
        due_us = began_us + limit_us + 1
        if now_us < due_us:
            self._arm(min(due_us, now_us + self._loop_us))
            return
        self._reported_us = began_us
        self._when_exceeded(self._error(limit_us / 1_000_000))

    def _error(self, seconds: float) -> LoopWaitsError:
        own_loop = self._run.own_loop
        frame: FrameType | None = get_frame(1)
        if own_loop is not None and own_loop.ident is not None:
            frame = current_frames().get(own_loop.ident)
        place = begins_at = function = ""
        for call in outwards(frame):
            code = call.f_code
            if code.co_name in _CALLERS and is_pyfrc(code.co_filename):
                break
            if self._files.is_robot_code(code.co_filename) and code.co_name != names.MAIN:
                file = self._files.relative(code.co_filename)
                place = place or f"{file}:{call.f_lineno}"
                begins_at = begins_at or f"{file}:{code.co_firstlineno}"
                function = _name_of(code)
        return LoopWaitsError(place, begins_at, function or "the robot's loop", seconds)
