"""What a robot did, packet by packet: the changes of `hal_data`, and one hash over all of them.

Two runs with the same hash did the same, bit for bit. As JSON lines, two traces can be compared with any diff.

Values of some vendors' simulated devices do not repeat (`compat.unrepeatable`). They are marked: a line has them under
``unrepeatable``, and the hash leaves them out.
"""

from __future__ import annotations

import hashlib
import json
from typing import IO, TYPE_CHECKING, Any

from ...compat.unrepeatable import is_unrepeatable, unrepeatable_libraries
from .trace_lines import trace_line, with_unrepeatable

if TYPE_CHECKING:
    from ...hal import HalData

FORMAT = "pyfrc-trace 2"

#: How many packets' changes are kept before their lines are made.
_BATCH = 10


class Trace:
    """Records each value of `hal_data` that differs from the packet before.

    :param hal_data: the tree to watch
    :param out: where to write the changes, one JSON line for each packet that changed something
    """

    def __init__(self, hal_data: HalData, out: IO[str] | None = None) -> None:
        self._changes = hal_data.changes()
        self._out = out
        #: The changes whose lines have not been made: the robot time, the new values by path, and paths that have gone.
        self._waiting: list[tuple[float, dict[str, Any], list[str]]] = []
        #: The libraries whose devices do not repeat, and whether the values of a path are of one.
        self._libraries: tuple[str, ...] = ()
        self._known: dict[str, bool] = {}
        self._hash = hashlib.sha256()
        if out is not None:
            out.write(json.dumps({"format": FORMAT}) + "\n")

    def look(self, now: float) -> None:
        """Record what has changed by `now`, in seconds of robot time."""
        changed, gone = self._changes.look_at_values()
        if changed or gone:
            self._waiting.append((round(now, 6), changed, gone))
            if len(self._waiting) == _BATCH:
                self.write_lines()

    def write_lines(self) -> None:
        """Make the lines of all changes until now, and write them."""
        if not self._waiting:
            return
        waiting, self._waiting = self._waiting, []
        hashed, written = [], []
        for now, changed, gone in waiting:
            marked = self._take_marked(changed) if unrepeatable_libraries() else {}
            line = trace_line(now, changed, gone)
            if changed or gone:
                hashed.append(line)
            written.append(with_unrepeatable(line, marked) if marked else line)
        self._hash.update("".join(hashed).encode())
        if self._out is not None:
            self._out.write("\n".join([*written, ""]))

    def _take_marked(self, changed: dict[str, Any]) -> dict[str, Any]:
        """Remove the values that do not repeat, and return them."""
        if self._libraries != unrepeatable_libraries():  # a device drew noise for the first time
            self._libraries, self._known = unrepeatable_libraries(), {}
        for path in changed.keys() - self._known:
            self._known[path] = is_unrepeatable(path)
        return {path: changed.pop(path) for path in list(changed) if self._known[path]}

    def digest(self) -> str:
        """Return the hash of everything recorded so far, in hexadecimal."""
        self.write_lines()
        return self._hash.hexdigest()

    def finish(self) -> str:
        """Write the hash as the last line, and return it."""
        digest = self.digest()
        if self._out is not None:
            self._out.write(json.dumps({"sha256": digest}) + "\n")
        return digest
