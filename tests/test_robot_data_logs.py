"""Data logs that robot code starts: complete and readable however a run ends, in a place that the run names."""

from __future__ import annotations

import json
import re
from itertools import groupby
from pathlib import Path
from textwrap import dedent

import pytest
from conftest import sampled
from sim_robots import run, settle
from wpiutil.log import DataLogReader

from pyfrc_core.project import find_project
from pyfrc_core.sim.engine.options import SimOptions
from pyfrc_core.sim.engine.simulation import Simulation

ROBOT = """
    import os

    import wpilib
    import wpiutil
    from wpiutil.log import DoubleLogEntry

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            wpilib.DataLogManager.start()
            wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog())
            self.motor = wpilib.PWMSparkMax(0)
            self.count, self.turns = 0, DoubleLogEntry(wpilib.DataLogManager.getLog(), "/turns")

        def robotPeriodic(self):
            self.count += 1
            self.turns.append(self.count)
            wpilib.SmartDashboard.putNumber("turns", self.count)
            self.turn(self.count)

        def turn(self, count):
            {turn}
"""


def robot(turn: str = "pass") -> dict[str, str]:
    """A robot that logs the number of each turn of its loop, then does this."""
    return {"robot.py": ROBOT.replace("{turn}", turn)}


def records(file: Path) -> dict[str, list[tuple[int, object]]]:
    """What is in a log: time and value of each record, by entry."""
    reader = DataLogReader(str(file))
    assert reader.isValid(), file
    names, found = {}, {}
    for record in reader:
        if record.isStart():
            start = record.getStartData()
            names[start.entry] = (start.name, start.type)
            found.setdefault(start.name, [])
        elif not record.isControl():
            name, kind = names[record.getEntry()]
            value = {"double": record.getDouble, "string": record.getString}.get(kind, lambda: None)()
            found[name].append((record.getTimestamp(), value))
    return found


def turns(file: Path) -> list[object]:
    """The numbers of the turns that a log has."""
    return [value for _, value in records(file)["/turns"]]


def named(text: str, made) -> Path:
    """The log that a run names."""
    names = re.findall(r"data log: (.+)", text)
    assert len(names) == 1, text
    return made.path / names[0].strip()


def test_the_log_of_a_headless_match(make_project) -> None:
    made = make_project(robot('wpilib.DataLogManager.log("hello") if count == 5 else None'))
    result = made.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "20")
    log = records(named(result.output, made))
    assert [value for _, value in log["/turns"]] == list(range(1, 1001))
    assert log["/turns"][-1][0] == 20_000_000, "stamps are robot time"
    assert log["NT:/SmartDashboard/turns"][-1] == (20_000_000, 1000)
    assert "DS:enabled" in log
    assert [value for _, value in log["messages"]] == ["hello"]
    assert "hello" in result.stdout
    assert (made.path / ".pyfrc" / ".gitignore").read_text() == "*\n"


@pytest.mark.parametrize("end", sampled(["1 / 0", "os._exit(3)", "exit()"], "1 / 0"))
def test_the_log_of_a_robot_that_fails(end: str, make_project) -> None:
    made = make_project(robot(f"{end} if count == 333 else None"))
    result = made.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "20")
    assert result.code == 1, result.output
    assert turns(named(result.output, made)) == list(range(1, 334))


@pytest.mark.slow
def test_processes_that_robot_code_forks_leave_the_log_to_the_robot(make_project) -> None:
    """They end with `os._exit`, or by SIGTERM: both would complete the log of the robot's own process."""
    forking = """
    import multiprocessing

    def end_or_wait(connection, waits):
        connection.send("ready")
        if waits:
            connection.recv()

    def fork(count):
        ours, theirs = multiprocessing.Pipe()
        other = multiprocessing.get_context("fork").Process(target=end_or_wait, args=(theirs, count == 20))
        other.start()
        ours.recv()
        if count == 20:
            other.terminate()
        other.join()
        print("ended with", other.exitcode)
"""
    files = robot("fork(count) if count in (10, 20) else None")
    made = make_project({"robot.py": files["robot.py"].replace("    class MyRobot", f"{forking}\n    class MyRobot")})
    result = made.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "2")
    assert re.findall("ended with (.+)", result.stdout) == ["0", "-15"], result.output
    assert turns(named(result.output, made)) == list(range(1, 101))


def test_the_log_of_a_robot_that_is_killed(make_project) -> None:
    """Some kilobytes of what it logged last are lost."""
    made = make_project(robot("os.kill(os.getpid(), 9) if count == 333 else None"))
    result = made.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "20")
    assert result.code == 1, result.output
    assert 100 <= len(turns(named(result.output, made))) <= 333


@pytest.mark.parametrize("fork", sampled([None, False], None))
def test_time_that_is_turned_back(fork: bool | None, make_project) -> None:
    """Each run has a log of its own, which has all that was seen of it when its process is killed."""
    made = make_project(robot())
    with Simulation(find_project(made.path), SimOptions(speed=0, paused=True, fork=fork)) as simulation:
        run(simulation, 3.02)
        simulation.rewind(1)
        settle(simulation)
        simulation.restart()
        settle(simulation)
        run(simulation, 0.5)
    logs = sorted((made.path / ".pyfrc" / "logs").iterdir(), key=lambda file: file.stat().st_size)
    assert sorted(len(turns(log)) for log in logs) == [25, 50, 151]


TESTS = """
    import pytest

    @pytest.mark.parametrize("seconds", [1, 2])
    def test_ends(control, seconds):
        with control.run_robot():
            control.step_timing(seconds=seconds, autonomous=False, enabled=True)
        assert seconds == 1

    def test_hangs(control, robot):
        def hang(count):
            while count == 33:
                pass

        robot.turn = hang
        with control.run_robot():
            control.step_timing(seconds=1, autonomous=False, enabled=True)
"""


@pytest.mark.parametrize("isolation", sampled([[], ["--no-isolation"]], []))
def test_each_test_has_a_log(isolation: list[str], make_project) -> None:
    settings = "[tool.pyfrc.test]\nhang_seconds = 0.2\n"
    files = robot() | {"tests/match_test.py": TESTS, "pyproject.toml": settings}
    made = make_project(files)
    made.run("test", *isolation, "--", "-k", "ends")
    result = made.run("test", *isolation)  # whose logs replace the first one's
    assert "data logs: .pyfrc/logs/test\n" in result.stdout.replace("\\", "/")
    found = {file.name: len(turns(file)) for file in (made.path / ".pyfrc" / "logs" / "test").iterdir()}
    expected = {"test_ends[1]": 50, "test_ends[2]": 100, "test_hangs": 33}
    assert found == {f"tests_match_test.py.{test}.wpilog": count for test, count in expected.items()}
    assert not (made.path / "logs").exists()


@pytest.mark.slow
def test_a_log_that_is_started_at_import(make_project) -> None:
    made = make_project({"robot.py": "import wpilib\nwpilib.DataLogManager.start()\n" + dedent(robot()["robot.py"])})
    made.write({"tests/match_test.py": TESTS})
    assert made.run("test", "--", "-k", "ends").code == 1
    logs = (made.path / ".pyfrc" / "logs" / "test").iterdir()
    assert sorted(len(turns(log)) for log in logs) == [50, 100]
    assert not (made.path / "logs").exists()


@pytest.mark.slow
def test_a_replay_has_a_log(make_project) -> None:
    script = [{"format": "pyfrc-input 1", "robot": "robot.py", "end": 4.0}, {"t": 1.0, "set": {"mode": "teleop"}}]
    made = make_project(robot() | {"script.jsonl": "\n".join(map(json.dumps, script)) + "\n"})
    assert len(turns(named(made.run("replay", "script.jsonl").output, made))) == 199


SYSID = """
    import commands2
    import wpilib
    from commands2.sysid import SysIdRoutine

    class Drive(commands2.Subsystem):
        def __init__(self):
            super().__init__()
            self.motor = wpilib.PWMSparkMax(0)
            mechanism = SysIdRoutine.Mechanism(self.motor.setVoltage, self.write, self, "drive")
            self.routine = SysIdRoutine(SysIdRoutine.Config(), mechanism)

        def write(self, log):
            log.motor("left").voltage(self.motor.get() * 12).position(1).velocity(2).acceleration(3).current(4)
            log.motor("arm").angularPosition(5).angularVelocity(6).angularAcceleration(7).value("heat", 8, "celsius")

    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            self.drive = Drive()

        def autonomousInit(self):
            self.drive.routine.quasistatic(SysIdRoutine.Direction.kForward).withTimeout(2).schedule()
"""


@pytest.mark.slow
def test_what_a_sysid_routine_writes_is_in_the_runs_log(make_project) -> None:
    """With the names and units that WPILib's own writes; no other log is started."""
    tests = {"tests/sysid_test.py": "from pyfrc.tests import test_autonomous\n"}
    made = make_project({"robot.py": SYSID, "pyproject.toml": "[tool.pyfrc.fuzz]\nmatch_seconds = 5\n", **tests})
    result = made.run("test")
    assert result.code == 0, result.output
    (file,) = made.path.rglob("*.wpilog")
    assert file.parent == made.path / ".pyfrc" / "logs" / "test"
    log = records(file)
    states = [value for _, value in log["sysid-test-state-drive"]]
    assert [state for state, _ in groupby(states)] == ["quasistatic-forward", "none"]
    volts = [value for _, value in log["voltage-left-drive"]]
    assert len(volts) == 100
    assert max(volts) == pytest.approx(2, abs=0.1)  # one volt a second
    units = {
        start.name: start.metadata
        for start in (record.getStartData() for record in DataLogReader(str(file)) if record.isStart())
        if start.name.endswith("-drive")
    }
    assert units == {
        "sysid-test-state-drive": "",
        "voltage-left-drive": "volt",
        "position-left-drive": "meter",
        "velocity-left-drive": "meters_per_second",
        "acceleration-left-drive": "meters_per_second_squared",
        "current-left-drive": "ampere",
        "position-arm-drive": "turn",
        "velocity-arm-drive": "turns_per_second",
        "acceleration-arm-drive": "turns_per_second_squared",
        "heat-arm-drive": "celsius",
    }
    # Thousands of matches have none.
    assert made.run("fuzz", "--runs", "2").code == 0
    assert list(made.path.rglob("*.wpilog")) == [file]
