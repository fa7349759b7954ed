"""Deploys to a look-alike whose kill script fails, or whose console is silent."""

from __future__ import annotations

from pathlib import Path

import pytest
from roborio import Roborio, require_roborio
from roborio.machine import LETS_PROGRAMS_SURVIVE

ROBOT = """\
import signal
import wpilib

signal.signal(signal.SIGTERM, signal.SIG_IGN)


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        print("this is {name}")
"""


def write_and_deploy(project, name: str, robot: Roborio, *options: str):
    project.write({"robot.py": ROBOT.format(name=name)})
    return project.run("deploy", "--skip-tests", "--no-version-check", "--robot", robot.where, *options)


def programs_on(robot: Roborio) -> list[str]:
    lines = robot.run("ps", "-ww", "-u", "lvuser", "-o", "args").stdout.splitlines()
    return [line for line in lines if "/home/lvuser/py/robot.py" in line]


@pytest.mark.slow
def test_a_program_that_survives_the_kill_script_is_ended_and_the_script_replaced(make_project) -> None:
    require_roborio()
    project = make_project({})
    script = Path("usr/local/frc/bin/frcKillRobot.sh")
    with Roborio(kill_script=LETS_PROGRAMS_SURVIVE) as robot:
        assert write_and_deploy(project, "the first", robot).code == 0
        robot.said("this is the first")
        result = write_and_deploy(project, "the second", robot)
        assert result.code == 0, result.output
        assert "frcKillRobot.sh did not end the old program; it was killed" in result.stdout
        assert "frcKillRobot.sh was replaced; the old script is kept" in result.stdout
        robot.said("this is the second")
        assert len(programs_on(robot)) == 1
        assert (robot.disk / script).read_text().startswith("#!/bin/bash\n# pyfrc's")
        assert (
            robot.disk / script.with_name("frcKillRobot.image.sh")
        ).read_bytes() == LETS_PROGRAMS_SURVIVE.read_bytes()
        # From now on, nothing survives: the agent has nothing to end.
        result = write_and_deploy(project, "the third", robot)
        assert result.code == 0, result.output
        assert "frcKillRobot.sh" not in result.output
        robot.said("this is the third")
        assert len(programs_on(robot)) == 1
