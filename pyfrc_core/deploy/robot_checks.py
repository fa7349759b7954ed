"""Checks whether the robot is ready for a Python program, with a remedy for each problem."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING

from .._version import requirement
from .errors import RefusedError
from .progress import DeployProgress
from .robot_setup import PREPARE, Obstacle, image_it, image_problem, python_problem, same_version_on_both
from .targets import AdministratorTask, Controller

if TYPE_CHECKING:
    from .connection import Connection
    from .facts import RobotFacts

NO_CHECK = "To deploy without this check: -n (--no-version-check)."


def refuse_unfit_robot(facts: RobotFacts, controller: Controller, where: str, check_versions: bool) -> None:
    """Check whether the program can run on the robot.

    :param check_versions: also refuse a robot where the program might fail
    :raises RefusedError: if it cannot
    """
    for each in obstacles(facts, controller):
        if each.certain:
            raise RefusedError(each.text, where=where, remedy=each.remedy)
        if check_versions:
            raise RefusedError(each.text, where=where, remedy=f"{each.remedy} {NO_CHECK}")


def obstacles(facts: RobotFacts, controller: Controller) -> Iterator[Obstacle]:
    """Yield the reasons why a robot is not ready, most important first.

    :raises RefusedError: if `wpilib` is not installed on this computer
    """
    image = image_it(controller)
    if facts.not_controller is not None:
        remedy = f"Check the address, or name the robot with --robot HOST. For a new {controller.name}: {image}"
        yield Obstacle(f"this is not a {controller.name}: {facts.not_controller}", remedy)
        return
    ours = _our_wpilib()
    if facts.wpilib is None:
        yield Obstacle("there is no wpilib for Python on the robot", PREPARE)
    wrong_python = python_problem(facts.python, ours)
    if wrong_python is not None:
        yield Obstacle(wrong_python, PREPARE, certain=False)
    if facts.wpilib not in (None, ours):
        text = f"the robot has wpilib {facts.wpilib}, this computer has {ours}: what passes here may fail there"
        yield Obstacle(text, same_version_on_both(ours), certain=False)
    wrong_image = image_problem(facts.image, ours, controller)
    if wrong_image is not None:
        yield Obstacle(wrong_image, image, certain=False)


class BackgroundTask:
    """Runs a task of the administrator in the background, over a second connection. A failure only causes a warning.

    :param task: None: nothing to do
    """

    def __init__(self, task: AdministratorTask | None, connection: Connection) -> None:
        self._task = task
        self._connection = connection
        self._problem: str | None = None
        self._thread = threading.Thread(target=self._run)
        if task is not None:
            self._thread.start()

    def report(self, progress: DeployProgress) -> None:
        """Wait for the result, and print it."""
        if self._task is None:
            return
        self._thread.join()
        if self._problem is None:
            progress.note(f"  {self._task.done}")
        else:
            progress.warning(f"{self._task.failed}: {self._problem}")

    def _run(self) -> None:
        assert self._task is not None
        self._problem = self._connection.administer(self._task)


def _our_wpilib() -> str:
    try:
        return version("wpilib")
    except PackageNotFoundError:  # a dependency of pyfrc, so it was uninstalled
        raise RefusedError(
            "there is no wpilib on this computer", remedy=f'Install it: pip install --force-reinstall "{requirement()}"'
        ) from None
