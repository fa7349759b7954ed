"""Robots and projects that a deploy refuses, each with one sentence."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import closing
from importlib.metadata import version
from pathlib import Path

import pytest
from conftest import RobotProject
from roborio import Roborio, require_roborio
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, Agents, LocalRobot, project_of

from pyfrc_core.deploy.agent.disk import disk_problem
from pyfrc_core.deploy.agent.system import user
from pyfrc_core.deploy.agent_client import DeployRequest
from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.doctor.robot import RobotSearch
from pyfrc_core.project import find_project


@pytest.fixture
def look_alike() -> Iterator[Roborio]:
    require_roborio()
    with Roborio(wpilib=version("wpilib")) as robot:
        yield robot


@pytest.fixture
def project(make_project) -> RobotProject:
    return make_project({"robot.py": ROBOT_PY, "pyproject.toml": ""})


def refusal(project: RobotProject, robot: Roborio, *command: str) -> str:
    """Return the one line of the error, without the robot's address, and its remedy."""
    result = project.run(*(command or ("deploy", "--skip-tests")), "--robot", robot.where)
    assert result.code == 1, result.output
    what, remedy = result.stderr.splitlines()
    return f"{what.removeprefix(f'error: {robot.where}: ')}\n{remedy.strip()}"


def test_a_python_that_is_too_old(project: RobotProject, look_alike: Roborio) -> None:
    file = look_alike.disk / "usr/local/lib/python3.14/site-packages/sitecustomize.py"
    file.write_text(file.read_text().replace("(3, 14, 0", "(3, 8, 10"))
    assert refusal(project, look_alike).startswith(
        "the robot's Python 3.8 is too old: pyfrc needs 3.9 or newer\nPrepare the robot: "
    )
    found = [each.text for each in RobotSearch(find_project(project.path), look_alike.where).findings()]
    assert any("the robot's Python 3.8 is too old" in text for text in found), found


def test_other_problems_of_the_disk(tmp_path: Path) -> None:
    missing, directory = tmp_path / "missing", tmp_path / "directory"
    directory.mkdir()
    assert disk_problem(OSError(errno.EROFS, ""), "admin") == (
        "the robot's disk cannot be written: it is read-only, as after an error",
        "Switch the robot off and on again; if that does not help, image it.",
    )
    taken = OSError(errno.EISDIR, "Is a directory", str(missing), None, str(directory))
    assert disk_problem(taken, "admin") == (f"{directory}: Is a directory", "Remove or rename it on the robot.")
    assert disk_problem(OSError(errno.EIO, "Input/output error"), "admin") == (
        "the robot: Input/output error",
        "Check its owner and permissions.",
    )
    if user() != "root":
        directory.chmod(0o555)
        assert (
            f"{directory} on the robot belongs"
            in disk_problem(PermissionError(13, "", str(directory / "a")), "admin")[0]
        )


def test_a_file_that_becomes_a_pipe_while_it_is_sent(robot: LocalRobot, agents: Agents, tmp_path: Path) -> None:
    manifest = project_of(tmp_path / "project", {"robot.py": ROBOT_PY, "log.txt": "x"})
    (tmp_path / "project/log.txt").unlink()
    os.mkfifo(tmp_path / "project/log.txt")
    with (
        closing(robot.start(agents)) as client,
        pytest.raises(RefusedError, match=r"^local: log.txt was changed while it was sent\n  Deploy again.$"),
    ):
        client.deploy(manifest, DeployRequest("robot.py", {}))
    assert robot.startable() is None
