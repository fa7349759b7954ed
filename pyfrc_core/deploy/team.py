"""Whose robot it is: the team's number, or the robot's own address, from wherever a project says it."""

from __future__ import annotations

import configparser
import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..config.toml_file import TomlFile
from ..errors import SettingsError, UsageError
from ..project import Project
from ..text_files import write_whole
from .discovery import MOST_TEAM

PREFERENCES = Path(".wpilib", "wpilib_preferences.json")
_OLD_FILE = ".deploy_cfg"
_RANGE = f"a team number is from 1 to {MOST_TEAM}"


@dataclass(frozen=True)
class Target:
    """Which robot is meant: one of a team, or one with an address (``HOST`` or ``HOST:PORT``)."""

    team: int | None = None
    robot: str | None = None
    #: Where that was said.
    source: str = "the command"


def find_target(
    project: Project | None,
    *,
    robot: str | None = None,
    team: int | None = None,
    ask: Callable[[str], str] | None = None,
) -> Target:
    """Which robot is meant, by what the command says, else the project's files, else the user.

    :param project: may be none where the command says it
    :param ask: asks the user a question; its answer is kept in ``.wpilib/wpilib_preferences.json``
    :raises UsageError: when nobody says it, or with the file and the key of a value that is no team number
    """
    if robot is not None:
        return Target(robot=robot)
    if team is not None:
        return Target(_in_range(team, "--team"))
    if project is None:
        raise UsageError("whose robot?", remedy="Name it with --team NUMBER or --robot HOST.")
    for found in _said_in_files(project):
        return found
    if ask is None:
        raise UsageError(
            "whose robot? No team number is known for this project",
            remedy="Give it with --team NUMBER, or once and for all as team = NUMBER under [tool.pyfrc] in "
            "pyproject.toml; or name the robot with --robot HOST.",
        )
    number = _asked(ask)
    file = _preferences_file(project)
    save_team(file, number)
    return Target(number, source=PREFERENCES.as_posix())


def team_of_project(project: Project) -> int | None:
    """Return the team that the project's files name, also beside a robot's own address; none: no team.

    :raises UsageError: with the file and the key of a value that is no team number
    """
    return next((found.team for found in _said_in_files(project) if found.team is not None), None)


def save_team(file: Path, team: int) -> None:
    """Write the team's number into a ``wpilib_preferences.json``, whose other keys stay."""
    preferences = _read_preferences(file)
    write_whole(file, [json.dumps(preferences | {"teamNumber": team}, indent=2), "\n"])


def _asked(ask: Callable[[str], str]) -> int:
    question = "What is your team number?"
    while True:
        answer = ask(question).strip()
        if re.fullmatch(r"[0-9]{1,5}", answer) and 1 <= int(answer) <= MOST_TEAM:
            return int(answer)
        question = f"{answer!r} is no team number: {_RANGE}. What is yours?"


def _said_in_files(project: Project) -> Iterator[Target]:
    """What the project's files say, the first one to count first."""
    if (team := project.settings.team) is not None:
        where = f"{project.pyproject.name}: [tool.pyfrc] team"
        yield Target(_in_range(team, where), source=where)
    yield from _said_in_preferences(_preferences_file(project))
    yield from _said_to_robotpy(project.pyproject)
    yield from _said_in_old_file(project.root / _OLD_FILE)


def _preferences_file(project: Project) -> Path:
    """Beside the code, where it is there already; else beside pyproject.toml, which is the project's top."""
    beside = project.root / PREFERENCES
    return beside if beside.exists() else project.pyproject.parent / PREFERENCES


def _read_preferences(file: Path) -> dict[str, Any]:
    if not file.is_file():
        return {}
    try:
        preferences = json.loads(file.read_text("utf-8-sig"))
    except ValueError as malformed:
        raise SettingsError(
            f"not valid JSON: {malformed}",
            where=PREFERENCES.as_posix(),
            remedy="Correct it, or remove it and be asked anew.",
        ) from None
    if not isinstance(preferences, dict):
        raise SettingsError("this should be an object, in {}", where=PREFERENCES.as_posix())
    return preferences


def _said_in_preferences(file: Path) -> Iterator[Target]:
    preferences = _read_preferences(file)
    name = PREFERENCES.as_posix()
    if (host := preferences.get("robotHostname")) not in (None, ""):
        if not isinstance(host, str):
            raise SettingsError(f"robotHostname = {host!r}: this should be a text", where=name)
        yield Target(robot=host, source=f"{name}: robotHostname")
    # The editor's own tools write -1 or 0 where there is none.
    if (team := preferences.get("teamNumber")) not in (None, 0, -1):
        yield Target(_number(team, name, "teamNumber"), source=f"{name}: teamNumber")


def _said_to_robotpy(pyproject: Path) -> Iterator[Target]:
    if not pyproject.is_file():
        return
    file = TomlFile(pyproject)
    team = (file.table_at("tool", "robotpy") or {}).get("team_number")
    if team is not None:
        where = file.place_of("tool", "robotpy", "team_number")
        yield Target(_number(team, where, "team_number"), source=f"{pyproject.name}: [tool.robotpy] team_number")


def _said_in_old_file(file: Path) -> Iterator[Target]:
    if not file.is_file():
        return
    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read_string(file.read_text("utf-8-sig"))
    except (configparser.Error, UnicodeDecodeError) as malformed:
        what = " ".join(str(malformed).split())
        raise SettingsError(f"not a valid file of its kind: {what}", where=_OLD_FILE) from None
    host = parser.get("auth", "hostname", fallback="").strip()
    source = f"{_OLD_FILE}: hostname"
    if re.fullmatch(r"[0-9]+", host):
        yield Target(_number(int(host), _OLD_FILE, "hostname"), source=source)
    elif named := re.fullmatch(r"roborio-([0-9]{1,5})-frc(\..*)?", host, re.IGNORECASE):
        yield Target(_number(int(named[1]), _OLD_FILE, "hostname"), source=source)
    elif host:
        yield Target(robot=host, source=source)


def _number(value: object, where: str, key: str) -> int:
    if isinstance(value, str) and re.fullmatch(r"[0-9]{1,5}", value):
        value = int(value)
    if not isinstance(value, int) or isinstance(value, bool):
        raise SettingsError(f"{key} = {value!r}: {_RANGE}", where=where)
    return _in_range(value, where, key)


def _in_range(team: int, where: str, key: str | None = None) -> int:
    if not 1 <= team <= MOST_TEAM:
        raise SettingsError(f"{key} = {team}: {_RANGE}" if key else f"{team}: {_RANGE}", where=where)
    return team
