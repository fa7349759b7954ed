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
from .trace_lines import Change, lines_of

if TYPE_CHECKING:
    from ...hal import HalData

FORMAT = "pyfrc-trace 2"

#: How many packets' changes are kept before their lines are made.
_BATCH = 10


class TracedChanges:
    """Finds each value of `hal_data` that differs from the packet before.

    :param hal_data: the tree to watch
    """

    def __init__(self, hal_data: HalData) -> None:
        self._changes = hal_data.changes()
        #: The changes that were not taken yet: the robot time, the new values by path, and paths that have gone.
        self._waiting: list[tuple[float, dict[str, Any], list[str]]] = []
        #: The libraries whose devices do not repeat, and whether the values of a path are of one.
        self._libraries: tuple[str, ...] = ()
        self._known: dict[str, bool] = {}

    def look(self, now: float) -> None:
        """Note what has changed by `now`, in seconds of robot time."""
        changed, gone = self._changes.look_at_values()
        if changed or gone:
            self._waiting.append((round(now, 6), changed, gone))

    def take(self) -> list[Change]:
        """Return what was found since the last call."""
        waiting, self._waiting = self._waiting, []
        return [Change(now, changed, tuple(gone), self._marked(changed)) for now, changed, gone in waiting]

    def _marked(self, changed: dict[str, Any]) -> frozenset[str]:
        """Return the paths of the values that do not repeat."""
        if not (libraries := unrepeatable_libraries()):
            return frozenset()
        if self._libraries != libraries:  # a device drew noise for the first time
            self._libraries, self._known = libraries, {}
        for path in changed.keys() - self._known:
            self._known[path] = is_unrepeatable(path)
        return frozenset(path for path in changed if self._known[path])


class Trace(TracedChanges):
    """Records what has changed, as lines with a hash.

    :param hal_data: the tree to watch
    :param out: where to write the changes, one JSON line for each packet that changed something
    """

    def __init__(self, hal_data: HalData, out: IO[str] | None = None) -> None:
        super().__init__(hal_data)
        self._out = out
        self._hash = hashlib.sha256()
        if out is not None:
            out.write(json.dumps({"format": FORMAT}) + "\n")

    def look(self, now: float) -> None:
        """Record what has changed by `now`, in seconds of robot time."""
        super().look(now)
        if len(self._waiting) >= _BATCH:
            self.write_lines()

    def write_lines(self) -> None:
        """Make the lines of all changes until now, and write them."""
        lines = [lines_of(change) for change in self.take()]
        self._hash.update("".join(hashed for hashed, _ in lines).encode())
        if self._out is not None and lines:  # the file may be closed
            self._out.writelines(f"{line}\n" for _, line in lines)

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
