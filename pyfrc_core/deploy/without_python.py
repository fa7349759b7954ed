"""A robot without Python, which cannot run the agent, as inspected by shell commands."""

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
from .robot_setup import IMAGE_IT, PREPARE, Obstacle, image_problem, other_languages_notice

# A failing command is ignored: missing files print nothing.
_LOOK = f"""
cat {inventory.IMAGE_FILE}
echo
grep -lE {quote(inventory.START_COMMAND)} {" ".join(inventory.START_COMMAND_FILES)}
ls -d {" ".join(inventory.PROGRAMS)} {inventory.JAVA}
[ -z "$(ls -A {inventory.LIBRARIES})" ] || echo {inventory.LIBRARIES}
"""


class RobotWithoutPython:
    """A robot without Python.

    `image` is its image's version, or None if unknown. `other_languages` has the files and directories of programs in
    Java and C++.
    """

    def __init__(self, connection: Connection) -> None:
        printed = ""
        with suppress(ConnectionFailedError):  # it is still certain that there is no Python
            printed = connection.run(f"exec 2> /dev/null\n{_LOOK}")[1]
        image = inventory.image_in(printed)
        self.image = None if image is None else one_line(image)
        self.other_languages = tuple(one_line(line) for line in printed.splitlines() if line.startswith("/"))

    def obstacles(self) -> Iterator[Obstacle]:
        """Yield the reasons why the robot is not ready, in the order in which to resolve them."""
        try:
            wrong_image = image_problem(self.image, version("wpilib"))
        except PackageNotFoundError:
            wrong_image = None
        if wrong_image is not None:
            yield Obstacle(wrong_image, IMAGE_IT)
        yield Obstacle(f"there is no Python on the robot ({PYTHON})", PREPARE)

    def refusal(self, error: NoPythonError) -> RefusedError:
        """Return the error for a command that needs the agent."""
        obstacles = list(self.obstacles())
        what, remedy = [each.text for each in reversed(obstacles)], obstacles[0].remedy
        if self.other_languages:
            text, removal = other_languages_notice(self.other_languages)
            what.append(text)
            remedy = f"{remedy} {removal}"
        return RefusedError("; ".join(what), where=error.where, remedy=remedy)
