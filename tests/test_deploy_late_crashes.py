"""Programs that crash after their watched start: what records say. Which programs report their start."""

from __future__ import annotations

import errno
import os
from contextlib import closing
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from loops import for_each
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, LocalRobot, project_of

from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.program import _reports_start
from pyfrc_core.deploy.agent.release_record import (
    LONG,
    Boot,
    Record,
    after_watch,
    now,
    parse_record,
    record_text,
    standing,
)
from pyfrc_core.deploy.agent.releases import Releases
from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.targets.roborio import ROBORIO


@for_each(
    "source, reports",
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
    (tmp_path / "tests").mkdir(exist_ok=True)
    (tmp_path / "tests/fake.py").write_text("class Fake(wpilib.TimedRobot):\n")
    assert _reports_start(main) == reports
    assert _reports_start(None) is True


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


@given(st.binary(max_size=40), st.integers(0, 100))
def test_a_damaged_record_is_no_record(garbage: bytes, place: int) -> None:
    """Whatever a disk makes of its file; a robot's file may also be of nothing but zeros."""
    record = {"commands": {"robotCommand": "\udcff"}, "lasted": 1.5}
    text = record_text(record)
    assert parse_record(text) == record
    for damaged in (text[:place], text[:place] + "x" + text[place + 1 :], garbage.decode(errors="surrogateescape")):
        assert damaged == text or parse_record(damaged) == {}


@pytest.mark.parametrize("number", [2, 3])
def test_a_damaged_record_prevents_no_deploy_and_no_rollback(robot: LocalRobot, tmp_path: Path, number: int) -> None:
    for each in (1, 2, 3):
        robot.deploy(project_of(tmp_path / "project", {"robot.py": f"{ROBOT_PY}# {each}\n"}))
    (robot.home / f".pyfrc/releases/{number}.json").write_bytes(b'{"commands": {}, "files": [1]}')
    with closing(robot.start()) as client:
        assert {each.number: each.damaged for each in client.facts.releases} == {
            each: each == number for each in (1, 2, 3)
        }
        assert client.rollback().release.number == (1 if number == 2 else 2)
    robot.deploy(project_of(tmp_path / "project", {"robot.py": f"{ROBOT_PY}# 4\n"}))
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
