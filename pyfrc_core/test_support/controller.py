"""Control the robot's state during a test."""

from __future__ import annotations

import inspect
import traceback
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Protocol, TypeAlias, TypeVar, cast, overload

from ..config.settings import MatchSettings
from ..invariants.load import Invariant
from ..invariants.watch import watch_invariants
from ..project import Project
from ..runtime.clock import to_us
from ..runtime.exceptions import TestEnded
from ..runtime.match import MatchPeriods
from ..runtime.scripts.boots import boots_of
from ..runtime.scripts.inputs_file import load_inputs, remarks
from ..runtime.scripts.player import Player
from ..runtime.seeds import seed_generators
from ..wpi import station
from ..wpi.opmodes import OpmodeOfTests, find_opmode
from .fake_time import FakeTime, duration_us

#: What a test that passes something else to `run_test` is to write.
_SUCH_AS = "\n  For three seconds of robot time, write: control.run_test(lambda tm: tm < 3)"
OnStep: TypeAlias = Callable[[float], object]
Instance = TypeVar("Instance")


class CalledTooLate(RuntimeError, AssertionError):
    """The robot has run already in this test; an `AssertionError` as in 2019."""


class WrongController(TypeError, RuntimeError, ValueError):
    """`run_test` got nothing that it can call; a `ValueError` as in 2019."""


class HasOnStep(Protocol):
    """An object with a method that is called on each step."""

    def on_step(self, now: float, /) -> object: ...


class TestController:
    """Controls the robot during a unit test; your test gets it as the ``control`` fixture.

    To send a game specific message for autonomous mode, set the attribute `game_specific_message`; the robot receives
    it when it enters autonomous mode.

    Run the robot in one of two ways: with `run_test`, which calls your function on every packet, or inside ``with
    control.run_robot():``, where `step_timing` advances the time.
    """

    __test__ = False  # pytest: not a test class, despite its name

    def __init__(
        self,
        fake_time_inst: FakeTime,
        project: Project | None = None,
        seed: int = 0,
        invariants: Sequence[Invariant] = (),
    ) -> None:
        self._time = fake_time_inst
        self._invariants = invariants
        #: Whether the rules of the project (`pyfrc.invariant`) are checked. Set it before the robot runs.
        self.check_invariants = True
        self._run = fake_time_inst.run
        self.project = project
        #: The random seed of this test.
        self.seed = seed
        self._practice_match: _PracticeMatch | None = None
        #: The place and the text of the warning that the run has ended at its first step.
        self.ended_early = ""
        self._first_run = ""
        #: The message that the field sends with autonomous mode, such as ``"LRL"``.
        self.game_specific_message: str | None = None

    # -- modes ------------------------------------------------------------------------------------------------

    def get_mode(self) -> station.Mode:
        """Return the robot's mode: 'autonomous', 'teleop', 'test', or 'disabled'.

        Without a driver station it is 'disabled'.
        """
        return station.get_mode() if station.is_attached() else "disabled"

    def set_autonomous(self, enabled: bool = True) -> None:
        """Put the robot in autonomous mode, with the next packet."""
        station.set_game_message(self.game_specific_message or "")
        station.set_mode(autonomous=True, enabled=enabled)

    def set_operator_control(self, enabled: bool = True) -> None:
        """Put the robot in operator control mode, with the next packet."""
        station.set_mode(enabled=enabled)

    def set_test_mode(self, enabled: bool = True) -> None:
        """Put the robot in test mode (the robot mode, not related to unit testing), with the next packet."""
        station.set_mode(test=True, enabled=enabled)

    def set_opmode(self, opmode: str | OpmodeOfTests, mode: str = "") -> None:
        """Select an opmode of an `OpModeRobot`, and the robot's mode that it is for, with the next packet.

        The robot is enabled, or disabled, as before. WPILib has opmodes from 2027 on.

        :param opmode: its name, or what the fixture `opmode` gives
        :param mode: 'autonomous', 'teleop' or 'utility', if opmodes of several modes have this name
        :raises UsageError: when the robot has not published such an opmode, or several
        """
        station.select_opmode(find_opmode(station.published_opmodes(), opmode, mode))

    def set_practice_match(self) -> None:
        """Run a practice match. Call it before `run_test`. A robot with opmodes gets the first one of each mode.

        :raises CalledTooLate: when the robot runs already
        """
        if self._run.started:
            raise CalledTooLate("set_practice_match() must be called before run_test()")
        self._practice_match = _PracticeMatch(self, self.project.settings.match if self.project else MatchSettings())

    # -- running with a function ------------------------------------------------------------------------------

    # A class is callable, too: the first form that fits decides.
    @overload
    def run_test(self, controller: type[Instance]) -> Instance: ...  # type: ignore[overload-overlap]

    @overload
    def run_test(self, controller: OnStep | HasOnStep | None = None) -> None: ...

    def run_test(self, controller: type[Instance] | OnStep | HasOnStep | None = None) -> Instance | None:
        """Run the robot code. Call it at most once in a test.

        :param controller: a function that takes the robot time in seconds, or a class or an object with such a method
            ``on_step``; a class is instantiated. It is called before every driver-station packet, and the robot
            receives with that packet what it sets. The robot runs for as long as it returns a true value; None ends the
            run, too. In a practice match it may return None: the match decides when the run ends.
        :returns: the instance, if `controller` is a class
        :raises CalledTooLate: when called twice
        :raises WrongController: for something that cannot be called with the time, or nothing without
            `set_practice_match`
        :raises RuntimeError: when called in a thread, or when the robot program ends by itself
        """
        __tracebackhide__ = True
        instance, steps = self._steps(controller)
        self._begin("run_test")
        match = self._practice_match if controller is None else None

        def step(now: float) -> None:
            __tracebackhide__ = True
            only_time = match is not None and not match.changes_mode(now)
            if run.recorder is not None:
                run.recorder.begin_outside(stepping=True, only_time=only_time)
            results = [on_step(now) for on_step in steps]  # a list, so that every function is called on every packet
            if not all(results):
                if run.starting:
                    raise RuntimeError(
                        f"the test ended at {now:.2f} s of robot time, while robotInit still waited: "
                        "let the robot run for longer, or count from when control.robot_is_starting is false"
                    )
                run.clock.halted = True
                raise TestEnded
            if not run.alive and run.started:
                raise RuntimeError(f"the robot program ended by itself: startCompetition() returned at {now:.2f} s")
            if run.recorder is not None:
                run.recorder.end_outside(stepping=True, only_time=only_time)

        run = self._run
        run.clock.before_packet.insert(0, step)
        try:
            run.start()
            with suppress(TestEnded):
                # Runs until a step ends it, or the time limit.
                run.run_until(run.clock.limit_us + 1)
        finally:
            run.clock.before_packet.remove(step)
            run.end()
        return instance

    def _steps(self, controller: type[Instance] | OnStep | HasOnStep | None) -> tuple[Instance | None, list[OnStep]]:
        instance: Instance | None = None
        if inspect.isclass(controller):
            _check_callable(controller, "without arguments")
            instance = cast("type[Instance]", controller)()
        steps: list[OnStep] = []
        if self._practice_match is not None:
            steps.append(self._practice_match.on_step)
        if controller is not None:
            target = controller if instance is None else instance
            on_step = getattr(target, "on_step", target)
            if not callable(on_step):
                text = f"run_test(controller): {controller!r} is neither a function nor a class with an on_step method"
                raise WrongController(text + _SUCH_AS)
            _check_callable(on_step, "with one argument, the robot time in seconds", 0.0)
            steps.append(self._check_result(on_step) if self._practice_match is None else _until_false(on_step))
        if not steps:
            text = "run_test() needs a function to call on each step, or set_practice_match() before it"
            raise WrongController(text + _SUCH_AS)
        return instance, steps

    def _check_result(self, on_step: OnStep) -> OnStep:
        """Wrap `on_step`: warn, at its line, when it returns None on its first call, which ends the run."""
        is_first = iter([True])

        def step(now: float) -> object:
            __tracebackhide__ = True
            result = on_step(now)
            if next(is_first, False) and result is None:
                name = getattr(on_step, "__qualname__", on_step)
                text = f"{name}() returned None, which ends the run at {now:.2f} s: return True for the robot to go on"
                code = getattr(on_step, "__code__", step.__code__)
                warnings.warn_explicit(text, UserWarning, code.co_filename, code.co_firstlineno)
                self.ended_early = f"{code.co_filename}:{code.co_firstlineno}: {text}\n"
            return result

        return step

    # -- running a script -----------------------------------------------------------------------------------

    def replay(self, path: str | Path) -> None:
        """Run the robot with the inputs of a script, from the robot's start to the script's end.

        With a script of `pyfrc fuzz`, misbehavior that it detects is a failure, too. If the script starts the robot
        program again, all of it runs in other processes: the test's own robot does not run.

        :param path: the script, such as one that ``pyfrc test --record`` or ``pyfrc fuzz`` has written
        :raises ScriptError: when the script is not valid, or does not fit this robot; with its line
        :raises RuntimeError: when the robot has run already in this test
        """
        __tracebackhide__ = True
        self._begin("replay")
        script = load_inputs(Path(path))
        for remark in remarks(script):
            warnings.warn(remark, stacklevel=2)
        if self.project is not None and len(boots_of(script)) > 1:
            from ..fuzz.match.replay_in_subprocess import replay_in_subprocess

            _, failure = replay_in_subprocess(self.project, script)
            if failure is not None:
                raise failure
            return
        if script.seed != self.seed:  # otherwise they were seeded before the robot was constructed
            seed_generators(script.seed)
        with ExitStack() as closing:
            if self.project is not None:
                from ..fuzz.oracle.checks import oracle_if_fuzzed  # few tests replay a script

                closing.enter_context(oracle_if_fuzzed(self._run, self.project, script))
            closing.callback(self._run.end)
            Player(script, self._run).play()

    # -- running step by step ------------------------------------------------------------------------------------

    @contextmanager
    def run_robot(self) -> Iterator[None]:
        """Start the robot, and end it on exit; use it as ``with control.run_robot():``. `robotInit` runs on entry.

        :raises RuntimeError: when the robot has run already in this test
        """
        __tracebackhide__ = True
        self._begin("run_robot")
        try:
            self._run.start()
            yield
        finally:
            self._run.end()

    def step_timing(
        self,
        *,
        seconds: float,
        enabled: bool,
        autonomous: bool | None = None,
        opmode: str | OpmodeOfTests | None = None,
        mode: str = "",
        assert_alive: bool = True,
    ) -> float:
        """Run the robot for some time in a mode, with driver-station packets. Give either `autonomous` or `opmode`.

        :param seconds: how long, in robot time
        :param enabled: whether the robot is enabled
        :param autonomous: whether the mode is autonomous; else it is teleoperated
        :param opmode: the opmode to select, as with `set_opmode`
        :param mode: the mode of that opmode, if opmodes of several modes have its name
        :param assert_alive: fail when the robot program is not running, before or afterwards
        :returns: the seconds by which robot time has advanced
        :raises ValueError: when `seconds` is negative or no finite number
        """
        __tracebackhide__ = True
        if assert_alive:
            assert self.robot_is_alive, "the robot program is not running: step inside `with control.run_robot():`"
        step_us = duration_us(seconds, f"step_timing(seconds={seconds!r})")
        if (autonomous is None) == (opmode is None) or (mode and opmode is None):
            raise TypeError("step_timing() takes either autonomous, or opmode and perhaps its mode")
        if opmode is not None:
            self.set_opmode(opmode, mode)
            station.set_enabled(enabled)
        elif autonomous:
            self.set_autonomous(enabled)
        else:
            self.set_operator_control(enabled)
        clock = self._run.clock
        before = clock.now_us
        self._run.run_until(before + step_us)
        if assert_alive:
            assert self.robot_is_alive, "the robot program has ended"
        return (clock.now_us - before) / 1_000_000

    @property
    def robot_is_alive(self) -> bool:
        """Whether the robot program is running: it has started, and has neither ended nor failed."""
        return self._run.alive

    @property
    def robot_is_starting(self) -> bool:
        """Whether `robotInit` of a robot with WPILib's loop is running; if it waits, robot time passes."""
        return self._run.starting

    def _begin(self, how: str) -> None:
        __tracebackhide__ = True
        self._run.check_drives_clock(f"call {how}()")
        if self._run.started:
            raise CalledTooLate(
                f"{how}(): the robot has run already in this test{self._first_run}. It can only run once; write "
                "a second test, or do everything in one run:\n    with control.run_robot():\n"
                "        control.step_timing(seconds=3, autonomous=True, enabled=True)\n"
                "        control.step_timing(seconds=3, autonomous=False, enabled=True)"
            )
        for frame, line in traceback.walk_stack(inspect.currentframe()):
            if not self._first_run and self.project and self.project.files.is_project_file(frame.f_code.co_filename):
                self._first_run = f", at {self.project.files.relative(frame.f_code.co_filename)}:{line}"
        if self.check_invariants and self.project is not None:
            watch_invariants(self._run, self.project.files, self._invariants)


def _check_callable(function: Callable[..., object], how: str, *arguments: object) -> None:
    """Check that a function or class can be called in this way, before the robot runs.

    :raises WrongController: if its parameters do not fit
    """
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # functions in C may have none
        return
    try:
        signature.bind(*arguments)
    except TypeError as problem:
        name = getattr(function, "__qualname__", repr(function)).rpartition("<locals>.")[2]
        raise WrongController(
            f"run_test(controller): {name}{signature} is called {how}, which does not fit its parameters ({problem})"
            f"{_SUCH_AS}"
        ) from None


def _until_false(on_step: OnStep) -> OnStep:
    """Wrap `on_step` for a practice match: None continues, a false value ends the match early."""

    def step(now: float) -> object:
        __tracebackhide__ = True
        result = on_step(now)
        return result is None or result

    return step


class _PracticeMatch:
    """Puts the robot through the periods of a match, and sets the match time that the robot can read."""

    def __init__(self, control: TestController, settings: MatchSettings) -> None:
        self._control = control
        self._mode: station.Mode | None = None
        self._periods = MatchPeriods(settings)
        station.choose_first_opmodes()

    def _period_at(self, now: float) -> tuple[station.Mode, float] | None:
        """Return the mode of this time and the seconds left in it; None when the match is over.

        At its end, a robot with opmodes is disabled for one packet: the last opmode has an `end` to run.
        """
        period = self._periods.at(to_us(now))
        if period is None and self._mode != "disabled" and station.published_opmodes():
            return "disabled", 0.0
        return period

    def changes_mode(self, now: float) -> bool:
        """Return whether `on_step` will change the mode."""
        period = self._period_at(now)
        return period is not None and period[0] != self._mode

    def on_step(self, now: float) -> bool:
        """Set the mode of this time; return whether the match continues."""
        period = self._period_at(now)
        if period is None:
            return False
        mode, left = period
        if mode != self._mode:
            self._mode = mode
            if mode == "autonomous":
                self._control.set_autonomous()
            else:
                self._control.set_operator_control(enabled=mode == "teleop")
        station.set_match_time(left)
        return True
