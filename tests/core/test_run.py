"""One run of a robot: the order within a packet, its start and end, and who may let its time pass."""

from __future__ import annotations

from collections.abc import Callable

import hal
import pytest
import wpilib
import wpilib.simulation
from hal import simulation as hs

from pyfrc_core.runtime.clock import PACKET_US, PHYSICS
from pyfrc_core.runtime.connection import DriverStationConnection
from pyfrc_core.runtime.patches.season_2026 import driver_station
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.wpi import station


class Log(list[str]):
    """What happens in a run, with its time in milliseconds."""

    def __init__(self, run: RobotRun) -> None:
        self._run = run

    def note(self, what: object) -> None:
        self.append(f"{self._run.clock.now_us / 1000:g} {what}")


@pytest.fixture
def log(run: RobotRun) -> Log:
    return Log(run)


def robot_class(log: Log, periodic: Callable[[], object] = lambda: None) -> type[wpilib.TimedRobot]:
    class Robot(wpilib.TimedRobot):
        def robotInit(self) -> None:
            log.note("robotInit")

        def disabledInit(self) -> None:
            log.note("disabledInit")

        def disabledExit(self) -> None:
            log.note("disabledExit")

        def disabledPeriodic(self) -> None: ...

        def teleopInit(self) -> None:
            log.note("teleopInit")

        def teleopPeriodic(self) -> None:
            log.note("teleopPeriodic")
            periodic()

        def robotPeriodic(self) -> None:
            log.note("robotPeriodic")

    return Robot


def test_within_a_packet_the_step_comes_first_then_the_loop_then_physics_then_who_watches(
    run: RobotRun, log: Log
) -> None:
    run.clock.before_packet.append(lambda now: log.note(f"step {now}"))
    run.observe(lambda now: log.note(f"watches {now}"))
    run.clock.every(PACKET_US, PHYSICS, lambda: log.note("physics"))
    run.when_constructed.append(lambda: log.note("constructed" + " while it starts" * run.starting))
    run.when_initialized.append(lambda: log.note("initialized" + " while it starts" * run.starting))
    run.construct(robot_class(log))
    assert (run.started, run.alive) == (False, False)
    run.start()
    assert (run.started, run.alive, run.starting) == (True, True, False)
    run.next_packet()
    assert log == [
        "0 constructed",
        "0 robotInit",
        "0 initialized while it starts",
        "20 step 0.02",
        "20 disabledInit",
        "20 robotPeriodic",
        "20 physics",
        "20 watches 0.02",
    ]


def test_a_mode_reaches_the_robot_with_the_next_packet(run: RobotRun, log: Log) -> None:
    run.construct(robot_class(log))
    run.start()
    run.run_until(20_000)
    log.clear()
    station.set_mode(enabled=True)
    run.run_until(39_999)
    assert log == []
    run.run_until(60_000)
    assert log == [
        "40 disabledExit",
        "40 teleopInit",
        "40 teleopPeriodic",
        "40 robotPeriodic",
        "60 teleopPeriodic",
        "60 robotPeriodic",
    ]


def test_what_the_robot_raises_ends_its_run(run: RobotRun, log: Log) -> None:
    def fails() -> None:
        raise ValueError("from teleopPeriodic")

    run.construct(robot_class(log, fails))
    run.start()
    station.set_mode(enabled=True)
    for _ in range(2):
        with pytest.raises(ValueError, match="from teleopPeriodic"):
            run.run_until(100_000)
        assert run.clock.now_us == 20_000
    assert not run.alive
    assert not run.in_motion
    run.end()
    run.end()


def test_a_robot_with_a_loop_of_its_own_lives_until_that_ends(run: RobotRun, log: Log) -> None:
    class Robot(wpilib.RobotBase):
        def startCompetition(self) -> None:
            log.note("starts")
            run.threads.sleep_until(30_000)
            log.note("ends")

        def endCompetition(self) -> None:
            log.note("endCompetition")

    run.construct(Robot)
    assert not run.initializes
    run.start()
    assert run.own_loop is not None
    assert run.own_loop.is_the_robot
    assert (log, run.alive) == (["0 starts"], True)
    run.run_until(40_000)
    assert (log, run.alive) == (["0 starts", "30 ends"], False)
    run.end()
    assert log[2:] == ["40 endCompetition"]


def test_a_process_has_one_run(run: RobotRun) -> None:
    with pytest.raises(RuntimeError, match="a robot runs already in this process"):
        RobotRun().open()


# -- the driver station -----------------------------------------------------------------------------------------------


def test_waiting_for_a_connection_takes_robot_time(run: RobotRun) -> None:
    (_, _, wait) = next(each for each in driver_station.patches() if each[1] == "waitForDsConnection")
    assert wait(0.015) is False
    assert run.clock.now_us == 15_000
    assert wait(0) is True
    assert run.clock.now_us == 20_000
    assert wait(0.5) is True
    assert run.clock.now_us == 20_000
    assert run.connection.when_connected == []


@pytest.fixture
def connection() -> DriverStationConnection:
    connection = DriverStationConnection()
    connection.boot()
    return connection


@pytest.mark.parametrize(("enabled", "checks"), [(True, [6, 10, 14]), (False, [])])
def test_motors_are_checked_after_a_loss(
    enabled: bool, checks: list[int], connection: DriverStationConnection, monkeypatch: pytest.MonkeyPatch
) -> None:
    station.reset_driver_station()
    station.set_mode(enabled=enabled)
    connection.packet()
    checked: list[int] = []
    sees: list[tuple[bool, bool]] = []
    missed: list[int] = []

    def check() -> None:
        checked.append(len(missed))
        word = hal.ControlWord()
        hal.getControlWord(word)
        sees.append((bool(word.enabled), bool(word.dsAttached)))

    monkeypatch.setattr(wpilib.MotorSafety, "checkMotors", check)
    for _ in range(2):
        hs.setDriverStationDsAttached(False)
        missed.clear()
        for number in range(15):
            missed.append(number)
            connection.packet()
        hs.setDriverStationDsAttached(True)
        connection.packet()
    assert checked == checks * 2
    assert all(enabled for enabled, _ in sees)
    assert bool(hs.getDriverStationEnabled()) is enabled
