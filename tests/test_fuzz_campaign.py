"""`pyfrc fuzz`: what it finds and saves, that it repeats itself, and that its scripts fail until the repair."""

from __future__ import annotations

import re
import shutil
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import sampled
from loops import for_each

from pyfrc_core.processes.fork import FORK_IS_SAFE
from pyfrc_core.runtime.scripts.script import load_script

ROBOTS = Path(__file__).parent / "robots"

SHORT_MATCHES = """
    [tool.pyfrc.fuzz]
    match_seconds = {}
    {}
    """


def copy_of(
    robot: str, make_project: Callable[[dict[str, str]], Any], seconds: float = 10.0, settings: str = ""
) -> Any:
    """A project with one of the sample robots, without its tests, and with short matches."""
    project = make_project({"pyproject.toml": SHORT_MATCHES.format(seconds, settings)})
    project.copy(ROBOTS / robot, "tests", "pyproject.toml")
    return project


def kept(project: Any) -> dict[str, bytes]:
    """The files that a campaign has written, with what is in them."""
    tests = project.path / "tests"
    files = (file for file in tests.rglob("*") if file.is_file() and "__pycache__" not in file.parts)
    return {file.relative_to(tests).as_posix(): file.read_bytes() for file in sorted(files)}


# -- what is found ---------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_same_campaign_writes_the_same_files_in_however_many_processes(make_project) -> None:
    """More than one batch: the second goes on from where the first has come to."""
    found = []
    for processes in ("1", "2"):
        project = copy_of("buggy/chord", make_project, seconds=4.0)
        result = project.run("fuzz", "--seed", "7", "--runs", "34", "-j", processes)
        assert result.code == 1, result.output
        found.append((result.stdout.splitlines()[-1], kept(project)))
        for each in (project.path, project.temporary, project.home):
            shutil.rmtree(each)
    assert found[0] == found[1]
    assert "fuzz/indexerror-robot-pull.jsonl" in found[0][1]


#: Misbehavior: its kind, the code of `autonomousPeriodic`, and the message.
FAULTS = {
    "not_a_number": ("self.motor.set(math.nan)", "robot.py:{}: set() was called with NaN"),
    "hal_errors": (
        'hal.sendError(True, 1, False, "too hot", "Motor", "", True)',
        "the HAL reports an error: Motor: too hot",
    ),
    "hangs": ("while True: pass", "robot.py:{}: autonomousPeriodic() hangs"),
    "process_ended": ("os._exit(3)", "robot.py:{}: the robot's process ended itself with exit code 3"),
}

FAULTY = """
    import math
    import os
    import hal
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.motor = wpilib.PWMSparkMax(0)
            self.switch = wpilib.DigitalInput(0)

        def disabledInit(self):
            self.motor.set(0)

        def autonomousPeriodic(self):
            {}
    """


@pytest.mark.parametrize("kind", sampled(FAULTS, "not_a_number"))
def test_what_is_a_failure(kind: str, make_project) -> None:
    code, message = FAULTS[kind]
    settings = SHORT_MATCHES.format(6, "hang_seconds = 0.1" if kind == "hangs" else "")
    project = make_project({"robot.py": FAULTY.format(code), "pyproject.toml": settings})
    result = project.run("fuzz", "--runs", "2")
    assert result.code == 1, result.output
    line = project.line("robot.py", "def autonomousPeriodic" if kind == "hangs" else code)
    assert message.format(line) in result.stdout, result.output
    (file,) = (project.path / "tests/fuzz").iterdir()
    assert file.name.startswith(kind.lower())
    assert sum(len(step.writes) for step in load_script(file).steps) <= 2
    replayed = project.run("replay", file)
    assert replayed.code == 1
    assert ("the robot code hangs here" if kind == "hangs" else f"then {message.format(line)}") in replayed.output
    if kind != "hangs":
        assert project.run("test").code == 1
    if kind == "not_a_number":
        again = project.run("fuzz", "--runs", "1")
        assert again.code == 1
        assert f"still fails: {file.relative_to(project.path).as_posix()}" in again.output
        project.write({"robot.py": FAULTY.format("self.motor.set(0.5)")})
        assert project.run("test").code == 0


@pytest.mark.slow
def test_interpreters_that_are_used_again_find_the_same(make_project) -> None:
    robot = """
        import random
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.stick, self.motor = wpilib.Joystick(0), wpilib.PWMSparkMax(0)
                self.power = random.random()

            def teleopPeriodic(self):
                self.motor.set(self.power)
                if self.stick.getY() > 0.2:
                    raise RuntimeError(f"power {self.power}")
        """
    project = make_project({"robot.py": robot, "pyproject.toml": SHORT_MATCHES.format(4, "")})
    found = []
    for isolation in ("fork", "reuse"):
        result = project.run("fuzz", "--runs", "4", "--seed", "2", "-j", "1", "--isolation", isolation)
        found.append((result.code, result.stdout.splitlines()[1:], kept(project)))
        shutil.rmtree(project.path / "tests")
        shutil.rmtree(project.path / ".pyfrc")
    assert found[0] == found[1]
    assert found[0][0] == 1, found


# -- the command -----------------------------------------------------------------------------------------------------


@for_each(
    "arguments, message",
    [
        (("--time", "5", "--runs", "5"), "mutually exclusive"),
        (("--runs", "0"), "0 is not in the range"),
        (("--time", "0"), "0"),
        (("--project", "nowhere"), "there is no directory nowhere"),
    ],
)
def test_wrong_usage(arguments: tuple[str, ...], message: str, make_shared_project) -> None:
    result = make_shared_project({"robot.py": FAULTY.format("pass")}).run_here("fuzz", *arguments)
    assert result.code == 2
    assert message in result.stderr
    assert "Traceback" not in result.output


def test_a_robot_that_cannot_be_imported_is_told(make_project) -> None:
    project = make_project({"robot.py": "import wpilib\n1 / 0\n"})
    result = project.run("fuzz", "--runs", "1")
    assert (result.code, result.first_error) == (1, "robot.py:2: ZeroDivisionError: division by zero")


def test_unknown_settings_are_told(make_project) -> None:
    project = make_project(
        {"robot.py": FAULTY.format("pass"), "pyproject.toml": SHORT_MATCHES.format(3, "slow_loop = false")}
    )
    result = project.run("fuzz", "--runs", "1")
    assert result.code == 2
    assert "slow_loops" in result.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one process")
def test_an_interrupted_campaign_keeps_what_was_found_and_nothing_else(make_project, tmp_path: Path) -> None:
    project = make_project({"robot.py": FAULTY.format("1 / self.motor.get()")})
    temporary = tmp_path / "of the campaign"
    temporary.mkdir()
    with project.start("fuzz", "--time", "1000", "-j", "2", env={"TMPDIR": str(temporary)}) as campaign:
        lines = []
        for line in campaign.stdout:
            lines.append(line)
            if "pyfrc replay" in line:
                campaign.send_signal(signal.SIGINT)
        assert campaign.wait() == 130
    assert lines[-1] == "interrupted\n"
    assert not list(temporary.iterdir())
    assert "fuzz/zerodivisionerror-robot-autonomousperiodic.jsonl" in kept(project)


@pytest.mark.slow
@pytest.mark.parametrize("taken", ["tests", ".pyfrc"])
def test_what_is_found_in_a_project_that_cannot_be_written_is_kept(taken: str, make_project) -> None:
    """A file where a directory is to be: no one can make that one, not even root."""
    project = make_project({"robot.py": FAULTY.format("1 / self.motor.get()"), taken: "a file"})
    result = project.run("fuzz", "--runs", "4")
    assert result.code == 1, result.output
    found = re.search(r"ZeroDivisionError.*\n(?:  .*\n)*  pyfrc replay (.*)\n", result.stdout)
    assert found is not None, result.output
    assert project.run("replay", found[1]).code == 1
    elsewhere = "The scripts are in a temporary directory: copy them."
    assert (elsewhere in result.stderr) == (taken != ".pyfrc"), result.stderr
    assert project.path.joinpath(taken).read_text() == "a file"


@pytest.mark.skipif(not FORK_IS_SAFE, reason="a match's parent is the campaign only where it is forked")
def test_ctrl_c_before_anything_is_found_is_no_success(make_project) -> None:
    project = make_project({"robot.py": FAULTY.format("os.kill(os.getppid(), 2)")})
    result = project.run("fuzz", "--time", "1000", "-j", "1")
    assert result.code == 130, result.output
    assert result.stdout.endswith("interrupted\nNothing was found.\n")


def test_a_robot_that_exits_at_its_start_ends_the_campaign(make_project) -> None:
    robot = """
        import sys
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                sys.exit(5)
    """
    project = make_project({"robot.py": robot, "pyproject.toml": SHORT_MATCHES.format(4, "")})
    result = project.run("fuzz", "--runs", "2", "--seed", "1")
    assert result.code == 1, result.output
    assert f"{project.place('robot.py', 'sys.exit(5)')}: exit(5) was called\n" in result.stdout, result.output
    assert "pyfrc replay tests/fuzz/systemexit-robot-robotinit.jsonl\n" in result.stdout, result.output
    assert "0 matches, " in result.stdout
