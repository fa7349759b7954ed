"""`pyfrc fuzz --against`: where a change of the code changes what the robot does."""

from __future__ import annotations

import subprocess
from typing import Any

import pytest
from skips import missing_programs, requires

pytestmark = requires("comparing with another commit", missing_programs("git"))

ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.pad = wpilib.Joystick(0)
            self.motor = wpilib.PWMSparkMax(0)

        def teleopPeriodic(self):
            power = self.pad.getRawAxis(1)
            if self.pad.getRawButton(2):
                power = power * 0.5
            self.motor.set(power)
"""
SAME = ROBOT.replace("power = power * 0.5", "power /= 2")
CHANGED = ROBOT.replace("power * 0.5", "power * 0.4")
RAISES = ROBOT.replace("power = power * 0.5", "raise ValueError(3)")
SETTINGS = "[tool.pyfrc.fuzz]\nmatch_seconds = 4.0\n"


def git(project: Any, *arguments: str) -> None:
    names = ("-c", "user.name=A", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false")
    subprocess.run(["git", *names, *arguments], cwd=project.path, check=True, capture_output=True)


@pytest.fixture
def repository(make_project):
    """A project with one commit, whose robot.py can be changed."""
    project = make_project({"robot.py": ROBOT, "pyproject.toml": SETTINGS})
    git(project, "init")
    git(project, "add", ".")
    git(project, "commit", "-m", "The first robot")
    return project


def fuzz(project: Any, *arguments: str, runs: int = 4) -> Any:
    return project.run("fuzz", "--seed", "1", "--runs", str(runs), "--against", *arguments)


def test_a_change_is_found_with_its_moment_path_and_values(repository) -> None:
    repository.write({"robot.py": CHANGED})
    result = fuzz(repository, "HEAD")
    assert result.code == 1, result.output
    assert "The outputs differ from those of " in result.stdout
    assert "The first robot, first" in result.stdout
    assert "button 2 pressed" in result.stdout
    assert "pwm[0]." in result.stdout
    (file,) = (repository.path / ".pyfrc" / "fuzz").glob("against-*.jsonl")
    assert len(file.read_text().splitlines()) <= 3
    assert repository.run("replay", str(file)).code == 0


@pytest.mark.slow
def test_a_failure_that_only_one_of_both_has_is_a_difference(repository) -> None:
    repository.write({"robot.py": RAISES})
    result = fuzz(repository, "HEAD")
    assert result.code == 1, result.output
    assert "there was no failure, there is robot.py:" in result.stdout
    assert "ValueError: 3" in result.stdout


@pytest.mark.slow
def test_a_refactoring_does_the_same(repository) -> None:
    repository.write({"robot.py": SAME})
    result = fuzz(repository, "HEAD", runs=16)
    assert result.code == 0, result.output
    assert "16 matches, 0.02 h of robot time: the outputs are those of " in result.stdout


@pytest.mark.slow
def test_where_processes_cannot_be_forked_new_ones_find_the_same(repository) -> None:
    repository.write({"robot.py": "raise_at_import = 1 / 0\n"})
    git(repository, "commit", "-am", "Broken")
    repository.write({"robot.py": ROBOT})
    errors = [fuzz(repository, "HEAD")]
    with (repository.path / "pyproject.toml").open("a") as settings:
        settings.write("[tool.pyfrc.test]\nisolation = 'spawn'\n")
    errors.append(repository.run("fuzz", "--runs", "1", "--against", "HEAD"))
    found = [(result.code, result.first_error) for result in errors]
    assert found == [(1, "robot.py:1: ZeroDivisionError: division by zero")] * 2, errors
    assert repository.run("fuzz", "--runs", "1", "--against", "HEAD~").code == 0


def test_what_cannot_be_compared_is_refused(repository, make_project) -> None:
    result = fuzz(repository, "no-such-branch")
    assert result.code == 2
    assert "there is no commit 'no-such-branch'" in result.output
    result = fuzz(repository, "--output=x")
    assert result.code == 2
    git(repository, "mv", "robot.py", "old.py")
    git(repository, "commit", "-m", "Moved")
    repository.write({"robot.py": ROBOT})
    result = fuzz(repository, "HEAD")
    assert result.code == 2
    assert "Moved has no robot.py in this directory" in result.output


def test_a_project_without_git_is_refused(make_project) -> None:
    project = make_project({"robot.py": ROBOT})
    result = project.run("fuzz", "--runs", "1", "--against", "HEAD")
    assert result.code == 2
    assert "this project is in no git repository" in result.output
