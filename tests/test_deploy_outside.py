"""Commands outside of a project: an address is enough to inspect a robot, show its console, and roll back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import MakeProject, Result
from ports import address_without_servers
from roborio import Roborio
from roborio.fixtures import roborio  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY
from test_deploy_console import running, wait_for

ROBOT_COMMANDS = [["deploy-info"], ["console"], ["undeploy", "--yes"], ["deploy", "--rollback"]]

Run = Callable[..., Result]


@pytest.fixture
def home(tmp_path: Path) -> Path:
    directory = tmp_path / "home of the mentor"
    directory.mkdir()
    return directory


@pytest.mark.slow
def test_everything_but_a_deploy_goes_from_anywhere(robot: Roborio, home: Path, make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT_PY})

    def anywhere(*args: str) -> Result:
        names = {"HOME": str(home), "USERPROFILE": str(home), "SSH_AUTH_SOCK": ""}
        return project.run(*args, "--robot", robot.where, cwd=home, env=names)

    for number in (1, 2):
        project.write({"robot.py": ROBOT_PY + f"# {number}\n"})
        assert project.run("deploy", "--skip-tests", "--robot", robot.where).code == 0
    info = anywhere("deploy-info")
    assert info.code == 0, info.output
    assert "a new key, now pinned" in info.stdout
    assert "program    release 2, running" in info.stdout
    rolled_back = anywhere("deploy", "--rollback")
    assert rolled_back.code == 0, rolled_back.output
    assert "its key is known" in rolled_back.stdout
    assert "The robot runs release 1 again." in rolled_back.stdout
    pinned = (home / ".pyfrc/known_hosts").read_text()
    assert robot.host in pinned.split()[0]
    assert [file.name for file in home.iterdir()] == [".pyfrc"]
    robot.power_off()
    robot.new_host_key()
    robot.power_on()
    refused = anywhere("undeploy", "--yes")
    assert refused.code == 1
    assert "the robot's key has changed" in refused.stderr
    removed = anywhere("undeploy", "--yes", *refused.stderr.split()[-2:])
    assert removed.code == 0, removed.output
    assert not (robot.home / "py").exists()


def test_the_console_goes_from_anywhere(make_project: MakeProject) -> None:
    host = address_without_servers()
    with running(make_project({}), "console", "--robot", host) as console:
        wait_for(console, f"{host}:1741 refuses the connection")
    assert console.wait() == 130


@pytest.mark.parametrize("command", ROBOT_COMMANDS, ids=" ".join)
def test_where_nothing_names_a_robot_a_project_is_asked_for(command: list[str], make_project: MakeProject) -> None:
    result = make_project({}).run(*command)
    assert result.code == 2
    assert "no robot project found" in result.first_error
    assert "--robot HOST" in result.stderr


@pytest.mark.parametrize("command", ROBOT_COMMANDS, ids=" ".join)
def test_a_project_that_is_named_has_to_be_there(command: list[str], make_project: MakeProject) -> None:
    result = make_project({}).run(*command, "--robot", "127.0.0.1", "--project", "elsewhere")
    assert (result.code, result.first_error) == (2, "there is no directory elsewhere")
