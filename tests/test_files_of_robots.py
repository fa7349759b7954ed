"""Files that robot code writes: runs at the same time do not meet in them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from conftest import SHORT_MATCH, MakeProject, sampled

#: Keeps a log under a name that is the same in every run, and fails if another run has changed its file.
WRITES = """
    {imports}

    import wpilib

    NAME = {name}


    class Robot(wpilib.TimedRobot):
        def {init}(self):
            if os.path.exists(NAME):
                os.remove(NAME)
            with open(NAME, "w") as log:
                log.write("0")
            self.turns = 0
            end = time.process_time() + 0.1
            while time.process_time() < end:  # configures devices
                pass

        def robotPeriodic(self):
            with open(NAME) as log:
                assert log.read() == str(self.turns), "another run has written this"
            self.turns += 1
            with open(NAME, "w") as log:
                log.write(str(self.turns))

        def teleopPeriodic(self):
            if wpilib.DriverStation.getEventName():
                os.rename(NAME, NAME + ".old")
                os.rename(NAME + ".old", NAME)
"""

IMPORTS = "import os, random, tempfile, time"

NAMES = {
    "always alike": "'log.txt'",
    "random": "f'log_{random.randint(0, 65535)}.txt'",
    "by the time": "time.strftime('%H%M%S.txt')",
    "beside the code": "os.path.join(os.path.dirname(os.path.abspath(__file__)), 'log.txt')",
    "in the temporary directory": "os.path.join(tempfile.gettempdir(), 'robot.log')",
}


def robot(name: str, init: str = "robotInit") -> str:
    return WRITES.replace("{imports}", IMPORTS).replace("{name}", NAMES[name]).replace("{init}", init)


@pytest.mark.parametrize("name", sampled(NAMES, "random"))
def test_tests_at_the_same_time(make_project: MakeProject, name: str) -> None:
    project = make_project({"robot.py": robot(name), "pyproject.toml": SHORT_MATCH})
    result = project.run("test", "--builtin", "-j", "4")
    assert result.code == 0, result.output


@pytest.mark.slow
def test_where_interpreters_are_used_again(make_project: MakeProject) -> None:
    project = make_project({"robot.py": robot("random"), "pyproject.toml": SHORT_MATCH})
    result = project.run("test", "--builtin", "-j", "3", "--isolation", "reuse")
    assert result.code == 0, result.output


@pytest.mark.slow
def test_a_command_that_a_test_starts_does_not_wait_for_the_test(make_project: MakeProject) -> None:
    test = """
        import subprocess
        import sys


        def test_fuzz(control):
            with control.run_robot():
                command = [sys.executable, "-m", "pyfrc", "fuzz", "--runs", "1"]
                subprocess.run(command, check=True, stdin=subprocess.DEVNULL)


        def test_other(control):
            control.run_test(lambda tm: tm < 1)
    """
    kept = robot("always alike").replace("'log.txt'", "'log_%d.txt' % os.getpid()")
    # Robot time stands while the command runs, which a busy machine lets take long.
    settings = SHORT_MATCH + "\n[tool.pyfrc.test]\nhang_seconds = 600\n"
    project = make_project({"robot.py": kept, "tests/test_a.py": test, "pyproject.toml": settings})
    result = project.run("test", "-j", "2")
    assert result.code == 0, result.output


@pytest.mark.slow
def test_matches_and_replays(make_project: MakeProject) -> None:
    project = make_project({"robot.py": robot("random"), "pyproject.toml": SHORT_MATCH})
    result = project.run("fuzz", "--runs", "6", "-j", "3")
    assert result.code == 0, result.output
    assert not (project.path / "tests" / "fuzz").exists()


@pytest.mark.slow
def test_a_recorded_test_is_the_same_in_a_replay(make_project: MakeProject, tmp_path: Path) -> None:
    project = make_project({"robot.py": robot("random"), "pyproject.toml": SHORT_MATCH})
    assert project.run("test", "--builtin", "-j", "4", "--trace", "traces", "--record", "scripts").code == 0
    name = "pyfrc.tests.test_practice.jsonl"
    assert project.run("replay", f"scripts/{name}", "--trace", "again.jsonl").code == 0
    first, again = ((project.path / file).read_text().splitlines() for file in (f"traces/{name}", "again.jsonl"))
    assert json.loads(first[-1])["sha256"] == json.loads(again[-1])["sha256"]
