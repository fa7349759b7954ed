"""Commands outside of a project: an address is enough to inspect a robot, show its console, and roll back."""

from __future__ import annotations

from conftest import MakeProject
from ports import address_without_servers
from test_deploy_console import running, wait_for

ROBOT_COMMANDS = [["deploy-info"], ["logs"], ["console"], ["undeploy", "--yes"], ["deploy", "--rollback"]]


def test_the_console_goes_from_anywhere(make_project: MakeProject) -> None:
    host = address_without_servers()
    with running(make_project({}), "console", "--robot", host) as console:
        wait_for(console, f"{host}:1741 refuses the connection")
    assert console.wait() == 130


def test_where_no_robot_is_named_a_project_is_asked_for_and_one_that_is_named_has_to_be_there(
    make_project: MakeProject,
) -> None:
    project = make_project({})
    for command in ROBOT_COMMANDS:
        result = project.run_here(*command)
        assert result.code == 2, command
        assert "no robot project found" in result.first_error
        assert "--robot HOST" in result.stderr
        result = project.run_here(*command, "--robot", "127.0.0.1", "--project", "elsewhere")
        assert (result.code, result.first_error) == (2, "there is no directory elsewhere"), command
