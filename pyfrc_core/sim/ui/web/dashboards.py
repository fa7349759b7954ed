"""The dashboards of a project for its pages: what ``sim/dashboards.json`` has, read again when it has changed.

A page asks for them from time to time, so that it also shows what another page, an editor or Git has written.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ....config.dashboards import DASHBOARDS, load_dashboards, save_dashboard
from ....errors import PyfrcError
from .messages import CommandError, Message


class Dashboards:
    """The dashboards of the project in a directory."""

    def __init__(self, root: Path) -> None:
        self._root = root

    def found(self, known: str = "") -> dict[str, Any]:
        """Return the dashboards, or the problem of the file; and a stamp, alone if the page knows that state.

        :param known: the stamp that the page has
        """
        stamp = self._stamp()
        if stamp == known:
            return {"stamp": stamp}
        try:
            dashboards, problem = load_dashboards(self._root), ""
        except PyfrcError as wrong:
            dashboards, problem = {}, str(wrong)
        plain = {name: dashboard.model_dump(exclude_none=True) for name, dashboard in dashboards.items()}
        return {"stamp": stamp, "dashboards": plain, "problem": problem}

    def save(self, message: Message) -> dict[str, Any]:
        """Save what a page has arranged, and return the dashboards.

        A page sends the stamp of what it has seen, so that it does not replace what it has not.

        :raises CommandError: when that is not possible
        """
        name, content = message.text("dashboard").strip(), message.raw("content")
        former = message.text("former_name") if "former_name" in message else None
        if "stamp" in message and message.text("stamp") != self._stamp():
            raise CommandError(f"{DASHBOARDS.as_posix()} has just been changed. Nothing was saved: try again.")
        if not name:
            raise CommandError("A dashboard needs a name.")
        try:
            save_dashboard(self._root, name, content, former)
        except PyfrcError as wrong:
            raise CommandError(f"The dashboard was not saved: {wrong}") from None
        except OSError as wrong:
            raise CommandError(f"The dashboard was not saved: {wrong.filename}: {wrong.strerror}") from None
        return self.found()

    def _stamp(self) -> str:
        try:
            status = (self._root / DASHBOARDS).stat()
        except OSError:
            return "none"
        return f"{status.st_mtime_ns} {status.st_size} {status.st_ino}"
