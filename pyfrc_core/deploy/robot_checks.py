"""Checks whether the robot is ready for a Python program, with a remedy for each problem.

`pyfrc deploy`, `pyfrc doctor` and docs/how_to/prepare_a_robot.md share the instructions for preparing a robot.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from .._version import requirement
from ..season import CURRENT, SEASONS
from ..terminal_text import one_line
from .agent.layout import Layout
from .connection import Connection
from .errors import ConnectionFailedError, NoPythonError, RefusedError
from .facts import VIRTUAL_IMAGE, RobotFacts
from .progress import DeployProgress
from .targets import AdministratorTask, ControllerKind

NO_CHECK = "To deploy without this check: --no-version-check."


def refuse_unfit_robot(facts: RobotFacts, controller: ControllerKind, where: str, check_versions: bool) -> None:
    """Check whether the program can run on the robot.

    :param check_versions: also refuse a robot where the program might fail
    :raises RefusedError: if it cannot
    """
    for each in obstacles(facts, controller):
        if each.certain:
            raise RefusedError(each.text, where=where, remedy=each.remedy)
        if check_versions:
            raise RefusedError(each.text, where=where, remedy=f"{each.remedy} {NO_CHECK}")


def refuse_installation(connection: Connection, facts: RobotFacts | None) -> None:
    """Check whether anything but Python and packages is missing on a robot, before these are installed.

    :param facts: None: it has no Python
    :raises RefusedError: if something is
    """
    found = RobotWithoutPython(connection).obstacles() if facts is None else obstacles(facts, connection.controller)
    for each in found:
        if not each.installable:
            remedy = each.remedy if each.certain else f"{each.remedy} {NO_CHECK}"
            raise RefusedError(each.text, where=str(connection.address), remedy=remedy)


def obstacles(facts: RobotFacts, controller: ControllerKind) -> Iterator[Obstacle]:
    """Yield the reasons why a robot is not ready, most important first.

    :raises RefusedError: if `wpilib` is not installed on this computer
    """
    image = image_it(controller)
    if facts.not_controller is not None:
        remedy = f"Check the address, or name the robot with --robot HOST. For a new {controller.name}: {image}"
        yield Obstacle(f"this is not a {controller.name}: {facts.not_controller}", remedy)
        return
    ours = _our_wpilib()
    prepare, same_version = PREPARE, same_version_on_both(ours)
    if facts.image == VIRTUAL_IMAGE:  # nothing is installed on it
        prepare = same_version = f"Start the virtual robot with wpilib {ours}, as here: pyfrc virtual-robot."
    if facts.wpilib is None:
        yield Obstacle("there is no wpilib for Python on the robot", prepare, installable=True)
    wrong_python = python_problem(facts.python, ours)
    if wrong_python is not None:
        # The system's Python is not replaced: the program that is there needs it.
        stays = controller.install_python.is_system and facts.image != VIRTUAL_IMAGE
        yield Obstacle(wrong_python, image if stays else prepare, certain=False, installable=not stays)
    if facts.wpilib not in (None, ours):
        text = f"the robot has wpilib {facts.wpilib}, this computer has {ours}: what passes here may fail there"
        yield Obstacle(text, same_version, certain=False, installable=True)
    wrong_image = image_problem(facts.image, ours, controller)
    if wrong_image is not None:
        yield Obstacle(wrong_image, image, certain=False)


def carry_out(task: AdministratorTask | None, connection: Connection, progress: DeployProgress) -> None:
    """Have the administrator carry out a task, over a second connection. A failure only causes a warning.

    :param task: None: nothing to do
    """
    if task is None:
        return
    if (problem := connection.administer(task)) is None:
        progress.note(f"  {task.done}")
    else:
        progress.warning(f"{task.failed}: {problem}")


def _our_wpilib() -> str:
    try:
        return version("wpilib")
    except PackageNotFoundError:  # a dependency of pyfrc, so it was uninstalled
        raise RefusedError(
            "there is no wpilib on this computer", remedy=f'Install it: pip install --force-reinstall "{requirement()}"'
        ) from None


_SECTION = "docs/how_to/prepare_a_robot.md has every step."

#: How to install the packages in ``[tool.robotpy]`` on the robot, and how to prepare it.
INSTALL_PACKAGES = "with internet: pyfrc sync; then at the robot: pyfrc deploy"
PREPARE = f"Prepare the robot: {INSTALL_PACKAGES}. {_SECTION}"

_MAX_NAMED = 2  # files

#: How to install a package for a virtual robot, without the package's name.
INSTALL_FOR_VIRTUAL_ROBOT = "in the environment in which pyfrc virtual-robot runs: python -m pip install"


@dataclass(frozen=True)
class Obstacle:
    """A reason why a robot is not ready for a program.

    :param text:    the problem
    :param remedy:  how to solve it
    :param certain: whether programs cannot run at all; otherwise they might run
    :param installable: whether an installation of Python and packages solves it
    """

    text: str
    remedy: str
    certain: bool = True
    installable: bool = False


def named(files: Sequence[str]) -> str:
    """Return the first of these files, and how many more there are."""
    more = f" and {len(files) - _MAX_NAMED} more" if len(files) > _MAX_NAMED else ""
    return ", ".join(files[:_MAX_NAMED]) + more


def same_version_on_both(version: str) -> str:
    """Return how to install this computer's version of WPILib on the robot.

    :param version: the version of `wpilib` on this computer
    """
    return (
        f'Use the same version on both: robotpy_version = "{version}" under [tool.robotpy] in pyproject.toml; '
        f"{INSTALL_PACKAGES}."
    )


def image_it(controller: ControllerKind) -> str:
    """Return how to install the season's image on a robot."""
    images = CURRENT.controller.images
    return f"{controller.image_it}{f' (image {images[-1]})' if images else ''}. {_SECTION}"


def image_problem(image: str | None, wpilib: str, controller: ControllerKind) -> str | None:
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


#: Printed between the contents of files.
_MARK = "-- pyfrc --"


def _look(layout: Layout) -> str:
    """Return a shell script that prints the layout's texts. Missing files print nothing."""
    lines = ["exec 2> /dev/null"]
    for file in layout.texts.values():
        lines += [f"cat {file}", f"echo; echo '{_MARK}'"]
    return "\n".join(lines)


class RobotWithoutPython:
    """A robot without Python.

    `image` is its image's version, or None if unknown.
    """

    def __init__(self, connection: Connection) -> None:
        self._controller = connection.controller
        layout, printed = self._controller.layout, ""
        with suppress(ConnectionFailedError):  # it is still certain that there is no Python
            printed = connection.run(_look(layout))[1]
        *texts, _ = printed.split(f"\n{_MARK}\n")
        image = self._controller.image_in(dict(zip(layout.texts, texts, strict=False)))
        self.image = None if image is None else one_line(image)

    def obstacles(self) -> Iterator[Obstacle]:
        """Yield the reasons why the robot is not ready, in the order in which to resolve them."""
        try:
            wrong_image = image_problem(self.image, version("wpilib"), self._controller)
        except PackageNotFoundError:
            wrong_image = None
        if wrong_image is not None:
            yield Obstacle(wrong_image, image_it(self._controller))
        yield Obstacle(f"there is no Python on the robot ({self._controller.python})", PREPARE, installable=True)

    def refusal(self, error: NoPythonError) -> RefusedError:
        """Return the error for a command that needs the agent."""
        obstacles = list(self.obstacles())
        what = "; ".join(each.text for each in reversed(obstacles))
        return RefusedError(what, where=error.where, remedy=obstacles[0].remedy)
