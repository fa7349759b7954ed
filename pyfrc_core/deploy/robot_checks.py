"""Checks whether the robot is ready for a Python program, with a remedy for each problem."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING

from .._version import requirement
from .errors import RefusedError
from .progress import DeployProgress
from .robot_setup import IMAGE_IT, PREPARE, Obstacle, image_problem, python_problem, same_version_on_both

if TYPE_CHECKING:
    from .connection import Connection
    from .facts import RobotFacts

NO_CHECK = "To deploy without this check: -n (--no-version-check)."

# With this line, services of the image load libraries that robots do not use.
_MEMORY_SAVER = "sed -i -e 's/^StartupDLLs/;StartupDLLs/' /etc/natinst/share/ni-rt.ini"


def refuse_unfit_robot(facts: RobotFacts, where: str, check_versions: bool) -> None:
    """Check whether the program can run on the robot.

    :param check_versions: also refuse a robot where the program might fail
    :raises RefusedError: if it cannot
    """
    for each in obstacles(facts):
        if each.certain:
            raise RefusedError(each.text, where=where, remedy=each.remedy)
        if check_versions:
            raise RefusedError(each.text, where=where, remedy=f"{each.remedy} {NO_CHECK}")


def obstacles(facts: RobotFacts) -> Iterator[Obstacle]:
    """Yield the reasons why a robot is not ready, most important first.

    :raises RefusedError: if `wpilib` is not installed on this computer
    """
    if facts.not_roborio is not None:
        remedy = f"Check the address, or name the robot with --robot HOST. For a new roboRIO: {IMAGE_IT}"
        yield Obstacle(f"this is not a roboRIO: {facts.not_roborio}", remedy)
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
    wrong_image = image_problem(facts.image, ours)
    if wrong_image is not None:
        yield Obstacle(wrong_image, IMAGE_IT, certain=False)


class MemorySaver:
    """Frees 24 MB of memory that the image's services use needlessly, in the background.

    This needs a second connection, as administrator. A failure only causes a warning.
    """

    def __init__(self, facts: RobotFacts, connection: Connection) -> None:
        self._connection = connection
        self._problem: str | None = None
        self._thread = threading.Thread(target=self._run) if facts.startup_dlls else None
        if self._thread is not None:
            self._thread.start()

    def report(self, progress: DeployProgress) -> None:
        """Wait for the result, and print it."""
        if self._thread is None:
            return
        self._thread.join()
        if self._problem is None:
            progress.note("  StartupDLLs was switched off: 24 MB more memory after the robot's next start")
        else:
            progress.warning(f"StartupDLLs, which costs 24 MB of memory, could not be switched off: {self._problem}")

    def _run(self) -> None:
        self._problem = self._connection.administer(_MEMORY_SAVER)


def _our_wpilib() -> str:
    try:
        return version("wpilib")
    except PackageNotFoundError:  # a dependency of pyfrc, so it was uninstalled
        raise RefusedError(
            "there is no wpilib on this computer", remedy=f'Install it: pip install --force-reinstall "{requirement()}"'
        ) from None
