"""Deploys to a look-alike of a SystemCore, and to a virtual one, with the commands of `pyfrc`."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Generator
from importlib.metadata import version
from pathlib import Path

import pytest
from conftest import MakeProject, Result, RobotProject
from driver_stations import driver_station
from roborio import Proxy
from systemcore import Systemcore, require_systemcore

ROBOT = """
    import wpilib

    print("this is version {version}")


    class MyRobot(wpilib.TimedRobot):
        pass
"""
CRASHES = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            raise RuntimeError("no gyro")
"""
JAVA = "java -jar /home/systemcore/Robot.jar\n"


@pytest.fixture
def robot() -> Generator[Systemcore]:
    require_systemcore()
    with Systemcore(wpilib=version("wpilib")) as robot:
        yield robot


@pytest.fixture
def project(make_project: MakeProject) -> RobotProject:
    return make_project({"robot.py": ROBOT.format(version=1), "other.py": "VALUE = 1\n"})


def run(project: RobotProject, robot: Systemcore, command: str, *options: str) -> Result:
    # In a new interpreter: the one that commands are forked from has imported WPILib, which a deploy never does, and
    # whose threads of this season end a fork of it that ends.
    return project.run(command, *options, "--robot", robot.where, cold=True)


def deploy(project: RobotProject, robot: Systemcore, *options: str) -> Result:
    return run(project, robot, "deploy", "--skip-tests", *options)


def info(project: RobotProject, robot: Systemcore) -> dict:
    result = run(project, robot, "deploy-info", "--json")
    assert result.code == 0, result.output
    return json.loads(result.stdout.splitlines()[-1])


def test_deploy_change_roll_back_and_undeploy(project: RobotProject, robot: Systemcore) -> None:
    first = deploy(project, robot)
    assert first.code == 0, first.output
    lines = [line.split()[0] for line in first.stdout.splitlines() if line.endswith(" s")]
    assert lines == ["files", "find", "connect", "look", "upload", "start"]
    assert "the program runs" in first.stdout
    robot.said("this is version 1")
    command = robot.home / "robotCommand"
    assert command.read_text(encoding="utf-8") == (
        "/home/systemcore/venv/bin/python3 -u -O -m robotpy --main /home/systemcore/py/robot.py run\n"
    )
    assert command.stat().st_mode & 0o777 == 0o755
    again = deploy(project, robot)
    assert (again.code, "nothing has changed" in again.stdout) == (0, True), again.output
    project.write({"robot.py": ROBOT.format(version=2)})
    second = deploy(project, robot)
    assert re.search(r"^upload +1 file, \d+ bytes; release 2", second.stdout, re.MULTILINE), second.output
    robot.said("this is version 2")
    back = run(project, robot, "deploy", "--rollback")
    assert (back.code, "runs release 1 again" in back.stdout) == (0, True), back.output
    known = info(project, robot)
    assert (known["current"], known["running"]) == (1, True)
    assert known["deploy_json"]["code-path"] == str(project.path)
    gone = run(project, robot, "undeploy", "--yes")
    assert (gone.code, "was removed" in gone.stdout) == (0, True), gone.output
    assert {each.name for each in robot.home.iterdir()} == {".python", "venv"}
    assert robot.run("/usr/local/bin/systemctl", "is-active", "robot").returncode == 1


def test_a_program_that_crashes_is_rolled_back(project: RobotProject, robot: Systemcore) -> None:
    assert deploy(project, robot).code == 0
    project.write({"robot.py": CRASHES})
    result = deploy(project, robot, "--auto-rollback")
    assert result.code == 3, result.output
    assert "RuntimeError: no gyro" in result.stdout
    assert "release 1 runs again" in result.stderr
    known = info(project, robot)
    assert (known["current"], known["running"]) == (1, True)


@pytest.mark.slow
def test_a_program_in_java_is_replaced_at_the_switch(project: RobotProject, robot: Systemcore) -> None:
    command, jar = robot.put("/home/systemcore/robotCommand", JAVA), robot.put("/home/systemcore/Robot.jar", "")
    project.write({"robot.py": "import wpilib, no_such_module\n"})
    refused = deploy(project, robot)
    assert (refused.code, command.read_text(encoding="utf-8"), jar.exists()) == (1, JAVA, True), refused.output
    project.write({"robot.py": ROBOT.format(version=1)})
    result = deploy(project, robot)
    assert (result.code, jar.exists()) == (0, True), result.output
    assert info(project, robot)["running"]


@pytest.mark.slow
def test_a_disk_that_cannot_be_written(project: RobotProject, robot: Systemcore) -> None:
    assert deploy(project, robot).code == 0
    robot.run("chown", "-R", "root", "/home/systemcore/.pyfrc")
    project.write({"robot.py": ROBOT.format(version=2)})
    result = deploy(project, robot)
    assert result.code == 1, result.output
    assert "on the robot: sudo chown -R systemcore /home/systemcore/.pyfrc" in result.stderr
    assert info(project, robot)["running"]


@pytest.mark.slow
def test_a_slow_link(project: RobotProject, robot: Systemcore) -> None:
    """As a bad radio: 0.1 s for a round trip, 25 kB in a second."""
    with Proxy((robot.host, robot.port), round_trip=0.1, rate=25_000) as proxy:
        where = f"{proxy.host}:{proxy.port}"
        result = project.run("deploy", "--skip-tests", "--robot", where, cold=True)
    assert (result.code, "the program runs" in result.stdout) == (0, True), result.output
    robot.said("this is version 1")


@pytest.mark.parametrize("clock", ["@0", "@4000000000"], ids=["1970", "2096"])
@pytest.mark.slow
def test_a_wrong_clock_is_no_obstacle(clock: str, project: RobotProject, robot: Systemcore) -> None:
    """As on a robot whose Driver Station has not set it yet: files seem to be old, or of the future."""
    assert deploy(project, robot).code == 0
    ours = "find /home/systemcore -xdev -path /home/systemcore/.python -prune -o -exec"
    everything = f"{ours} touch -h -d {clock} {{}} +"
    robot.run("sh", "-c", everything)
    assert "nothing has changed" in deploy(project, robot).stdout
    project.write({"robot.py": ROBOT.format(version=2)})
    assert deploy(project, robot).code == 0
    robot.said("this is version 2")


def test_the_driver_stations_robot_is_found(project: RobotProject, robot: Systemcore) -> None:
    if robot.port != 22:
        pytest.skip("deploying through the Driver Station: needs port 22, which this computer's own SSH server has")
    with driver_station(6770, {"robotIp": robot.host, "fmsControlled": False}):
        result = project.run("deploy", "--skip-tests", "--team", "9999", cold=True)
    assert result.code == 0, result.output
    assert f"find       {robot.host} (the Driver Station's robot)" in result.stdout


def test_the_console_shows_what_the_program_prints(project: RobotProject, robot: Systemcore) -> None:
    project.write({"robot.py": ROBOT.format(version=1) + TALKS})
    assert deploy(project, robot).code == 0
    with project.start("console", "--robot", robot.where, apart=True) as console:
        assert any("still here" in line for line in console.stdout)


#: A robot that prints a line each second, in robot time or not.
TALKS = """
        def robot_periodic(self):
            print("still here", flush=True)
"""


@pytest.mark.slow
def test_a_virtual_systemcore(project: RobotProject, tmp_path: Path) -> None:
    command = ["virtual-robot", "--directory", str(tmp_path / "disk"), "--", sys.executable, "-m", "pyfrc"]
    result = project.run(*command, "deploy", "--skip-tests", "--robot")
    assert result.code == 0, result.output
    assert "the program runs" in result.stdout
    assert (tmp_path / "disk/root/home/systemcore/py/robot.py").exists()
