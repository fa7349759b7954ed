"""Programs that crash after their watched start, and programs with a main loop of their own."""

from __future__ import annotations

import errno
import io
import json
import os
from collections.abc import Iterator
from contextlib import closing
from importlib.metadata import version
from pathlib import Path

import pytest
from conftest import RobotProject, sampled
from loops import for_each
from roborio import Roborio, require_roborio
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, Agents, LocalRobot, project_of
from test_virtual_robot import ROBOT as GOOD
from test_virtual_robot import started

from pyfrc_core.deploy import session, starting
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.program import _reports_start
from pyfrc_core.deploy.agent.release_record import LONG, Boot, Record, after_watch, now, parse_record, standing
from pyfrc_core.deploy.agent.releases import Releases
from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.agent_client import DeployRequest
from pyfrc_core.deploy.progress import DeployProgress, UserInterface
from pyfrc_core.deploy.session import DeployOptions
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.team import RobotChoice
from pyfrc_core.project import find_project

LATE = """
import time

import wpilib

class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        self.began = time.monotonic()

    def disabledPeriodic(self):
        if time.monotonic() - self.began > 2.5:
            raise RuntimeError("late")
"""
OWN_LOOP = """
import time

import wpilib

class LoggedLike(wpilib.RobotBase):
    def startCompetition(self):
        print("my loop", flush=True)
        while True:
            time.sleep(0.02)

    def endCompetition(self):
        pass

class MyRobot(LoggedLike):
    pass
"""


@pytest.fixture
def project(make_project) -> RobotProject:
    return make_project({"robot.py": GOOD})


@pytest.fixture(params=sampled(["virtual robot", "look-alike"], "look-alike"))
def address(request: pytest.FixtureRequest, project: RobotProject, tmp_path: Path) -> Iterator[str]:
    """The address of a robot."""
    if request.param == "look-alike":
        require_roborio()
        with Roborio(wpilib=version("wpilib")) as robot:
            yield robot.where
    else:
        with started(project, tmp_path / "robot") as virtual:
            yield virtual.address


@pytest.mark.slow
def test_after_three_late_crashers_a_rollback_goes_to_the_program_that_runs(
    project: RobotProject, address: str
) -> None:
    def run(*command: str) -> str:
        result = project.run(*command, "--robot", address)
        assert result.code == 0, result.output
        return result.output

    def ended() -> dict[int, bool]:
        releases = json.loads(run("deploy-info", "--json").splitlines()[-1])["releases"]
        return {each["number"]: each["ended"] for each in releases}

    run("deploy", "--skip-tests")
    for number in (2, 3, 4):
        project.write({"robot.py": f"{LATE}# {number}\n"})
        output = run("deploy", "--skip-tests")
        assert "the program runs" in output
        assert (f"release {number - 1} ended after its last start" in output) == (number > 2)
        while not ended()[number]:  # until it has crashed
            pass
    # The second is kept, too, where it has run for longer than the others until the next command.
    assert {1: False, 3: True, 4: True}.items() <= ended().items()
    assert "program    release 4, ended after its last start; " in run("deploy-info")
    assert "The robot runs release 1 again." in run("deploy", "--rollback")


def test_a_program_with_its_own_loop_runs(project: RobotProject, address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    project.write({"robot.py": OWN_LOOP})
    monkeypatch.setattr(starting, "UNHEARD_SECONDS", 5.0)
    shown = io.StringIO()
    options = DeployOptions(choice=RobotChoice(robot=address), skip_tests=True)
    session.deploy(find_project(project.path), options, UserInterface(DeployProgress(shown)))
    assert "its process has run for 5 s" in shown.getvalue()
    assert "judged by its process alone: a main loop of its own, such as a MagicRobot's, does not" in shown.getvalue()
    info = project.run("deploy-info", "--robot", address).stdout
    assert ", seen to run" in info


@pytest.mark.parametrize(
    ("source", "reports"),
    [
        ("class Robot(wpilib.TimedRobot):\n", True),
        ("class Robot(commands2.TimedCommandRobot):\n", True),
        ("class Robot(\n    Mixin,\n    wpilib.TimedRobot,\n):\n", True),
        ("class Robot(pykit.loggedrobot.LoggedRobot):\n", False),
        ("from magicbot import MagicRobot\nclass Robot(MagicRobot):\n", False),
        ("class Robot(wpilib.TimedRobot):\n    def startCompetition(self):\n", False),
        (
            "class Robot(wpilib.IterativeRobotBase):\n    def run(self):\n        hal.observeUserProgramStarting()\n",
            False,
        ),
        ("# class Robot(wpilib.TimedRobot)\n", False),
    ],
)
def test_which_programs_report_the_end_of_their_start(source: str, reports: bool, tmp_path: Path) -> None:
    main = tmp_path / "robot.py"
    main.write_text("import base\n")
    (tmp_path / "base.py").write_text(source)
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests/fake.py").write_text("class Fake(wpilib.TimedRobot):\n")
    assert _reports_start(main) == reports


# -- what a record says --------------------------------------------------------------------------------------------

THIS, OTHER = Boot("this", 1000.0), Boot("other", 1000.0)
WATCHED = after_watch({"commands": {}}, True, False, 7, 2.0, THIS)


def seen(boot: Boot, process: int | None, age: float | None, record: Record = WATCHED) -> tuple[bool, float]:
    standing_now = standing(now(record, boot, set() if process is None else {process}, age))
    return standing_now.good, standing_now.lasted


def test_a_release_is_good_while_nothing_says_otherwise() -> None:
    assert seen(THIS, 7, 20.0) == (True, 20.0)
    assert seen(THIS, 7, 3600.0) == (True, LONG)
    assert seen(THIS, 8, 20.0) == (False, 2.0), "it was restarted"
    assert seen(THIS, None, None) == (False, 2.0), "it does not run"
    assert seen(THIS, 8, 70.0) == (True, LONG), "it was restarted, and lasts"
    assert seen(THIS, 8, None) == (False, 2.0), "a system that knows no ages"
    assert seen(OTHER, 8, 990.0) == (True, LONG)
    assert seen(OTHER, 8, 20.0) == (False, 2.0), "it was restarted long after the boot"
    assert seen(Boot("other", 50.0), 8, 20.0) == (True, 20.0), "it was started at the boot"
    assert seen(Boot("other"), 8, 20.0) == (True, 20.0), "a virtual robot, which starts at any time"


def test_a_withdrawn_mark_returns_only_with_a_program_that_lasts() -> None:
    withdrawn = now(WATCHED, THIS, {8}, 20.0)
    assert seen(THIS, 8, 40.0, withdrawn) == (False, 2.0)
    assert seen(Boot("other", 50.0), 9, 20.0, withdrawn) == (False, 20.0)
    assert seen(THIS, 8, 60.0, withdrawn) == (True, LONG)
    again = after_watch(withdrawn, True, False, 9, 2.0, THIS)
    assert standing(again).good


def test_the_release_that_ran_for_long_is_kept_when_others_ran_for_seconds(
    robot: LocalRobot, agents: Agents, tmp_path: Path
) -> None:
    for number in range(1, 6):
        project = project_of(tmp_path / "project", {"robot.py": f"{ROBOT_PY}# {number}\n"})
        with closing(robot.start(agents, runs=True)) as client:
            deployed = client.deploy(project, DeployRequest("robot.py", {}))
            client.restart()
            client.watch(1.0)
        file = robot.home / f".pyfrc/releases/{number}.json"
        record = json.loads(file.read_text())
        file.write_text(json.dumps({**record, "lasted": LONG if number == 1 else 20.0, "ended": number < 5}))
    assert deployed.fallback == 1
    with closing(robot.start(agents)) as client:
        assert [each.number for each in client.facts.releases] == [1, 4, 5]


GARBAGE = [
    b"",
    b"\0\0\0\0",
    b"\xff\xfe{",
    b"{",
    b"null",
    b"[]",
    b"{}",
    b"[" * 100_000,
    b'{"commands": ' + b"9" * 5000 + b"}",
    b'{"commands": {}, "files": [1]}',
    b'{"commands": {}, "files": {"robot.py": 5}}',
    b'{"commands": "rm"}',
    b'{"commands": {}, "from": "one"}',
    b'{"commands": {}, "from": -1}',
    b'{"commands": {}, "carried": {"from": 1}}',
    b'{"commands": {}, "carried": null}',
    b'{"commands": {}, "main": 3}',
    b'{"commands": {}, "deploy": 3}',
    b'{"commands": {}, "ran": "yes"}',
    b'{"commands": {}, "lasted": NaN}',
    b'{"commands": {}, "lasted": 1e400}',
    b'{"commands": {}, "process": [1]}',
]


@for_each("garbage", GARBAGE)
def test_a_damaged_record_is_no_record(garbage: bytes) -> None:
    assert parse_record(garbage.decode(errors="surrogateescape")) == {}


@pytest.mark.parametrize("number", [1, 2, 3])
def test_a_damaged_record_prevents_no_deploy_and_no_rollback(
    robot: LocalRobot, agents: Agents, tmp_path: Path, number: int
) -> None:
    for each in (1, 2, 3):
        robot.deploy(agents, project_of(tmp_path / "project", {"robot.py": f"{ROBOT_PY}# {each}\n"}))
    (robot.home / f".pyfrc/releases/{number}.json").write_bytes(b'{"commands": {}, "files": [1]}')
    with closing(robot.start(agents)) as client:
        assert {each.number: each.damaged for each in client.facts.releases} == {
            each: each == number for each in (1, 2, 3)
        }
        assert client.rollback().release.number == (1 if number == 2 else 2)
    robot.deploy(agents, project_of(tmp_path / "project", {"robot.py": f"{ROBOT_PY}# 4\n"}))
    assert robot.startable() == {"robot.py": f"{ROBOT_PY}# 4\n".encode()}


def test_what_cannot_be_written_is_valid_and_written_later(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def new() -> Releases:
        return Releases(RobotPaths(ROBORIO.layout, str(tmp_path)), Activity(lambda **said: None))

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    new().write_record(1, WATCHED)
    releases = new()
    with monkeypatch.context() as disk:
        disk.setattr("pyfrc_core.deploy.agent.releases.write_whole", full)
        with pytest.raises(OSError, match="No space"):
            releases.update_record(1, lambda record: now(record, THIS, {8}, 20.0))
    assert [standing(each.record(1)).good for each in (releases, new())] == [False, True]
    releases.write_again()
    assert not standing(new().record(1)).good
