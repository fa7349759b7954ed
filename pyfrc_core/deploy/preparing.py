"""How a roboRIO is prepared for Python programs: one wording for `pyfrc deploy`, `pyfrc doctor` and docs/deploy.md.

Python, WPILib and the project's packages for the robot's processor are installed by the season's own tool, the command
`robotpy` of the package `robotpy`. It is not a dependency of pyfrc: a robot needs it once after it was imaged.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass

from ..season import CURRENT, SEASONS

#: The image that a virtual robot names: it is none, and needs none.
VIRTUAL_IMAGE = "virtual robot"

#: The commands, in their order; the second needs the internet, the third the robot.
COMMANDS = ("python -m pip install robotpy", "python -m robotpy sync", "python -m robotpy deploy")

_SECTION = 'docs/deploy.md, "A freshly imaged robot", has every step.'

_NEWEST_IMAGE = CURRENT.controller.images[-1]

IMAGE_IT = (
    f"Image it with the {CURRENT.controller.name} Imaging Tool of this season (image {_NEWEST_IMAGE}). {_SECTION}"
)

PREPARE = (
    f"Prepare the robot: {COMMANDS[0]}; with internet: {COMMANDS[1]}; then at the robot: {COMMANDS[2]}. {_SECTION}"
)

_REMOVE_OTHER_LANGUAGES = "To remove it: pyfrc undeploy --java-cpp"
_MOST_NAMED = 2  # files of other languages

#: How the robot gets what ``[tool.robotpy]`` in pyproject.toml asks for.
INSTALL_PACKAGES = f"with internet: {COMMANDS[1]}; then at the robot: {COMMANDS[2]}"

#: How a virtual robot gets a package; the package's name follows.
INSTALL_FOR_VIRTUAL_ROBOT = "in the environment in which pyfrc virtual-robot runs: python -m pip install"

_IMAGE_VERSION = re.compile(r"FRC_roboRIO2?_((20[0-9]{2})_v[0-9.]+)")


@dataclass(frozen=True)
class Obstacle:
    """Why a robot is not ready for a program.

    :param text:    what is wrong
    :param remedy:  what to do about it
    :param certain: whether no program could run; otherwise it might, and the user may try
    """

    text: str
    remedy: str
    certain: bool = True


def other_languages_notice(found: Sequence[str]) -> tuple[str, str]:
    """Return what Java or C++ costs on a robot, and how to remove it.

    :param found: files and directories of programs in these languages
    """
    named = ", ".join(found[:_MOST_NAMED])
    if len(found) > _MOST_NAMED:
        named += f" and {len(found) - _MOST_NAMED} more"
    return f"Java or C++ takes disk space and memory on the robot ({named})", _REMOVE_OTHER_LANGUAGES


def same_version_on_both(version: str) -> str:
    """Return how the robot gets the WPILib that this computer has.

    :param version: of `wpilib`, here
    """
    return (
        f'Have the same on both: robotpy_version = "{version}" under [tool.robotpy] in pyproject.toml; '
        f"{INSTALL_PACKAGES}."
    )


def image_problem(image: str | None, wpilib: str) -> str | None:
    """Return why a robot's image is not one that the season's tools accept.

    :param image:  as the robot gives it, ``FRC_roboRIO_2026_v1.2``; none: unknown
    :param wpilib: the version of `wpilib` on this computer
    :return: none, where it is accepted
    """
    if image == VIRTUAL_IMAGE:
        return None
    found = _IMAGE_VERSION.fullmatch(image or "")
    if found is None:
        return f"the robot's image is unknown ({image!r})"
    version, year = found.groups()
    if version in CURRENT.controller.images:
        return None
    season = wpilib.partition(".")[0]
    if year != season:
        return f"the robot's image is of {year} ({version}), wpilib {wpilib} needs that of {season}"
    return f"the robot's image is {version}, the season's is {_NEWEST_IMAGE}"


def python_problem(python: str, wpilib: str) -> str | None:
    """Return why a robot's Python is not the season's. A virtual robot has this computer's, which is fine, too.

    :param python: its version, ``3.14.0``
    :param wpilib: the version of `wpilib` on this computer
    :return: none, where it is the right one
    """
    season = SEASONS.get(int(wpilib.partition(".")[0]))
    if season is None:
        return None
    wanted = season.controller.python
    if python.split(".")[:2] in [[str(part) for part in each[:2]] for each in (wanted, sys.version_info)]:
        return None
    return f"the robot has Python {python}, but wpilib {wpilib} is for Python {'.'.join(map(str, wanted))} there"
