"""`pyfrc deploy` and related commands, on a look-alike of a roboRIO with a real SSH server."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import socket
import struct
import subprocess
import threading
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path

import pytest
from at_terminal import run_at_terminal
from conftest import sampled
from driver_stations import deploy_on_field, driver_station
from roborio import Proxy, Roborio, require_roborio
from skips import missing_programs, require

from pyfrc_core.deploy.robot_checks import image_problem
from pyfrc_core.deploy.targets.roborio import ROBORIO

#: As the tool of today has it.
START_COMMAND = (
    "env LD_LIBRARY_PATH=/usr/local/frc/lib/ "
    "/usr/local/bin/python3 -u -O -m robotpy --main /home/lvuser/py/robot.py run"
)

NewRobot = Callable[..., Roborio]

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


@pytest.fixture
def new_robot() -> Iterator[NewRobot]:
    """Makes look-alikes, for one test."""
    require_roborio()
    with contextlib.ExitStack() as stack:
        yield lambda **how: stack.enter_context(Roborio(wpilib=how.pop("wpilib", version("wpilib")), **how))


@pytest.fixture
def robot(new_robot: NewRobot) -> Roborio:
    return new_robot()


def deploy(project, robot: Roborio | Proxy, *args: str, command: str = "deploy"):
    where = robot.where if isinstance(robot, Roborio) else f"{robot.host}:{robot.port}"
    skip = ["--skip-tests"] if command == "deploy" else []
    return project.run(command, *skip, "--robot", where, *args, env={"SSH_AUTH_SOCK": ""})


def events(result) -> list[dict]:
    return [json.loads(line) for line in result.stdout.splitlines()]


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


def test_a_deploy_prints_one_line_per_phase_and_the_program_runs(robot: Roborio, make_project) -> None:
    project = make_project(program())
    result = deploy(project, robot)
    assert result.code == 0, result.output
    lines = [line.split()[0] for line in result.stdout.splitlines() if line.endswith(" s")]
    assert lines == ["files", "find", "connect", "look", "upload", "start"]
    assert "StartupDLLs was switched off" in result.stdout.partition("\nstart ")[2], "the start waits for it not"
    robot.said("we are number 1")
    record = json.loads((robot.home / "py/deploy.json").read_text())
    assert record["code-path"] == str(project.path)
    assert set(record) == {"deploy-host", "deploy-user", "deploy-date", "code-path"}
    assert (robot.disk / "etc/natinst/share/ni-rt.ini").read_text().count("\n;StartupDLLs") == 1


@pytest.mark.slow
def test_a_deploy_from_a_checkout_records_the_commit(robot: Roborio, make_project) -> None:
    require("which commit was deployed", missing_programs("git"))
    project = make_project(program())
    git = ["git", "-C", str(project.path), "-c", "user.name=x", "-c", "user.email=x@example.org"]
    for arguments in (["init", "-q", "-b", "main"], ["add", "robot.py"], ["commit", "-qm", "it works"]):
        subprocess.run([*git, *arguments], check=True)
    project.write({"robot.py": ROBOT.format(number=2)})
    assert deploy(project, robot).code == 0
    commit = subprocess.run([*git, "rev-parse", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
    info = events(deploy(project, robot, "--json", command="deploy-info"))[-1]
    assert info["deploy_json"]["git-hash"] == commit
    assert info["deploy_json"]["git-branch"] == "main"
    shown = deploy(project, robot, command="deploy-info").stdout
    assert f"{commit[:7]} on main, with uncommitted changes" in shown
    assert f"release {info['current']}, running" in shown


@pytest.mark.slow
def test_the_plan_is_shown_and_nothing_is_done(robot: Roborio, make_project) -> None:
    project = make_project({**program(), "old.py": "", "same.py": "X = 1\n"})
    assert deploy(project, robot).code == 0
    (project.path / "old.py").unlink()
    project.write({**program(2), "new.py": ""})
    result = deploy(project, robot, "--dry-run")
    assert result.code == 0, result.output
    assert "+ new.py\n~ robot.py\n- old.py\n1 to add, 1 to change, 1 to remove; " in result.stdout
    assert events(deploy(project, robot, "--dry-run", "--json"))[-1]["plan"] == {
        "added": ["new.py"],
        "changed": ["robot.py"],
        "removed": ["old.py"],
        "files_to_send": 1 if not (project.path / "new.py").stat().st_size else 2,
        "bytes_to_send": (project.path / "robot.py").stat().st_size,
    }
    assert sorted(file.name for file in (robot.home / "py").glob("*.py")) == ["old.py", "robot.py", "same.py"]
    assert "number 1" in code_on(robot)


def test_for_tools_every_line_is_json(robot: Roborio, make_project) -> None:
    project = make_project({**program(), "tests/test_it.py": "def test_it(): print('words')\n"})
    result = project.run("deploy", "--robot", robot.where, "--json")
    assert result.code == 0, result.output
    reported = events(result)
    assert [each["phase"] for each in reported if each["event"] == "phase"][:2] == ["tests", "files"]
    assert reported[-1]["event"] == "result"
    assert reported[-1]["release"] == 1
    assert reported[-1]["host"] == robot.host
    assert "1 passed" in result.stderr
    failed = project.run("deploy", "--skip-tests", "--robot", "127.0.0.1:1", "--json")
    error = events(failed)[-1]
    assert failed.code == error["exit_code"] == 1
    assert (error["event"], error["kind"]) == ("error", "RobotNotFound")


# -- programs that die, and going back ---------------------------------------------------------------------------------


def test_a_program_that_dies_is_shown_with_its_traceback_and_the_way_back(robot: Roborio, make_project) -> None:
    project = make_project(program(1))
    assert deploy(project, robot).code == 0
    project.write(program(2, DIES))
    result = deploy(project, robot)
    assert result.code == 3
    assert "| RuntimeError: no such gyro" in result.stdout
    assert f"Go back to the previous program with: pyfrc deploy --robot {robot.where} --rollback" in result.stderr
    assert "number 2" in code_on(robot)
    result = deploy(project, robot, "--auto-rollback")
    assert result.code == 3
    assert "release 1 runs again" in result.stderr
    assert "number 1" in code_on(robot)


@pytest.mark.slow
def test_at_a_terminal_the_way_back_is_offered(robot: Roborio, make_project) -> None:
    project = make_project(program(1))
    assert deploy(project, robot).code == 0
    project.write(program(2, DIES))
    args = ["deploy", "--skip-tests", "--robot", robot.where]
    code, shown = run_at_terminal(project, args, [("Go back to release 1?", "y")])
    assert code == 3, shown
    assert "release 1 runs again" in shown
    assert "number 1" in code_on(robot)


@pytest.mark.slow
def test_a_first_program_that_dies_has_nothing_to_go_back_to(robot: Roborio, make_project) -> None:
    project = make_project(program(1, DIES))
    result = deploy(project, robot, "--auto-rollback")
    assert result.code == 3
    assert "There is no earlier program to go back to" in result.stderr


@pytest.mark.slow
def test_the_program_of_another_tool_is_kept_for_a_rollback(robot: Roborio, make_project) -> None:
    robot.put("home/lvuser/py/robot.py", ROBOT.format(number=77))
    robot.put("home/lvuser/py/deploy.json", '{"deploy-user": "kim", "deploy-host": "pit", "deploy-date": "yesterday"}')
    robot.put("home/lvuser/robotCommand", START_COMMAND + "\n")
    project = make_project(program())
    shown = deploy(project, robot, command="deploy-info").stdout
    assert "program    deployed by another tool" in shown
    assert "by           kim on pit" in shown
    result = deploy(project, robot)
    assert result.code == 0, result.output
    assert "the program of another tool is kept as release 1" in result.stdout
    shown = deploy(project, robot, command="deploy-info").stdout
    assert "release 1   yesterday, kim on pit, left by another tool" in shown
    result = deploy(project, robot, "--rollback")
    assert result.code == 0, result.output
    assert "number 77" in code_on(robot)


@pytest.mark.slow
def test_what_is_carried_over_under_another_name_or_not_at_all_is_named(robot: Roborio, make_project) -> None:
    project = make_project(program())
    assert deploy(project, robot).code == 0
    robot.put("home/lvuser/py/logs/match.csv", "precious")
    robot.run("mkfifo", "-m", "600", "/home/lvuser/py/pipe")
    (project.path / "logs").write_text("a file")
    result = deploy(project, robot)
    assert result.code == 0, result.output
    assert "which is kept as 'logs.release-1'" in result.stdout
    assert "not carried over (pipes, sockets, devices): 'pipe'" in result.stdout
    assert (robot.home / "py/logs.release-1/match.csv").read_text() == "precious"


@pytest.mark.slow
def test_undeploying_has_to_be_meant(robot: Roborio, make_project) -> None:
    project = make_project(program())
    assert deploy(project, robot).code == 0
    result = deploy(project, robot, command="undeploy")
    assert (result.code, "--yes" in result.stderr) == (2, True)
    code, shown = run_at_terminal(project, ["undeploy", "--robot", robot.where], [("Continue?", "n")])
    assert (code, "nothing was removed" in shown) == (1, True)
    assert "number 1" in code_on(robot)
    result = deploy(project, robot, "--yes", "--json", command="undeploy")
    assert (result.code, events(result)[-1]["removed"]) == (0, True)
    assert not (robot.home / "py").exists()
    assert not (robot.home / "robotCommand").exists()
    assert "program    none" in deploy(project, robot, command="deploy-info").stdout


# -- what is looked at before ------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_failing_test_prevents_the_deploy_unless_the_user_confirms(robot: Roborio, make_project) -> None:
    project = make_project({**program(), "tests/test_it.py": "def test_it(): raise ValueError('crooked')\n"})
    result = project.run("deploy", "--robot", robot.where)
    assert result.code == 1
    assert "crooked" in result.stdout
    assert "not deployed: the tests failed" in result.stderr
    assert "--skip-tests" in result.stderr
    assert not (robot.home / "py").exists()
    for answer, expected in (("n", 1), ("y", 0)):
        args = ["deploy", "--robot", robot.where]
        code, shown = run_at_terminal(project, args, [("Deploy anyway?", answer)])
        assert code == expected, shown
    assert "number 1" in code_on(robot)


@pytest.mark.slow
def test_a_program_that_cannot_be_imported_is_not_deployed(robot: Roborio, make_project) -> None:
    project = make_project(program(1, "\nimport no_such_library\n"))
    result = deploy(project, robot)
    assert result.code == 1
    assert "robot.py:8" in result.stderr
    assert "no_such_library" in result.stderr
    assert not (robot.home / "py").exists()


@pytest.mark.slow
def test_without_tests_the_ready_made_ones_are_suggested(robot: Roborio, make_project) -> None:
    project = make_project(program())
    result = project.run("deploy", "--robot", robot.where)
    assert result.code == 0, result.output
    assert "no tests" in result.stdout
    assert "--builtin" in result.stdout
    result = project.run("deploy", "--robot", robot.where, "--builtin")
    assert result.code == 0, result.output
    assert " passed in " in result.stdout


@pytest.mark.slow
def test_another_main_file_has_to_be_meant(robot: Roborio, make_project) -> None:
    project = make_project({"our_robot.py": ROBOT.format(number=5)})
    result = deploy(project, robot, "--main", "our_robot.py")
    assert result.code == 1
    assert "--nonstandard" in result.stderr
    result = deploy(project, robot, "--main", "our_robot.py", "--nonstandard")
    assert result.code == 0, result.output
    assert "/home/lvuser/py/our_robot.py run" in (robot.home / "robotCommand").read_text()
    robot.said("we are number 5")


# -- what can be wrong with a robot ------------------------------------------------------------------------------------

OURS = version("wpilib")


#: Each problem with its sentence and the beginning of its remedy.
PROBLEMS = [
    ({"wpilib": "2026.1.1"}, f"the robot has wpilib 2026.1.1, this computer has {OURS}", "--no-version-check"),
    ({"password": "secret"}, "refuses lvuser with an empty password", "passwd -d lvuser"),
    ({"image": None}, "this is not a roboRIO", "--robot HOST"),
    ({"python": None}, "there is no Python on the robot", "pyfrc sync; then at the robot: pyfrc deploy"),
    ({"wpilib": None}, "there is no wpilib", "at the robot: pyfrc deploy"),
    ({"image": "FRC_roboRIO_2024_v2.1"}, "the robot's image is of 2024", "roboRIO Imaging Tool"),
    ({"image": "FRC_roboRIO_2026_v1.1"}, "the robot's image is 2026_v1.1", "image 2026_v1.2"),
    ({"disk_size": "700k"}, "the robot's disk is full", "Remove what the project does not need"),
]


@pytest.mark.parametrize(
    ("how", "what", "remedy"), sampled(PROBLEMS, PROBLEMS[0]), ids=["-".join(how) for how, _, _ in PROBLEMS]
)
def test_problems_of_a_robot_are_reported_with_remedies(how, what, remedy, new_robot, make_project) -> None:
    robot = new_robot(**how)
    project = make_project({**program(), "noise.txt": os.urandom(500_000).hex() if "disk_size" in how else ""})
    result = deploy(project, robot, "--large")
    assert result.code == 1, result.output
    assert what in result.stderr
    assert remedy in result.stderr
    assert "Traceback" not in result.output
    assert not (robot.home / "py").exists()


def test_the_second_model_s_image_is_accepted() -> None:
    assert image_problem("FRC_roboRIO2_2026_v1.2", OURS, ROBORIO) is None


@pytest.fixture
def user_keys(tmp_path: Path) -> Path:
    """A directory with two of the user's keys: the one that the robot wants, and another."""
    for name in ("right", "wrong"):
        subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(tmp_path / name)], check=True)
    return tmp_path


@pytest.mark.slow
def test_the_ssh_agents_keys_are_offered_with_the_option(new_robot, make_project, user_keys: Path) -> None:
    robot = new_robot(authorized_key=(user_keys / "right.pub").read_text().strip())
    project = make_project(program())
    agent_socket = user_keys / "agent"
    agent = subprocess.Popen(["ssh-agent", "-D", "-a", str(agent_socket)], stdout=subprocess.PIPE, text=True)
    try:
        assert agent.stdout is not None
        agent.stdout.readline()
        environment = {"SSH_AUTH_SOCK": str(agent_socket)}
        args = ["deploy", "--skip-tests", "--robot", robot.where, "--ssh-agent"]
        for name, refusal in (
            ("", "only with a key, and there is none in your SSH agent"),
            ("wrong", "refuses lvuser with 1 of your SSH agent's keys"),
            ("right", ""),
        ):
            if name:
                subprocess.run(["ssh-add", "-q", str(user_keys / name)], env=os.environ | environment, check=True)
            result = project.run(*args, env=environment)
            assert result.code == (1 if refusal else 0), result.output
            assert refusal in result.stderr
            assert ("ssh-add FILE" in result.stderr) is bool(refusal)
    finally:
        agent.terminate()
        agent.wait()
        agent.stdout.close()


@pytest.mark.slow
def test_the_users_keys_are_offered_to_no_robot_otherwise(new_robot, make_project, user_keys: Path) -> None:
    """Nor is the agent asked for them; nor is anything read from ~/.ssh."""
    robot = new_robot(authorized_key=(user_keys / "right.pub").read_text().strip())
    home = user_keys / "home"
    (home / ".ssh").mkdir(parents=True)
    (user_keys / "right").rename(home / ".ssh/id_ed25519")
    with socket.socket(socket.AF_UNIX) as agent:
        agent.bind(str(user_keys / "agent"))
        agent.listen()
        agent.setblocking(False)
        names = {"HOME": str(home), "SSH_AUTH_SOCK": str(user_keys / "agent")}
        result = make_project(program()).run("deploy", "--skip-tests", "--robot", robot.where, env=names)
        assert result.code == 1
        assert "the robot lets lvuser in only with a key, and none was offered" in result.stderr
        assert "--identity FILE" in result.stderr
        with pytest.raises(BlockingIOError):
            agent.accept()


@pytest.mark.slow
def test_a_changed_host_key_is_refused_until_it_is_accepted(robot: Roborio, make_project) -> None:
    project = make_project(program())
    assert deploy(project, robot).code == 0
    robot.power_off()
    robot.new_host_key()
    robot.power_on()
    result = deploy(project, robot)
    assert result.code == 1
    assert "the robot's key has changed" in result.stderr
    option = result.stderr.split()[-2:]
    assert option[0] == "--accept-host-key"
    accepted = deploy(project, robot, *option, "--robot-name", "practice")
    assert accepted.code == 0
    assert "a new key, now pinned for" in accepted.stdout
    info = deploy(project, robot, command="deploy-info")
    assert info.code == 0, info.output
    assert "its key is known (practice)" in info.stdout
    assert "name       practice" in info.stdout
    facts = events(deploy(project, robot, "--json", command="deploy-info"))[-1]
    assert facts["robot_name"] == "practice"
    assert facts["host_key"].startswith("SHA256:")


def test_a_lost_connection_is_reported_and_the_next_deploy_works(robot: Roborio, make_project) -> None:
    project = make_project(program())
    # More than is sent before the robot has read any of it: with all of it sent, the robot may have switched.
    (project.path / "noise.bin").write_bytes(os.urandom(3_000_000))
    with Proxy((robot.host, robot.port), rate=200_000, cut_to_robot=60_000) as proxy:
        result = deploy(project, proxy, "--large")
    assert result.code == 1, result.output
    assert "the connection to the robot was lost" in result.stderr
    assert "run the command again" in result.stderr
    assert "Traceback" not in result.output
    result = deploy(project, robot, "--large")
    assert result.code == 0, result.output


@pytest.mark.parametrize("as_json", sampled([False, True], False))
def test_ctrl_c_leaves_all_whole(as_json: bool, robot: Roborio, make_project) -> None:
    project = make_project(program(1))
    assert deploy(project, robot).code == 0
    project.write(program(2))
    # More than is sent before the robot has read any of it: with all of it sent, the robot may have switched.
    (project.path / "noise.bin").write_bytes(os.urandom(3_000_000))
    with Proxy((robot.host, robot.port), rate=25_000) as proxy:
        where = f"{proxy.host}:{proxy.port}"
        words = ["deploy", "--skip-tests", "--large", "--robot", where, *["--json"] * as_json]
        with project.start(*words, apart=True) as command:
            while proxy.bytes_to_robot < 40_000:  # until it is in the middle of it
                assert command.poll() is None
                threading.Event().wait(0.01)
            command.send_signal(signal.SIGINT)
            output, errors = command.rest()
            assert command.wait() == 130
    assert errors.strip() == "interrupted"
    if as_json:
        last = json.loads(output.splitlines()[-1])
        assert (last["event"], last["message"], last["exit_code"]) == ("error", "interrupted", 130)
    assert "number 1" in code_on(robot)
    assert not (robot.home / "py/noise.bin").exists()
    assert deploy(project, robot, "--large").code == 0
    assert "number 2" in code_on(robot)


def test_on_a_competition_field_nothing_is_deployed(make_project) -> None:
    require_roborio()  # for its namespaces: the port of the Driver Station is one for the whole computer
    require("deploying on a competition field", missing_programs("ip"))
    project = make_project(program())
    done = deploy_on_field(project, 1742, {"robotIP": 0, "FMS Connected": True})
    assert done.returncode == 1, done.stdout + done.stderr
    assert "competition field (FMS)" in done.stderr
    assert "when your match is over" in done.stderr


# -- without a robot ---------------------------------------------------------------------------------------------------


def test_without_a_robot_the_failed_attempts_are_listed(make_project) -> None:
    result = make_project(program()).run("deploy", "--skip-tests", "--robot", "127.0.0.1:1")
    assert result.code == 1
    assert "127.0.0.1:1  by the command  refused" in result.stderr
    assert "refused: no virtual robot runs at port 1\n" in result.stderr
    assert "A virtual robot prints it. Start one in another terminal: pyfrc virtual-robot" in result.stderr


#: Options that cannot be together, or not have such values.
WRONG = """
--in-place --auto-rollback
--rollback --dry-run
--rollback x
--json --nc
--dry-run --nc-ds
--robot 127.0.0.1 --team 1
--robot 127.0.0.1:x
--robot lvuser@127.0.0.1
--robot --skip-tests
--skip-tests --robot-name --dry-run
--skip-tests --identity --dry-run
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
