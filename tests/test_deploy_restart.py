"""A deploy that restarts the program without another request."""

from __future__ import annotations

from pathlib import Path

import pytest
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import LocalRobot, project_of

from pyfrc_core.deploy.agent_client import DeployRequest
from pyfrc_core.deploy.errors import RefusedError


def counting(robot: LocalRobot) -> Path:
    """Have the robot's kill script write a line each time; return the file."""
    restarts = robot.root / "restarts"
    (robot.root / "usr/local/frc/bin/frcKillRobot.sh").write_text(f"#!/bin/sh\necho $* >> {restarts}\n")
    restarts.write_text("")
    return restarts


def test_one_request_for_both(robot: LocalRobot, tmp_path: Path) -> None:
    restarts = counting(robot)
    for number in range(1, 6):
        project = project_of(tmp_path / "project", {"robot.py": f"# {number}\n"})
        session = robot.start()
        deployed = session.deploy(project, DeployRequest("robot.py", {}, restart=True))
        assert deployed.release == number
        assert session.restart() is False
        assert restarts.read_text() == "-t -r\n" * number
        assert [each.number for each in session.info().releases] == list(range(max(1, number - 2), number + 1))
        session.close()


def test_again_by_a_request(robot: LocalRobot, tmp_path: Path) -> None:
    restarts = counting(robot)
    session = robot.start()
    session.deploy(project_of(tmp_path / "project", {"robot.py": ""}), DeployRequest("robot.py", {}, restart=True))
    session.restart()
    session.restart()
    session.close()
    assert restarts.read_text() == "-t -r\n" * 2


def test_a_deploy_that_is_refused_restarts_nothing(robot: LocalRobot, tmp_path: Path) -> None:
    restarts = counting(robot)
    project = project_of(tmp_path / "project", {"robot.py": "1 +\n"})
    session = robot.start()
    with pytest.raises(RefusedError):
        session.deploy(project, DeployRequest("robot.py", {}, program=["robot.py"], restart=True))
    assert session.info().current is None
    session.close()
    assert restarts.read_text() == ""
