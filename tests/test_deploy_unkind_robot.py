"""Deploys to a look-alike whose kill script fails, or whose console is silent."""

from __future__ import annotations

import socket
import threading
from pathlib import Path

import pytest
from roborio import PATIENCE, Roborio, require_roborio
from roborio.local import project_of
from roborio.machine import LETS_PROGRAMS_SURVIVE
from roborio.ssh import SshConnection

from pyfrc_core.deploy.agent_client import AgentClient, DeployRequest

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


def test_the_console_is_silent_without_a_driver_station(tmp_path: Path) -> None:
    require_roborio()
    project = project_of(tmp_path, {"robot.py": ROBOT.format(name="a robot")})
    with Roborio(driver_station=False) as roborio, SshConnection(roborio.host, roborio.port) as connection:
        robot = AgentClient.start(connection)
        robot.deploy(project, DeployRequest("robot.py", {}))
        robot.restart()
        roborio.said("this is a robot")
        assert robot.watch(0.5, unheard=0.1).output == ""
        connected, done = threading.Event(), threading.Event()

        def be_a_driver_station() -> None:
            with socket.socket(type=socket.SOCK_DGRAM) as packets:
                while not done.is_set():
                    packets.sendto(b"packet", (roborio.host, 1110))
                    connected.set()
                    done.wait(0.05)

        driver_station = threading.Thread(target=be_a_driver_station)
        driver_station.start()
        connected.wait()  # a program that printed before the first packet would not be heard
        try:
            robot.restart()
            assert "this is a robot" in robot.watch(PATIENCE).output
        finally:
            done.set()
            driver_station.join()
            robot.close()


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
