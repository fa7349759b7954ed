"""`pyfrc deploy` and related commands, on a look-alike of a roboRIO with a real SSH server."""

from __future__ import annotations

import json
import re
import socket
import struct

from at_terminal import run_at_terminal
from driver_stations import driver_station
from roborio import Roborio
from roborio.fixtures import roborio  # noqa: F401 - `robot`
from skips import require

ROBOT = """\
import wpilib


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        print("we are number {number}")
"""

#: At the end of robot.py: what has gone wrong is seen on the robot only.
DIES = """

import os

if os.path.exists("/usr/local/frc"):
    raise RuntimeError("no such gyro")
"""


def program(number: int = 1, more: str = "") -> dict[str, str]:
    return {"robot.py": ROBOT.format(number=number) + more}


def deploy(project, robot: Roborio, *args: str):
    return project.run("deploy", "--skip-tests", "--robot", robot.where, *args, env={"SSH_AUTH_SOCK": ""})


def code_on(robot: Roborio) -> str:
    return (robot.home / "py/robot.py").read_text()


# -- the way that everybody goes ---------------------------------------------------------------------------------------


def test_a_new_user_comes_to_a_running_program_with_one_command_and_one_question(robot: Roborio, make_project) -> None:
    if robot.port != 22:
        require("deploying through the Driver Station", ["port 22, which this computer's own SSH server has"])
    project = make_project({})
    assert project.run("init").code == 0
    number = struct.unpack("!I", socket.inet_aton(robot.host))[0]
    with driver_station(1742, {"robotIP": number, "FMS Connected": False}):
        code, shown = run_at_terminal(project, ["deploy"], [("What is your team number?", "9999")])
        assert code == 0, shown
        assert len(re.findall(r"\w\?", shown)) == 1, shown
        robot.said("Robot program startup complete")
        assert "SHA256:" in shown
        assert "passed" in shown  # the template's tests
        assert json.loads((project.path / ".wpilib/wpilib_preferences.json").read_text()) == {"teamNumber": 9999}
        again = project.run("deploy", "--skip-tests")
        assert again.code == 0, again.output
        assert "nothing has changed" in again.stdout
        assert "SHA256:" not in again.stdout


def test_a_program_runs_and_one_that_dies_is_shown_with_its_traceback_and_the_way_back(
    robot: Roborio, make_project
) -> None:
    project = make_project(program(1))
    result = deploy(project, robot)
    assert result.code == 0, result.output
    phases = ["files", "find", "connect", "look", "upload", "start"]
    assert [line.split()[0] for line in result.stdout.splitlines() if line.endswith(" s")] == phases
    assert "StartupDLLs was switched off" in result.stdout.partition("\nstart ")[2], "the start waits for it not"
    robot.said("we are number 1")
    record = json.loads((robot.home / "py/deploy.json").read_text())
    assert record["code-path"] == str(project.path)
    assert (robot.disk / "etc/natinst/share/ni-rt.ini").read_text().count("\n;StartupDLLs") == 1
    project.write(program(2, DIES))
    result = deploy(project, robot, "--json")
    reported = [json.loads(line) for line in result.stdout.splitlines()]
    assert [each["phase"] for each in reported if each["event"] == "phase"] == phases
    assert any("RuntimeError: no such gyro" in each["text"] for each in reported if each["event"] == "output")
    assert (reported[-1]["event"], reported[-1]["exit_code"], result.code) == ("error", 3, 3)
    assert f"Go back to the previous program with: pyfrc deploy --robot {robot.where} --rollback" in result.stderr
    assert "number 2" in code_on(robot)
    result = deploy(project, robot, "--auto-rollback")
    assert result.code == 3
    assert "release 1 runs again" in result.stderr
    assert "number 1" in code_on(robot)


# -- without a robot ---------------------------------------------------------------------------------------------------


def test_without_a_robot_the_failed_attempts_are_listed(make_project) -> None:
    project = make_project(program())
    result = project.run_here("deploy", "--skip-tests", "--robot", "127.0.0.1:1")
    assert result.code == 1
    assert "127.0.0.1:1  by the command  refused" in result.stderr
    assert "refused: no virtual robot runs at port 1\n" in result.stderr
    assert "A virtual robot prints it. Start one in another terminal: pyfrc virtual-robot" in result.stderr
    result = project.run_here("deploy", "--skip-tests", "--robot", "127.0.0.1:1", "--json")
    error = json.loads(result.stdout.splitlines()[-1])
    assert (error["event"], error["kind"], error["exit_code"], result.code) == ("error", "RobotNotFound", 1, 1)


#: Options that cannot be together, or not have such values.
WRONG = """
--rollback --dry-run
--rollback x
--json --nc
--dry-run --nc-ds
--robot 127.0.0.1 --team 1
--robot 127.0.0.1:x
--robot lvuser@127.0.0.1
--robot --skip-tests
--skip-tests --robot-name --dry-run
--skip-tests --accept-host-key --dry-run
--robot robot.local --no-resolve
--team 0
"""


def test_options_that_cannot_be_together_are_wrong_usage(make_project) -> None:
    project = make_project(program())
    for words in WRONG.strip().splitlines():
        result = project.run_here("deploy", *words.split())
        assert result.code == 2, (words, result.output)
        assert result.stderr, words
        assert "Traceback" not in result.output, words
