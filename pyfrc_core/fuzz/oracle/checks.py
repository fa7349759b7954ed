"""The oracle: the checks of `pyfrc fuzz` that detect misbehavior without an exception.

A check calls `_misbehaved` with the name of the setting in `FuzzSettings` that disables the check. Then `ends_run`
decides whether that ends the run, as an exception would, or is only noted. Checks look at the run once in each packet,
at each call of a periodic function, or at each call of a motor (`motor_calls`). Only at a call do they know the user's
line that makes it, and see a value that changes back before the next packet.
"""

from __future__ import annotations

import linecache
from collections.abc import Callable, Collection, Iterator
from contextlib import ExitStack, contextmanager
from types import FrameType

from ...compat.cpython_private import current_frames, get_frame
from ...config.settings import FuzzSettings
from ...project import Project
from ...project.robot_files import RobotFiles
from ...runtime.clock import OBSERVE, PACKET_US
from ...runtime.robot import RobotRun
from ...runtime.scripts.script import InputScript
from ...runtime.time.timed_loop import Periodic
from ...wpi import motor_controllers, station
from .failure import ALWAYS_SET, WHILE_DISABLED, MisbehaviorError, place_of, user_frame
from .hal_reports import HalReports, hal_reports
from .left_running import NEGLIGIBLE_POWER, STOPS_WITHIN_US, MotorsLeftRunning
from .misbehavior_notes import LastMisbehavior
from .motor_calls import InertMotors, watch_motor_calls

#: How long after it was disabled a robot may still command its motors: its loop has to come round.
_STOPS_WITHIN_US = 500_000
#: How long after the driver station has selected another mode a robot may still be in the previous one.
_LEAVES_WITHIN_US = 3_000_000
#: Rounding errors of floating-point sums may exceed 1 by this much.
_ROUNDING = 1e-6


#: Called with each misbehavior; returns whether the run ends with it.
EndsRun = Callable[[MisbehaviorError], bool]


@contextmanager
def attach_oracle(
    run: RobotRun, files: RobotFiles, settings: FuzzSettings, ends_run: EndsRun, always_set: Collection[str]
) -> Iterator[None]:
    """Watch a run, which is open and has not started, until the context ends.

    :param always_set: the lines of code that may set an output while the robot is disabled, since they always do
    """
    with ExitStack() as closing:
        reports = closing.enter_context(hal_reports()) if settings.hal_errors else None
        of_motors = (settings.not_a_number, settings.out_of_range, settings.motors_while_disabled)
        is_watched = any(of_motors) or settings.motors_left_running
        calls = closing.enter_context(watch_motor_calls()) if is_watched else motor_controllers.MotorCalls()
        oracle = _Oracle(run, files, settings, reports, calls, ends_run, always_set)
        if settings.slow_loops:
            run.timed_loop.after_waits.append(oracle.after_wait)
        run.clock.before_packet.append(oracle.before_packet)
        run.clock.every(PACKET_US, OBSERVE, oracle.after_packet)
        yield


@contextmanager
def oracle_if_fuzzed(run: RobotRun, project: Project, script: InputScript) -> Iterator[None]:
    """Attach the oracle to the run of a script that fuzzing has written; other scripts run without it."""
    if not script.story:
        yield
        return
    last = LastMisbehavior(run.clock, run.threads, script.end_us)
    with attach_oracle(run, project.files, project.settings.fuzz, last.ends_run, script.found.get(ALWAYS_SET, ())):
        run.observe(last.after_packet)
        yield


class _Oracle:
    def __init__(
        self,
        run: RobotRun,
        files: RobotFiles,
        settings: FuzzSettings,
        reports: HalReports | None,
        calls: motor_controllers.MotorCalls,
        ends_run: EndsRun,
        always_set: Collection[str],
    ) -> None:
        self._run = run
        self._files = files
        self._settings = settings
        self._reports = reports
        self._ends_run = ends_run
        self._always_set = always_set
        calls.listener = self._on_motor_call
        self._inert_motors = InertMotors(run.hal_data, calls.members)
        self._left_running = MotorsLeftRunning(self._inert_motors.motors_of, self._inert_motors.in_group)
        self._mode = ""
        self._mode_since_us = run.clock.now_us
        #: When the robot was last in the selected mode.
        self._agreed_us = run.clock.now_us
        #: Whether it was in the last packet: then it is, until another mode is selected.
        self._agrees = False
        #: A call of the clock that no robot code has made, directly or not.
        self._outer_call: object = self
        #: The line at which robot code was waiting when a packet came during its loop.
        self._waiting_at = ("", "")

    def _misbehaved(self, what: str, kind: str, place: tuple[str, str]) -> None:
        threads = self._run.threads
        if threads.failure is None and not threads.ending:
            setting = f"\n  (Disable this check with {kind} = false under [tool.pyfrc.fuzz] in pyproject.toml.)"
            error = MisbehaviorError(what + setting, kind, *place)
            if self._ends_run(error):
                threads.fail(error)

    # -- motors ------------------------------------------------------------------------------------------------

    def _on_motor_call(self, motor: object, name: str, numbers: tuple[float, ...], is_power: bool) -> None:
        """Check a call of a motor controller or a drive."""
        settings = self._settings
        if settings.motors_left_running and self._left_running.counts_calls:
            self._left_running.on_call(motor, get_frame(1), self._files)
        for number in numbers:
            if number != number:  # NaN
                if settings.not_a_number:
                    self._misbehaved(f"{name}() was called with NaN", "not_a_number", self._caller())
            elif is_power and abs(number) > 1 + _ROUNDING:
                if settings.out_of_range:
                    what = f"{name}() was called with a power of {'more than 1' if number > 0 else 'less than -1'}"
                    self._misbehaved(what, "out_of_range", self._caller())
            elif (
                self._mode == "disabled"
                and abs(number) > NEGLIGIBLE_POWER
                and settings.motors_while_disabled
                and self._is_long_disabled()
                and not self._inert_motors.is_inert(motor)
            ):
                frame = user_frame(get_frame(1), self._files)
                line = "" if frame is None else linecache.getline(frame.f_code.co_filename, frame.f_lineno).strip()
                if line not in self._always_set:
                    what = f"{name}() commands a motor to move while the robot is disabled"
                    self._misbehaved(what, WHILE_DISABLED, place_of(frame, self._files))

    def _is_long_disabled(self) -> bool:
        return self._run.started and self._run.clock.now_us - self._mode_since_us > _STOPS_WITHIN_US

    def _caller(self) -> tuple[str, str]:
        return place_of(user_frame(get_frame(2), self._files), self._files)

    # -- each packet --------------------------------------------------------------------------------------------

    def before_packet(self, now: float) -> None:
        """Note the mode, after all inputs of a packet were written."""
        mode: str = station.get_mode()
        if mode != "disabled" and not station.is_attached():
            mode = "disabled"
        if mode != self._mode:
            self._mode, self._mode_since_us = mode, self._run.clock.now_us
            self._agrees = False
        opmode = "" if mode == "disabled" else station.opmode_name()
        if (mode, opmode) != self._left_running.during:
            self._left_running.on_mode(mode, opmode, self._run.clock.now_us)

    def after_packet(self) -> None:
        """Check the run after a packet; robot code may be in the middle of a longer call."""
        # Between two turns of the robot's loop, the clock is in the same call for many packets. What has made this call
        # is looked at once.
        frame, clock = None, self._run.clock
        if clock.call is not self._outer_call:
            frame = user_frame(get_frame(1), self._files)
            if frame is not None:
                self._waiting_at = place_of(frame, self._files)
            else:
                self._outer_call = clock.call
        if self._reports is not None and (report := self._reports.error()) is not None:
            text, file, line, function = report
            place = f"{self._files.relative(file)}:{line}" if file else ""
            self._misbehaved(f"the HAL reports an error: {text}", "hal_errors", (place, function))
        if self._settings.stuck_modes:
            loop = self._run.timed_loop
            if self._agrees and loop.in_place and not loop.stopped:  # then the robot is alive
                self._agreed_us = clock.now_us
            else:
                self._check_mode(frame)
        if self._left_running.counts_calls:
            self._check_left_running()

    def _check_mode(self, frame: FrameType | None) -> None:
        run = self._run
        if run.started and not run.alive:
            self._misbehaved("the robot program has ended by itself", "stuck_modes", ("", ""))
            return
        now_us, state = run.clock.now_us, station.program_state()
        self._agrees = state == self._mode
        if self._agrees or state not in station.MODES or station.is_stopped():
            self._agreed_us = now_us
        elif now_us - self._agreed_us > _LEAVES_WITHIN_US:
            place = place_of(frame, self._files) if frame is not None else self._place_of_own_loop()
            what = f"the robot is still in {state} mode, {_LEAVES_WITHIN_US / 1e6:g} s after that mode ended"
            self._misbehaved(what, "stuck_modes", place)

    def _check_left_running(self) -> None:
        for motor in self._left_running.found(self._run.clock.now_us):
            place = f"{self._files.relative(motor.code.co_filename)}:{motor.line}" if motor.code else ""
            what = (
                f"the motor still runs at {motor.power:.2f}, as {motor.period} has set it here, "
                f"{STOPS_WITHIN_US / 1e6:g} s after the beginning of {self._left_running.period}: "
                "no code has set it since"
            )
            self._misbehaved(what, "motors_left_running", (place, motor.code.co_name if motor.code else ""))

    def _place_of_own_loop(self) -> tuple[str, str]:
        thread = self._run.own_loop
        frame = current_frames().get(thread.ident) if thread is not None and thread.ident is not None else None
        return place_of(user_frame(frame, self._files), self._files)

    # -- loops --------------------------------------------------------------------------------------------------

    def after_wait(self, callback: Periodic) -> None:
        """Check how long a callback of a `TimedRobot` took, in which robot time has passed."""
        took_us = self._run.clock.now_us - self._run.timed_loop.loop_start_us
        if took_us > callback.period_us:
            what = f"a loop with a period of {callback.period_us / 1e6:g} s waits here for longer than its period"
            self._misbehaved(what, "slow_loops", self._waiting_at)
