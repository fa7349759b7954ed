"""Whether the robot is ready for a program of ours; what is not right is told with what to do about it."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING

from .._version import requirement
from .errors import RefusedError
from .preparing import IMAGE_IT, PREPARE, Obstacle, image_problem, python_problem, same_version_on_both
from .progress import Progress

if TYPE_CHECKING:
    from .connection import Connection
    from .facts import RobotFacts

NO_CHECK = "If you are sure that it works all the same: -n (--no-version-check)."

# Without it, some services of the image load libraries that robots do not use.
_MEMORY_SAVER = "sed -i -e 's/^StartupDLLs/;StartupDLLs/' /etc/natinst/share/ni-rt.ini"


def refuse_unfit_robot(facts: RobotFacts, where: str, check_versions: bool) -> None:
    """:raises RefusedError: when the program could not run there, or (`check_versions`) might not"""
    for each in obstacles(facts):
        if each.certain:
            raise RefusedError(each.text, where=where, remedy=each.remedy)
        if check_versions:
            raise RefusedError(each.text, where=where, remedy=f"{each.remedy} {NO_CHECK}")


def obstacles(facts: RobotFacts) -> Iterator[Obstacle]:
    """Return what is in the way of a deploy, most important first.

    :raises RefusedError: when there is no `wpilib` on this computer to compare with
    """
    if facts.not_roborio is not None:
        remedy = f"Is that the right address? Name the robot with --robot HOST. Is it a new roboRIO? {IMAGE_IT}"
        yield Obstacle(f"this is no roboRIO: {facts.not_roborio}", remedy)
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
    """Gives the program 24 MB that the image's services take for nothing.

    It needs the administrator, and so a connection of its own, meanwhile; and hinders nothing when it fails.

    :param connection: to the robot
    """

    def __init__(self, facts: RobotFacts, connection: Connection) -> None:
        self._connection = connection
        self._problem: str | None = None
        self._thread = threading.Thread(target=self._run) if facts.startup_dlls else None
        if self._thread is not None:
            self._thread.start()

    def tell(self, progress: Progress) -> None:
        """Wait for it, and tell what came of it."""
        if self._thread is None:
            return
        self._thread.join()
        if self._problem is None:
            progress.note("  StartupDLLs was switched off: 24 MB more memory from the robot's next start on")
        else:
            progress.warning(f"StartupDLLs, which costs 24 MB of memory, could not be switched off: {self._problem}")

    def _run(self) -> None:
        self._problem = self._connection.administer(_MEMORY_SAVER)


def _our_wpilib() -> str:
    try:
        return version("wpilib")
    except PackageNotFoundError:  # our own dependency: somebody has removed it
        raise RefusedError(
            "there is no wpilib on this computer", remedy=f'Install it: pip install --force-reinstall "{requirement()}"'
        ) from None
