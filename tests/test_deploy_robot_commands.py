"""Commands in messages are about the same robot as the user's command."""

from __future__ import annotations

import json

import click
import pytest
from click.testing import CliRunner
from conftest import MakeProject
from loops import for_each

from pyfrc_cli.robot_options import errors_shown, json_option, robot_options, user_interface
from pyfrc_core.deploy import recovery_hints, session, starting
from pyfrc_core.deploy.facts import StartState
from pyfrc_core.deploy.progress import with_robot_option
from pyfrc_core.deploy.team import RobotChoice
from pyfrc_core.errors import PyfrcError

REMEDY = "Deploy again: pyfrc deploy. To see what it has: pyfrc deploy-info. Or: pyfrc deploy --rollback 3."


@click.command()
@robot_options
@json_option
def failing(choice: RobotChoice, as_json: bool) -> None:
    with errors_shown(choice, as_json):
        progress = user_interface(choice, as_json).progress
        progress.note("see pyfrc console")
        progress.warning("see pyfrc console")
        raise PyfrcError("it fails", remedy=REMEDY)


@for_each(
    "typed, robot",
    [
        (["--robot", "127.0.0.1:2222"], " --robot 127.0.0.1:2222"),
        (["--team", "1234"], " --team 1234"),
        ([], ""),
    ],
)
def test_remedies_name_the_robot_as_it_was_typed(typed: list[str], robot: str) -> None:
    expected = (
        f"Deploy again: pyfrc deploy{robot}. To see what it has: pyfrc deploy-info{robot}. "
        f"Or: pyfrc deploy{robot} --rollback 3."
    )
    result = CliRunner().invoke(failing, [*typed, "--json"])
    assert isinstance(result.exception, PyfrcError)
    assert str(result.exception) == f"it fails\n  {expected}"
    note, warning, error = map(json.loads, result.stdout.splitlines())
    assert error["remedy"] == expected
    assert [each["event"] for each in (note, warning, error)] == ["note", "warning", "error"]
    assert note["text"] == warning["text"] == f"see pyfrc console{robot}"


@for_each(
    "remedy",
    [
        recovery_hints.SWITCHING.remedy,
        recovery_hints.rolling_back(1).remedy,
        recovery_hints.rolling_back(None).remedy,
        recovery_hints.UNDEPLOYING.remedy,
        recovery_hints.deployed(2, 1).remedy,
        recovery_hints.rolled_back(1).remedy,
        recovery_hints.started(2, 1, StartState(seconds=1.0, seen=True)).remedy,
        starting._GO_BACK,
    ],
)
def test_each_command_of_a_deploy_s_own_remedies_is_found(remedy: str) -> None:
    commands = remedy.count("pyfrc ")
    assert commands > 0
    assert with_robot_option(remedy, None, 1234).count(" --team 1234") == commands


def test_a_command_that_names_a_robot_already_stays_as_it_is() -> None:
    text = "Try it without a robot: pyfrc virtual-robot -- pyfrc deploy --robot"
    assert with_robot_option(text, "10.12.34.2", None) == text


def test_an_address_is_quoted_for_the_shell() -> None:
    assert with_robot_option("pyfrc console", "a;b", None) == "pyfrc console --robot 'a;b'"


def test_a_deploy_may_end_in_the_console(make_project: MakeProject, monkeypatch: pytest.MonkeyPatch) -> None:
    project = make_project({"robot.py": ""})
    shown: list[bool] = []
    monkeypatch.setattr(session, "deploy", lambda *asked: None)
    monkeypatch.setattr(session, "show_console", lambda project, choice, talk, nc_ds, address: shown.append(nc_ds))
    for options, expected in (([], []), (["--nc"], [False]), (["--netconsole"], [False]), (["--nc-ds"], [True])):
        shown.clear()
        assert project.run_here("deploy", *options).code == 0
        assert shown == expected, options


#: An address is enough for these outside of a project.
ROBOT_COMMANDS = [["deploy-info"], ["logs"], ["console"], ["undeploy", "--yes"], ["deploy", "--rollback"]]


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
