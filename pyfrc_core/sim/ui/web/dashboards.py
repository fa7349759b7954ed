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

        A page sends what it has seen in the place that it writes, so that it does not replace what it has not.

        :raises CommandError: when that is not possible
        """
        name, content = message.text("dashboard").strip(), message.raw("content")
        former = message.text("former_name") if "former_name" in message else None
        seen = message.raw("seen") if "seen" in message else {}
        if not name:
            raise CommandError("A dashboard needs a name.")
        if not isinstance(seen, dict):
            raise CommandError("seen: an object with a dashboard for each name is needed")
        try:
            save_dashboard(self._root, name, content, former, seen)
        except PyfrcError as wrong:
            raise CommandError(f"The dashboard was not saved: {wrong}") from None
        except OSError as wrong:
            raise CommandError(
                f"The dashboard was not saved: {DASHBOARDS.as_posix()} cannot be written: {wrong.strerror}. "
                "Make the file and its directory writable, and save again: the page keeps what you have arranged."
            ) from None
        return self.found()

    def _stamp(self) -> str:
        try:
            status = (self._root / DASHBOARDS).stat()
        except FileNotFoundError:
            return "none"
        except OSError as wrong:
            return f"error {wrong.errno}"
        return f"{status.st_mtime_ns} {status.st_size} {status.st_ino}"
