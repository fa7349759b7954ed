"""Instructions for preparing a robot, shared by `pyfrc deploy`, `pyfrc doctor` and docs/deploy.md.

The `robotpy` command of the package `robotpy` installs Python, WPILib and the project's packages on the robot. It is
not a dependency of pyfrc, since it is needed only once after imaging.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass

from ..season import CURRENT, SEASONS
from .facts import VIRTUAL_IMAGE
from .targets import Controller

#: The commands in order. The second needs the internet, the third the robot.
COMMANDS = ("python -m pip install robotpy", "python -m robotpy sync", "python -m robotpy deploy")

_SECTION = 'docs/deploy.md, "A freshly imaged robot", has every step.'

PREPARE = (
    f"Prepare the robot: {COMMANDS[0]}; with internet: {COMMANDS[1]}; then at the robot: {COMMANDS[2]}. {_SECTION}"
)

_REMOVE_OTHER_LANGUAGES = "To remove it: pyfrc undeploy --java-cpp"
_MAX_NAMED = 2  # files of other languages

#: How to install the packages in ``[tool.robotpy]`` on the robot.
INSTALL_PACKAGES = f"with internet: {COMMANDS[1]}; then at the robot: {COMMANDS[2]}"

#: How to install a package for a virtual robot, without the package's name.
INSTALL_FOR_VIRTUAL_ROBOT = "in the environment in which pyfrc virtual-robot runs: python -m pip install"


@dataclass(frozen=True)
class Obstacle:
    """A reason why a robot is not ready for a program.

    :param text:    the problem
    :param remedy:  how to solve it
    :param certain: whether programs cannot run at all; otherwise they might run
    """

    text: str
    remedy: str
    certain: bool = True


def other_languages_notice(found: Sequence[str]) -> tuple[str, str]:
    """Return a notice about programs in Java and C++ on a robot, and how to remove them.

    :param found: their files and directories
    """
    named = ", ".join(found[:_MAX_NAMED])
    if len(found) > _MAX_NAMED:
        named += f" and {len(found) - _MAX_NAMED} more"
    return f"Java or C++ takes disk space and memory on the robot ({named})", _REMOVE_OTHER_LANGUAGES


def same_version_on_both(version: str) -> str:
    """Return how to install this computer's version of WPILib on the robot.

    :param version: the version of `wpilib` on this computer
    """
    return (
        f'Use the same version on both: robotpy_version = "{version}" under [tool.robotpy] in pyproject.toml; '
        f"{INSTALL_PACKAGES}."
    )


def image_it(controller: Controller) -> str:
    """Return how to install the season's image on a robot."""
    return f"{controller.image_it} (image {CURRENT.controller.images[-1]}). {_SECTION}"


def image_problem(image: str | None, wpilib: str, controller: Controller) -> str | None:
    """Return why the season's tools do not accept a robot's image, or None if they accept it.

    :param image:  the robot's image; None if unknown
    :param wpilib: the version of `wpilib` on this computer
    """
    if image == VIRTUAL_IMAGE:
        return None
    return controller.image_problem(image, wpilib, CURRENT.controller.images)


def python_problem(python: str, wpilib: str) -> str | None:
    """Return why a robot's Python is not the season's version, or None if it is.

    This computer's version is accepted as well, for virtual robots.

    :param python: its version, such as ``3.14.0``
    :param wpilib: the version of `wpilib` on this computer
    """
    season = SEASONS.get(int(wpilib.partition(".")[0]))
    if season is None:
        return None
    wanted = season.controller.python
    if python.split(".")[:2] in [[str(part) for part in each[:2]] for each in (wanted, sys.version_info)]:
        return None
    return f"the robot has Python {python}, but wpilib {wpilib} is for Python {'.'.join(map(str, wanted))} there"
