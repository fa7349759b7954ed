"""The robot to connect to: a team number or an address, from the options or the project's files."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ..config.toml_file import TomlFile
from ..errors import SettingsError, UsageError
from ..project import Project
from ..season import CURRENT
from ..text_files import write_whole
from .discovery import parse_address
from .login import NONE_OFFERED, Credentials
from .progress import Questions
from .targets import MAX_TEAM, ControllerKind, controller_of, team_of_host

PREFERENCES = Path(".wpilib", "wpilib_preferences.json")
_RANGE = f"a team number is from 1 to {MAX_TEAM}"


@dataclass(frozen=True)
class RobotTarget:
    """The robot to connect to: a team's robot, or one with an address (``HOST`` or ``HOST:PORT``)."""

    team: int | None = None
    robot: str | None = None
    #: Where it was specified.
    source: str = "the command"
    #: The kind of computer on it.
    controller: ControllerKind = field(default_factory=lambda: controller_of(CURRENT))
    #: The project's directory, where its host keys are pinned; None outside of a project.
    keys_in: Path | None = None
    #: The project's team, if the robot was specified by its address.
    project_team: int | None = None


@dataclass(frozen=True)
class RobotChoice:
    """The robot options of a command.

    :param robot: the robot's address, as ``HOST`` or ``HOST:PORT``
    :param team: a team number
    :param resolve: whether host names may be resolved
    :param accepted_key: the fingerprint of a changed host key that the user accepts
    :param robot_name: a name to store with the robot's key
    :param credentials: the user's password, for a robot that requires one
    """

    robot: str | None = None
    team: int | None = None
    resolve: bool = True
    accepted_key: str | None = None
    robot_name: str | None = None
    credentials: Credentials = NONE_OFFERED

    @property
    def names_robot(self) -> bool:
        """Return whether the options select a robot without a project."""
        return self.robot is not None or self.team is not None


def choose_target(project: Project | None, choice: RobotChoice, ask: Questions | None) -> RobotTarget:
    """Return the robot to connect to. Ask the user if neither the options nor the project name one.

    :param project: None outside of a project, if the options name a robot
    :param ask: None if the user cannot be asked
    :raises UsageError: if no robot is named and the user cannot be asked, or a team number is invalid
    """
    target = find_target(project, robot=choice.robot, team=choice.team, ask=ask.text if ask else None)
    if target.robot is not None and parse_address(target.robot).is_name and not choice.resolve:
        raise UsageError(
            f"{target.robot} is a host name, which --no-resolve does not resolve",
            remedy="Leave out --no-resolve, or give the robot's address with --robot, as in 10.12.34.2",
        )
    return target


def find_target(
    project: Project | None,
    *,
    robot: str | None = None,
    team: int | None = None,
    ask: Callable[[str], str] | None = None,
) -> RobotTarget:
    """Return the robot that the options specify, else the project's files, else the user.

    :param project: may be None if the options specify the robot
    :param ask: asks the user a question; the reply is stored in ``.wpilib/wpilib_preferences.json``
    :raises UsageError: if no robot is specified, or a team number is invalid
    """
    target = _find_target(project, robot, team, ask)
    if project is None:
        return target
    project_team = None
    if target.team is None:
        project_team = next((found.team for found in _targets_in_files(project) if found.team is not None), None)
    return replace(target, keys_in=project.pyproject.parent, project_team=project_team)


def _find_target(
    project: Project | None, robot: str | None, team: int | None, ask: Callable[[str], str] | None
) -> RobotTarget:
    if robot is not None:
        return RobotTarget(robot=robot)
    if team is not None:
        return RobotTarget(_in_range(team, "--team"))
    if project is None:
        raise UsageError("no robot is specified", remedy="Specify it with --team NUMBER or --robot HOST.")
    if (found := next(_targets_in_files(project), None)) is not None:
        return found
    if ask is None:
        raise UsageError(
            "no robot is specified: this project has no team number",
            remedy="Specify it with --team NUMBER, or permanently with team = NUMBER under [tool.pyfrc] in "
            "pyproject.toml; or give the robot's address with --robot HOST.",
        )
    target = _asked(ask)
    file = _preferences_file(project)
    named = {"teamNumber": target.team} if target.robot is None else {"robotHostname": target.robot}
    write_whole(file, [json.dumps(_read_preferences(file) | named, indent=2), "\n"])
    return target


def _asked(ask: Callable[[str], str]) -> RobotTarget:
    """Return the user's team, or the robot if the user enters an address: the season's tools take both there."""
    question = "What is your team number?"
    while True:
        text = ask(question).strip()
        if re.fullmatch(r"[0-9]{1,5}", text) and 1 <= int(text) <= MAX_TEAM:
            return RobotTarget(int(text), source=PREFERENCES.as_posix())
        if team_of_host(text) is not None or "." in text or ":" in text:
            with suppress(UsageError):
                return RobotTarget(robot=str(parse_address(text)), source=PREFERENCES.as_posix())
        question = f"{text!r} is not a team number: {_RANGE}. What is your team number?"


def _targets_in_files(project: Project) -> Iterator[RobotTarget]:
    """Yield the robots that the project's files specify, in order of priority."""
    if (team := project.settings.team) is not None:
        where = f"{project.pyproject.name}: [tool.pyfrc] team"
        yield RobotTarget(_in_range(team, where), source=where)
    yield from _targets_in_preferences(_preferences_file(project))
    yield from _targets_in_robotpy(project.pyproject)


def _preferences_file(project: Project) -> Path:
    """Return the existing file beside the code, else the path beside pyproject.toml."""
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
            remedy="Correct it, or remove it to be asked again.",
        ) from None
    if not isinstance(preferences, dict):
        raise SettingsError("this should be an object, in {}", where=PREFERENCES.as_posix())
    return preferences


def _targets_in_preferences(file: Path) -> Iterator[RobotTarget]:
    preferences = _read_preferences(file)
    name = PREFERENCES.as_posix()
    if (host := preferences.get("robotHostname")) not in (None, ""):
        if not isinstance(host, str):
            raise SettingsError(f"robotHostname = {host!r}: this should be a text", where=name)
        yield RobotTarget(robot=host, source=f"{name}: robotHostname")
    # The editor's tools write -1 or 0 if there is not a team number.
    if (team := preferences.get("teamNumber")) not in (None, 0, -1):
        yield RobotTarget(_number(team, name, "teamNumber"), source=f"{name}: teamNumber")


def _targets_in_robotpy(pyproject: Path) -> Iterator[RobotTarget]:
    if not pyproject.is_file():
        return
    file = TomlFile(pyproject)
    team = (file.table_at("tool", "robotpy") or {}).get("team_number")
    if team is not None:
        where = file.place_of("tool", "robotpy", "team_number")
        yield RobotTarget(_number(team, where, "team_number"), source=f"{pyproject.name}: [tool.robotpy] team_number")


def _number(value: object, where: str, key: str) -> int:
    if isinstance(value, str) and re.fullmatch(r"[0-9]{1,5}", value):
        value = int(value)
    if not isinstance(value, int) or isinstance(value, bool):
        raise SettingsError(f"{key} = {value!r}: {_RANGE}", where=where)
    return _in_range(value, where, key)


def _in_range(team: int, where: str, key: str | None = None) -> int:
    if not 1 <= team <= MAX_TEAM:
        raise SettingsError(f"{key} = {team}: {_RANGE}" if key else f"{team}: {_RANGE}", where=where)
    return team
