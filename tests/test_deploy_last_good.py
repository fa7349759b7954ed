"""Releases that were confirmed to run: they are kept, selected by a rollback, and shown."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

import pytest
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, LocalRobot, project_of

from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.release_record import LONG
from pyfrc_core.deploy.agent.releases import Releases
from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.agent_client import DeployRequest
from pyfrc_core.deploy.facts import Deployed, RobotFacts
from pyfrc_core.deploy.targets.roborio import ROBORIO

#: Deploys a program, number n, and starts it: whether the watch sees it run; None: it is not watched.
DeployAndWatch = Callable[[int, "bool | None"], Deployed]


@pytest.fixture
def deploy(robot: LocalRobot, tmp_path: Path) -> DeployAndWatch:
    def deploy(number: int, runs: bool | None) -> Deployed:
        project = project_of(tmp_path / "project", {"robot.py": f"{ROBOT_PY}# {number}\n"})
        with contextlib.closing(robot.start(runs=runs)) as session:
            deployed = session.deploy(project, DeployRequest("robot.py", {}))
            if runs is not None:
                session.restart()
                session.watch(1.0)
        return deployed

    return deploy


def facts_of(robot: LocalRobot) -> RobotFacts:
    with contextlib.closing(robot.start()) as session:
        return session.facts


def numbers(facts: RobotFacts) -> list[int]:
    return [each.number for each in facts.releases]


def test_crashes_do_not_push_out_the_last_release_that_ran(robot: LocalRobot, deploy: DeployAndWatch) -> None:
    deploy(1, True)
    good = robot.startable()
    assert [deploy(number, False).fallback for number in (2, 3, 4, 5)] == [1, 1, 1, 1]
    facts = facts_of(robot)
    assert numbers(facts) == [1, 4, 5], "it is one of the three"
    assert [(each.ran, each.ended) for each in facts.releases] == [(True, False), (False, True), (False, True)]
    with contextlib.closing(robot.start()) as session:
        assert session.rollback().release.number == 1
    assert robot.startable() == good


def test_back_to_the_one_before_if_it_ran_and_else_to_the_newest_that_did(
    robot: LocalRobot, deploy: DeployAndWatch
) -> None:
    assert deploy(1, True).fallback is None
    assert deploy(2, True).fallback == 1
    with contextlib.closing(robot.start()) as session:
        assert session.rollback().release.number == 1
    assert deploy(3, False).fallback == 1, "release 2 ran as well, and was given up"
    assert deploy(3, False).fallback == 1, "the same again"
    assert deploy(4, False).fallback == 2


def test_the_newest_that_ran_although_an_older_one_was_watched_for_longer(
    robot: LocalRobot, deploy: DeployAndWatch
) -> None:
    """Deploys that were interrupted during the watch have no verdict."""
    releases = Releases(RobotPaths(ROBORIO.layout, str(robot.root)), Activity(lambda **said: None))
    for number, lasted in ((1, 2.9), (2, 2.6)):
        deploy(number, True)
        releases.update_record(number, lambda record, lasted=lasted: {**record, "lasted": lasted})
    deploy(3, None)
    deploy(4, None)
    with contextlib.closing(robot.start()) as session:
        assert [each.ran for each in session.facts.releases] == [True, True, False, False]
        assert session.rollback().release.number == 2


def test_it_makes_no_room_on_a_small_disk(robot: LocalRobot, deploy: DeployAndWatch) -> None:
    for number, runs in ((1, True), (2, True), (3, False), (4, False)):
        deploy(number, runs)
    releases = Releases(RobotPaths(ROBORIO.layout, str(robot.root)), Activity(lambda **said: None))
    releases.prune(kept=1)
    assert releases.numbers() == [2, 4]


def test_the_release_that_ran_for_long_is_kept_when_others_ran_for_seconds(
    robot: LocalRobot, deploy: DeployAndWatch
) -> None:
    releases = Releases(RobotPaths(ROBORIO.layout, str(robot.root)), Activity(lambda **said: None))
    for number in range(1, 6):
        deployed = deploy(number, True)
        seen = {"lasted": LONG if number == 1 else 20.0, "ended": number < 5}
        releases.update_record(number, lambda record, seen=seen: {**record, **seen})
    assert deployed.fallback == 1
    assert numbers(facts_of(robot)) == [1, 4, 5]
