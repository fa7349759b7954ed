"""The checks of fuzz, each with a robot of this file that misbehaves in one way; all in this process."""

from __future__ import annotations

from collections.abc import Callable, Collection
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
import wpilib
from wpilib.drive import DifferentialDrive

from pyfrc_core.config.settings import FuzzSettings
from pyfrc_core.fuzz.oracle.checks import attach_oracle
from pyfrc_core.fuzz.oracle.failure import MisbehaviorError
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.wpi import station

FILES = RobotFiles(Path(__file__).parent)
#: The channels that no other test of this process uses.
CHANNEL = 17

Play = Callable[..., list[tuple[str, str, float]]]


@pytest.fixture
def play(run: RobotRun) -> Play:
    """Runs a robot in modes that begin at these seconds; returns what is found: kind, line or text, and when."""

    def play(
        loop: Callable[[Any], object],
        modes: dict[float, str],
        seconds: float = 3.0,
        always_set: Collection[str] = (),
        texts: list[str] | None = None,
        robot: type[wpilib.RobotBase] | None = None,
        **settings: Any,
    ) -> list[tuple[str, str, float]]:
        found: list[tuple[str, str, float]] = []

        class Robot(wpilib.TimedRobot):
            def robotInit(self) -> None:
                self.motor = wpilib.PWMSparkMax(CHANNEL)
                self.loops = 0

            def robotPeriodic(self) -> None:
                self.loops += 1
                loop(self)

        def note(error: MisbehaviorError) -> bool:
            place = error.place.replace(f"{Path(__file__).name}:", "")
            where = str(error).splitlines()[0]
            if place:
                where = f"+{int(place) - loop.__code__.co_firstlineno} {error.function}"  # type: ignore[attr-defined]
            if not found or found[-1][:2] != (error.kind, where):
                found.append((error.kind, where, run.clock.now))
            if texts is not None:
                texts.append(str(error))
            assert f"(Disable this check with {error.kind} = false under [tool.pyfrc.fuzz]" in str(error)
            return False

        with ExitStack() as closing:
            closing.enter_context(attach_oracle(run, FILES, FuzzSettings(**settings), note, always_set))
            run.construct(robot or Robot)
            for at, mode in modes.items():
                run.clock.at(round(at * 1e6), 0, lambda mode=mode: station.set_mode_named(mode))
            run.start()
            run.run_until(round(seconds * 1e6))
        return found

    return play


ALWAYS = {0.1: "teleop"}


def test_a_robot_that_does_as_it_is_told(play: Play) -> None:
    def loop(robot: Any) -> None:
        robot.motor.set(0.5 if robot.isEnabled() else 0.0)

    assert play(loop, {0.1: "autonomous", 1.0: "disabled", 2.0: "teleop", 3.0: "test"}, 4.0) == []


def test_a_motor_gets_no_number(play: Play) -> None:
    def loop(robot: Any) -> None:
        if robot.loops == 50:
            robot.motor.set(float("nan"))

    assert play(loop, ALWAYS) == [("not_a_number", "+2 loop", pytest.approx(1.0, abs=0.03))]


def test_a_motor_gets_more_than_its_full_power(play: Play) -> None:
    def loop(robot: Any) -> None:
        robot.motor.set((1.0, 1 + 1e-7, 1.5, -1.5)[min(robot.loops // 50, 3)])

    assert [kind for kind, *_ in play(loop, ALWAYS)] == []


def test_a_power_beyond_the_range_is_found_where_that_is_asked_for(play: Play) -> None:
    def loop(robot: Any) -> None:
        robot.motor.set((1.0, 1 + 1e-7, -1.5)[min(robot.loops // 50, 2)])

    assert play(loop, ALWAYS, out_of_range=True) == [("out_of_range", "+1 loop", pytest.approx(2.0, abs=0.03))]


def test_a_motor_is_to_move_long_after_the_robot_was_disabled(play: Play) -> None:
    def loop(robot: Any) -> None:
        robot.motor.set(0.5)

    modes = {0.1: "teleop", 2.0: "disabled"}
    # Half a second is left to each robot.
    assert play(loop, modes, 3.0) == [("motors_while_disabled", "+1 loop", pytest.approx(2.52, abs=0.03))]


def test_a_line_that_always_sets_its_motor_is_no_finding(play: Play) -> None:
    def loop(robot: Any) -> None:
        robot.motor.set(0.25)

    assert play(loop, {}, always_set=["robot.motor.set(0.25)"]) == []


def test_a_small_power_is_none(play: Play) -> None:
    def loop(robot: Any) -> None:
        robot.motor.set(0.001)

    assert play(loop, {}) == []


def test_a_motor_runs_on_in_teleop_with_what_autonomous_has_set(play: Play) -> None:
    def loop(robot: Any) -> None:
        if robot.isAutonomousEnabled():
            robot.motor.set(0.5)

    texts: list[str] = []
    found = play(loop, {0.1: "autonomous", 1.0: "teleop"}, 5.0, texts=texts)
    assert [(kind, where) for kind, where, _ in found] == [("motors_left_running", "+2 loop")]
    said = "the motor still runs at 0.50, as autonomous has set it here, 1 s after the beginning of teleop: no code has"
    assert said in texts[0]


@pytest.mark.season_2026  # in 2027, drives of opmodes count, too
def test_a_motor_of_a_drive_is_not_left_running(play: Play) -> None:
    def loop(robot: Any) -> None:
        if robot.loops == 1:
            robot.drive = DifferentialDrive(robot.motor, wpilib.PWMSparkMax(CHANNEL + 1))
            robot.drive.setSafetyEnabled(False)
        elif robot.isAutonomousEnabled():
            robot.motor.set(0.4)

    assert play(loop, {0.1: "autonomous", 1.0: "teleop"}, 5.0) == []


@pytest.mark.parametrize("stop", ["set it again", "set it while disabled", "stop it"])
def test_a_motor_that_code_sets_or_stops_runs_on_as_meant(stop: str, play: Play) -> None:
    def loop(robot: Any) -> None:
        if robot.isAutonomousEnabled() or (stop == "set it again" and robot.isTeleopEnabled()):
            robot.motor.set(0.5)
        elif stop == "set it while disabled" and robot.isDisabled():
            robot.motor.set(0.0)
        elif stop == "stop it" and robot.isDisabled():
            robot.motor.stopMotor()

    assert play(loop, {0.1: "autonomous", 1.0: "disabled", 1.3: "teleop"}, 5.0) == []


def test_a_loop_that_waits(play: Play, run: RobotRun) -> None:
    def loop(robot: Any) -> None:
        if robot.loops == 50:
            run.threads.sleep_until(run.clock.now_us + 50_000)

    ((kind, where, at),) = play(loop, ALWAYS)
    assert (kind, where) == ("slow_loops", "+2 loop")
    assert at == pytest.approx(1.05, abs=0.04)


def test_a_robot_that_stays_in_a_mode(play: Play, run: RobotRun, monkeypatch: pytest.MonkeyPatch) -> None:
    # No program has reported to the HAL that it has started.
    monkeypatch.setattr(station, "program_state", lambda: "autonomous")

    def loop(robot: Any) -> None:
        while robot.loops == 50 and run.clock.now < 5.5:
            run.threads.sleep_until(run.clock.now_us + 5_000)

    found = play(loop, {0.1: "autonomous", 2.0: "teleop"}, 6.0, slow_loops=False)
    assert found[0] == ("stuck_modes", "+2 loop", pytest.approx(5.0, abs=0.05))


@pytest.mark.parametrize("kind", ["", "not_a_number", "motors_while_disabled", "slow_loops"])
def test_each_check_is_switched_on_by_itself(kind: str, play: Play, run: RobotRun) -> None:
    def loop(robot: Any) -> None:
        robot.motor.set(0.5)
        if robot.loops == 50:
            robot.motor.set(float("nan"))
            run.threads.sleep_until(run.clock.now_us + 50_000)

    checks = "not_a_number", "motors_while_disabled", "slow_loops", "motors_left_running", "hal_errors", "stuck_modes"
    found = play(loop, {}, **{check: check == kind for check in checks})
    assert {name for name, *_ in found} == ({kind} if kind else set())


def test_a_program_that_ends_by_itself(play: Play) -> None:
    class Ends(wpilib.RobotBase):
        def startCompetition(self) -> None:
            pass

        def endCompetition(self) -> None:
            pass

    found = play(len, {}, robot=Ends)
    assert [(kind, where) for kind, where, _ in found] == [("stuck_modes", "the robot program has ended by itself")]
