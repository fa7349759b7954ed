"""The dashboards of a project for its pages: what ``sim/dashboards.json`` has, read again when it has changed.

A page asks for them from time to time, so that it also shows what another page, an editor or Git has written.
"""

from __future__ import annotations

import urllib.error
import urllib.request
from http.client import HTTPException
from pathlib import Path
from time import monotonic
from typing import Any

from ....config.dashboards import DASHBOARDS, load_dashboards, save_dashboard
from ....config.elastic_layout import ELASTIC_LAYOUT, read_elastic_layout
from ....errors import PyfrcError
from .messages import CommandError, Message

#: Where robots serve their deploy directory for Elastic.
_LAYOUT_PORT = 5800
#: How long a robot's layout may take in seconds, and its size in bytes.
_LAYOUT_SECONDS, _MOST_LAYOUT = 4.0, 4 << 20


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

    def elastic_layout(self, robot: str | None) -> dict[str, Any]:
        """Return the dashboards of a layout for Elastic, where it is, and what they lack.

        :param robot: the host of a robot elsewhere, which serves it; None: the project's is taken
        :raises CommandError: when there is none
        """
        if robot == "":
            raise CommandError("There is no connection to the robot, which has the layout.")
        if robot is None:
            where = ELASTIC_LAYOUT.as_posix()
            remedy = "Save your layout there in Elastic, so that it is deployed, too."
        else:
            where = f"http://{robot}:{_LAYOUT_PORT}/{ELASTIC_LAYOUT.name}"
            remedy = "A robot serves it if its code starts WPILib's WebServer at port 5800 with the deploy directory."
        try:
            text = (self._root / ELASTIC_LAYOUT).read_bytes() if robot is None else _fetched(where)
            found = read_elastic_layout(text, where)
        except PyfrcError as wrong:
            raise CommandError(" ".join(str(wrong).split())) from None
        except (OSError, HTTPException) as wrong:
            reason = getattr(wrong, "reason", wrong)
            raise CommandError(
                f"{where} cannot be read: {getattr(reason, 'strerror', None) or reason}. {remedy}"
            ) from None
        return {"from": where, **found._asdict()}

    def _stamp(self) -> str:
        try:
            status = (self._root / DASHBOARDS).stat()
        except FileNotFoundError:
            return "none"
        except OSError as wrong:
            return f"error {wrong.errno}"
        return f"{status.st_mtime_ns} {status.st_size} {status.st_ino}"


def _fetched(address: str) -> bytes:
    """Return what a robot serves; a proxy is of the internet, not of its network."""
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    text, ends = b"", monotonic() + _LAYOUT_SECONDS
    try:
        response = opener.open(address, timeout=_LAYOUT_SECONDS)
    except urllib.error.HTTPError as refused:
        refused.close()
        raise
    with response:
        while piece := response.read1(1 << 16):
            text += piece
            if len(text) > _MOST_LAYOUT or monotonic() > ends:
                raise OSError("it is too large, or comes too slowly")
    return text
