"""Create robot projects from templates: the files that all have in common (`base`), and those of one template.

A file in `templates/YEAR/NAME` replaces that of `templates/NAME` in the season of that year, or is one more.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from string import Template as Text
from typing import TYPE_CHECKING

from ._version import requirement
from .errors import UsageError
from .season import CURRENT
from .text_files import write_whole

if TYPE_CHECKING:
    from .project import Project


@dataclass(frozen=True)
class Template:
    """A kind of robot project.

    :param description: one line for the list of templates
    :param packages: requirements of its code besides wpilib and its motor controllers
    :param extras: the extras of robotpy that install these packages on the robot
    :param opmodes: whether its robot has opmodes, which not every season's robots can have
    """

    description: str
    packages: tuple[str, ...] = ()
    extras: tuple[str, ...] = ()
    opmodes: bool = False

    @property
    def missing(self) -> list[str]:
        """The requirements of its code that are not installed here."""
        return [package for package in (*CURRENT.packages.drivers, *self.packages) if not _is_installed(package)]


_TEMPLATES = {
    "tank": Template("tank drive: four motors, two joysticks, encoders"),
    "timed": Template("the smallest robot that drives; the rest is yours"),
    "mecanum": Template("mecanum drive: moves sideways, steered as seen from the field"),
    "swerve": Template("swerve drive: four wheels that turn, and odometry"),
    "command": Template(
        "command-based: subsystems, commands, an autonomous chooser",
        packages=(CURRENT.packages.commands,),
        extras=("commands2",),
    ),
    "magic": Template(
        "MagicRobot: components, and state machines for shooting and autonomous",
        packages=(CURRENT.packages.utilities,),
    ),
    "elevator-arm": Template("an elevator with an arm on it, driven to heights and angles"),
    "opmode": Template("opmodes: one class for each thing that the robot can do in a match", opmodes=True),
}
#: The templates of the installed season, by name.
TEMPLATES = {name: each for name, each in _TEMPLATES.items() if CURRENT.opmodes or not each.opmodes}
DEFAULT = "tank"

#: The directory of the files that every project has.
_BASE = "base"

#: The path of the test module that `pyfrc add-tests` adds to a project.
READY_MADE_TESTS = PurePosixPath("tests/pyfrc_test.py")

#: Files that would take effect in this repository under their own name: name here to name in the project.
_RENAMED = {"gitignore": ".gitignore", "github": ".github", "vscode": ".vscode"}

#: The suffix of files whose ``$names`` are substituted.
_FILLED_IN = ".template"

_LEFT_OUT = {"__pycache__", ".pytest_cache", ".mypy_cache", ".ruff_cache"}

_NOT_ON_WINDOWS = re.compile(r'[<>:"|?*\\\x00-\x1f]|[. ]$|^(con|prn|aux|nul|com[1-9]|lpt[1-9])(\..*)?$', re.IGNORECASE)


def create_project(
    directory: Path,
    installed: Path,
    template: str = DEFAULT,
    team: int | None = None,
    confirm: Callable[[Path, list[str]], None] | None = None,
) -> list[PurePosixPath]:
    """Create a project from a template and return the files written, relative to `directory`.

    :param installed: the package that contains the templates when it is installed
    :param confirm: called with the directory and what is in it before anything is written, if that is more than hidden
        files and virtual environments; raises an exception to write nothing
    :raises UsageError: when a file exists already, or the directory's name or the team number is invalid; nothing is
        written then
    """
    _check_name(directory)
    texts = _texts(templates_directory(installed), template, team)
    if directory.exists() and not directory.is_dir():
        raise UsageError(f"{directory} is a file, not a directory")
    taken = sorted({str(place) for target in texts if (place := _taken(directory, target)) is not None})
    if taken:
        raise UsageError(
            f"nothing was written: {', '.join(taken)} exist{'s' if len(taken) == 1 else ''} already",
            where=directory,
            remedy="Name a new directory, as in: pyfrc init my-robot",
        )
    others = sorted(each.name for each in directory.iterdir() if _is_other(each)) if directory.exists() else []
    if others and confirm is not None:
        confirm(directory, others)
    for target, text in texts.items():
        write_whole(directory / target, text)
    return list(texts)


def add_tests(project: Project, installed: Path) -> tuple[Path, bool]:
    """Write the ready-made tests into the project's directory of tests.

    :returns: the file, and whether it was written: False if it existed already
    :raises UsageError: when a file is in place of the directory
    """
    directory = next((each for each in project.test_directories if each.is_dir()), project.test_directories[0])
    file = directory / READY_MADE_TESTS.name
    if os.path.lexists(directory) and not directory.is_dir():
        raise UsageError(f"{directory.name} is a file, where the directory of the tests has to be")
    if os.path.lexists(file):
        return file, False
    write_whole(file, (templates_directory(installed) / _BASE / READY_MADE_TESTS).read_text("utf-8"))
    return file, True


def templates_directory(installed: Path) -> Path:
    """Return the directory of the templates: in the installed package, or in the checkout when pyfrc runs from one.

    :param installed: the package that contains them when it is installed
    """
    inside, beside = installed / "templates", installed.parent / "templates"
    return inside if inside.is_dir() else beside


def _texts(templates: Path, name: str, team: int | None) -> dict[PurePosixPath, str]:
    """Return the project's files and their contents."""
    from .config.sim import sim_config_schema

    values = _values(TEMPLATES[name], team)
    texts = {PurePosixPath("sim/config.schema.json"): sim_config_schema() + "\n"}
    for source in (templates / _BASE, templates / name, templates / str(CURRENT.year) / name):
        for file in sorted(source.rglob("*")):
            if file.is_file() and not _LEFT_OUT.intersection(file.parts):
                target = PurePosixPath(*(_RENAMED.get(part, part) for part in file.relative_to(source).parts))
                text = file.read_text("utf-8")
                if target.suffix == _FILLED_IN:
                    target, text = target.with_suffix(""), Text(text).substitute(values)
                texts[target] = text
    return dict(sorted(texts.items()))


def _values(template: Template, team: int | None) -> Mapping[str, str]:
    """Return the values of the ``$names`` in the base's files."""
    if team is None:
        number = "# team_number = 9999  # your team's, for: pyfrc deploy"
    else:
        from .deploy.targets import MAX_TEAM

        if not 1 <= team <= MAX_TEAM:
            raise UsageError(f"{team} is no team number: one is from 1 to {MAX_TEAM}", where="--team")
        number = f"team_number = {team}"
    needed = (*CURRENT.packages.drivers, *template.packages)
    by_extras = template.packages if template.extras else ()
    return {
        "components": _toml_array(template.extras),
        "requires": _toml_array([package for package in needed if package not in by_extras]),
        "packages": "\n".join((requirement(), CURRENT.requirement, *needed)),
        "team_number": number,
        "robotpy_version": f'"{CURRENT.packages.wpilib}"',
    }


def _toml_array(texts: tuple[str, ...] | list[str]) -> str:
    return "[" + ", ".join(f'"{text}"' for text in texts) + "]"


def _check_name(directory: Path) -> None:
    """:raises UsageError: when the directory is to be created and some operating system does not allow its name"""
    if directory.exists():
        return
    name = directory.name
    if name.startswith("-") or _NOT_ON_WINDOWS.search(name):
        raise UsageError(
            f"{name!r} is no name for a directory on every computer",
            remedy='Leave out < > : " | ? * \\ and what Windows keeps for itself; do not begin it with -, '
            "nor end it with a dot or a space.",
        )


def _is_other(file: Path) -> bool:
    """Return whether a file or directory has nothing to do with setting up a project."""
    return not (file.name.startswith(".") or (file / "pyvenv.cfg").is_file())


def _taken(directory: Path, target: PurePosixPath) -> PurePosixPath | None:
    """Return the path that prevents writing a file: the file itself, or a file in place of one of its directories."""
    for place in reversed(target.parents[:-1]):
        if os.path.lexists(directory / place) and not (directory / place).is_dir():
            return place
    return target if os.path.lexists(directory / target) else None


def _is_installed(requirement: str) -> bool:
    from importlib.metadata import PackageNotFoundError, version

    try:
        version(re.split(r"[~<>=!]", requirement)[0])
    except PackageNotFoundError:
        return False
    return True
