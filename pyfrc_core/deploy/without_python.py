"""A robot without Python, which cannot run the agent, as inspected by shell commands."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from shlex import quote
from typing import TYPE_CHECKING

from ..terminal_text import one_line
from .connection import Connection
from .errors import ConnectionFailedError, NoPythonError, RefusedError
from .robot_setup import PREPARE, Obstacle, image_it, image_problem, other_languages_notice

if TYPE_CHECKING:
    from .agent.layout import Layout

#: Printed between the contents of files, and before the files of other languages.
_MARK = "-- pyfrc --"


def _look(layout: Layout) -> str:
    """Return a shell script that prints the layout's texts, and the files of programs in other languages.

    A failing command is ignored: missing files print nothing.
    """
    lines = ["exec 2> /dev/null"]
    for file in layout.texts.values():
        lines += [f"cat {file}", f"echo; echo '{_MARK}'"]
    commands = " ".join(f"{layout.home}/{name}" for name in layout.command_files)
    lines.append(f"grep -lE {quote(layout.other_start)} {commands}")
    for pattern in layout.other_files:
        directory = pattern.removesuffix("/")
        lines.append(f"ls -d {pattern}" if directory == pattern else f'[ -z "$(ls -A {pattern})" ] || echo {directory}')
    return "\n".join(lines)


class RobotWithoutPython:
    """A robot without Python.

    `image` is its image's version, or None if unknown. `other_languages` has the files and directories of programs in
    Java and C++.
    """

    def __init__(self, connection: Connection) -> None:
        self._controller = connection.controller
        layout, printed = self._controller.layout, ""
        with suppress(ConnectionFailedError):  # it is still certain that there is no Python
            printed = connection.run(_look(layout))[1]
        *texts, files = printed.split(f"\n{_MARK}\n")
        image = self._controller.image_in(dict(zip(layout.texts, texts, strict=False)))
        self.image = None if image is None else one_line(image)
        self.other_languages = tuple(one_line(line) for line in files.splitlines() if line.startswith("/"))

    def obstacles(self) -> Iterator[Obstacle]:
        """Yield the reasons why the robot is not ready, in the order in which to resolve them."""
        try:
            wrong_image = image_problem(self.image, version("wpilib"), self._controller)
        except PackageNotFoundError:
            wrong_image = None
        if wrong_image is not None:
            yield Obstacle(wrong_image, image_it(self._controller))
        yield Obstacle(f"there is no Python on the robot ({self._controller.python})", PREPARE)

    def refusal(self, error: NoPythonError) -> RefusedError:
        """Return the error for a command that needs the agent."""
        obstacles = list(self.obstacles())
        what, remedy = [each.text for each in reversed(obstacles)], obstacles[0].remedy
        if self.other_languages:
            text, removal = other_languages_notice(self.other_languages)
            what.append(text)
            remedy = f"{remedy} {removal}"
        return RefusedError("; ".join(what), where=error.where, remedy=remedy)
