"""Programs that crash in a loop, on a look-alike that restarts them immediately, as a roboRIO does."""

from __future__ import annotations

import json
from collections.abc import Iterator
from importlib.metadata import version

import pytest
from roborio import Roborio, require_roborio

ROBOT = """
import time
import wpilib


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        {init}
"""


@pytest.fixture
def robot() -> Iterator[Roborio]:
    require_roborio()
    with Roborio(wpilib=version("wpilib")) as robot:
        yield robot


@pytest.mark.slow
def test_crashes_in_a_row_lead_back_to_the_program_that_ran(robot: Roborio, make_project) -> None:
    deploy = ["deploy", "--skip-tests", "--robot", robot.where]
    project = make_project({"robot.py": ROBOT.format(init="pass")})
    result = project.run(*deploy, "--json")
    assert (result.code, json.loads(result.stdout.splitlines()[-1])["program"]) == (0, "running")
    project.write({"robot.py": ROBOT.format(init='time.sleep(1); raise RuntimeError("no such gyro")')})
    assert project.run(*deploy).code == 3
    for _ in range(20):  # between a crash and the next start it does not run
        info = project.run("deploy-info", "--robot", robot.where)
        if "not running" not in info.stdout:
            break
    assert "program    release 2, ended after its last start; started again " in info.stdout
    assert "  release 1 " in info.stdout
    assert ", seen to run" in info.stdout
    project.write({"more.py": ""})
    result = project.run(*deploy, "--auto-rollback")
    assert result.code == 3, result.output
    assert "| RuntimeError: no such gyro" in result.stdout
    assert "the new program ended after 1." in result.stderr
    assert "; release 1 runs again" in result.stderr
    assert "RuntimeError" not in (robot.home / "py/robot.py").read_text()
