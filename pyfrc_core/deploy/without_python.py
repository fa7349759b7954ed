"""A robot that has no Python, so that no agent can run on it: what its shell says about it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from shlex import quote

from ..terminal_text import one_line
from .agent import inventory
from .agent_stream import PYTHON
from .connection import Connection
from .errors import ConnectionFailedError, NoPythonError, RefusedError
from .preparing import IMAGE_IT, PREPARE, Obstacle, image_problem, other_languages_notice

# No command's failure matters: what is not there prints nothing.
_LOOK = f"""
cat {inventory.IMAGE_FILE}
echo
grep -lE {quote(inventory.START_COMMAND)} {" ".join(inventory.START_COMMAND_FILES)}
ls -d {" ".join(inventory.PROGRAMS)} {inventory.JAVA}
[ -z "$(ls -A {inventory.LIBRARIES})" ] || echo {inventory.LIBRARIES}
"""


class RobotWithoutPython:
    """What there is on a robot without Python.

    :param image:           its image's version; none: unknown
    :param other_languages: files and directories of programs in Java and C++
    """

    def __init__(self, connection: Connection) -> None:
        printed = ""
        with suppress(ConnectionFailedError):  # that there is no Python is certain all the same
            printed = connection.run(f"exec 2> /dev/null\n{_LOOK}")[1]
        image = inventory.image_in(printed)
        self.image = None if image is None else one_line(image)
        self.other_languages = tuple(one_line(line) for line in printed.splitlines() if line.startswith("/"))

    def obstacles(self) -> Iterator[Obstacle]:
        """Return what is in the way of a deploy, in the order in which it is to be removed."""
        try:
            wrong_image = image_problem(self.image, version("wpilib"))
        except PackageNotFoundError:
            wrong_image = None
        if wrong_image is not None:
            yield Obstacle(wrong_image, IMAGE_IT)
        yield Obstacle(f"there is no Python on the robot ({PYTHON})", PREPARE)

    def refusal(self, error: NoPythonError) -> RefusedError:
        """Return the error for a command that needs an agent there."""
        obstacles = list(self.obstacles())
        what, remedy = [each.text for each in reversed(obstacles)], obstacles[0].remedy
        if self.other_languages:
            text, removal = other_languages_notice(self.other_languages)
            what.append(text)
            remedy = f"{remedy} {removal}"
        return RefusedError("; ".join(what), where=error.where, remedy=remedy)
