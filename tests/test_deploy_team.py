"""The team number and the robot's address: all sources, their order, and errors in values."""

from __future__ import annotations

import json
import re

import pytest

from pyfrc_core.deploy.targets import MAX_TEAM
from pyfrc_core.deploy.team import RobotTarget, find_target
from pyfrc_core.errors import PyfrcError, SettingsError, UsageError
from pyfrc_core.project import find_project

PREFERENCES = ".wpilib/wpilib_preferences.json"

#: From the first to count to the last.
PLACES = {
    "pyproject.toml": "[tool.pyfrc]\nteam = 1\n\n[tool.robotpy]\nteam_number = 3\n",
    PREFERENCES: '{"teamNumber": 2, "currentLanguage": "python"}',
}


def never(question: str) -> str:
    raise AssertionError(f"asked: {question}")


@pytest.fixture
def target_of(make_project):
    """The target of a project with these files."""

    def target_of(files: dict[str, str], **choice: object) -> RobotTarget:
        project = make_project({"robot.py": "", **files})
        return find_target(find_project(project.path), **choice)

    return target_of


@pytest.mark.parametrize("first", range(3))
def test_places_count_in_their_order(first: int, target_of) -> None:
    files = dict(PLACES)
    if first >= 1:
        files["pyproject.toml"] = "[tool.robotpy]\nteam_number = 3\n"
    if first >= 2:
        del files[PREFERENCES]
    assert target_of(files, ask=never).team == first + 1


def test_the_command_counts_most(target_of) -> None:
    target = target_of(PLACES, team=7, ask=never)
    assert (target.team, target.robot, target.project_team) == (7, None, None)


def test_a_robots_address_counts_most_of_all(target_of) -> None:
    target = target_of(PLACES, team=7, robot="10.0.0.2:2222")
    assert (target.team, target.robot, target.project_team) == (None, "10.0.0.2:2222", 1)


def test_preferences_may_name_the_robot(target_of) -> None:
    assert target_of({PREFERENCES: '{"robotHostname": "practice.local", "teamNumber": 9}'}).robot == "practice.local"


@pytest.mark.parametrize("none", [0, -1])
def test_an_editors_word_for_no_team_is_none(none: int, target_of) -> None:
    files = {PREFERENCES: json.dumps({"teamNumber": none}), "pyproject.toml": "[tool.robotpy]\nteam_number = 5\n"}
    assert target_of(files).team == 5


def test_the_user_is_asked_until_the_reply_is_valid_and_it_is_stored(make_project) -> None:
    project = make_project({"robot.py": "", PREFERENCES: '{"currentLanguage": "python"}'})
    replies = iter(["", "12a", "0", str(MAX_TEAM + 1), " 1234 "])
    questions = []

    def ask(question: str) -> str:
        questions.append(question)
        return next(replies)

    assert find_target(find_project(project.path), ask=ask).team == 1234
    assert len(questions) == 5
    assert "'12a'" in questions[2]
    assert json.loads((project.path / PREFERENCES).read_text()) == {"currentLanguage": "python", "teamNumber": 1234}
    assert find_target(find_project(project.path), ask=never).team == 1234


@pytest.mark.parametrize("host", ["10.12.34.2", "practice.local", "127.0.0.1:2222", "roboRIO-1234-FRC"])
def test_the_user_may_reply_with_an_address(host: str, make_project) -> None:
    """The season's tools ask for either, and store it under the same keys."""
    project = make_project({"robot.py": "", PREFERENCES: '{"currentLanguage": "python"}'})
    assert find_target(find_project(project.path), ask=lambda question: host).robot == host
    stored = json.loads((project.path / PREFERENCES).read_text())
    assert stored == {"currentLanguage": "python", "robotHostname": host}
    assert find_target(find_project(project.path), ask=never).robot == host


def test_without_a_terminal_the_error_names_the_setting(target_of) -> None:
    with pytest.raises(UsageError, match=r"--team NUMBER.*\[tool\.pyfrc\].*--robot HOST"):
        target_of({})


@pytest.mark.parametrize(
    ("name", "text", "where", "what"),
    [
        ("pyproject.toml", "[tool.pyfrc]\nteam = 0\n", "pyproject.toml", "[tool.pyfrc] team"),
        ("pyproject.toml", '[tool.pyfrc]\nteam = "12"\n', "pyproject.toml:2", "tool.pyfrc.team"),
        ("pyproject.toml", "[tool.robotpy]\n\nteam_number = 99999\n", "pyproject.toml:3", "team_number = 99999"),
        ("pyproject.toml", '[tool.robotpy]\nteam_number = "no"\n', "pyproject.toml:2", "team_number = 'no'"),
        (PREFERENCES, '{"teamNumber": 1.5}', PREFERENCES, "teamNumber = 1.5"),
        (PREFERENCES, '{"teamNumber": true}', PREFERENCES, "teamNumber = True"),
        (PREFERENCES, '{"robotHostname": 7}', PREFERENCES, "robotHostname = 7"),
        (PREFERENCES, "{", PREFERENCES, "not valid JSON"),
        (PREFERENCES, "[]", PREFERENCES, "an object"),
    ],
)
def test_an_invalid_value_is_reported_with_its_file_and_key(
    name: str, text: str, where: str, what: str, target_of
) -> None:
    with pytest.raises(SettingsError) as caught:
        target_of({name: text}, ask=never)
    assert str(caught.value).startswith(where)
    assert what in str(caught.value)


def test_preferences_that_cannot_be_read_are_not_overwritten(make_project) -> None:
    project = make_project({"robot.py": "", PREFERENCES: "{ mine"})
    with pytest.raises(PyfrcError):
        find_target(find_project(project.path), ask=lambda question: "12")
    assert (project.path / PREFERENCES).read_text() == "{ mine"


def test_the_range_in_the_messages_is_that_of_the_addresses(target_of) -> None:
    with pytest.raises(SettingsError) as caught:
        target_of({}, team=MAX_TEAM + 1)
    assert re.search(rf"--team: {MAX_TEAM + 1}: a team number is from 1 to {MAX_TEAM}", str(caught.value))
