"""What a robot did, packet by packet: the changes of `hal_data`, and one hash over all of them.

Two runs with the same hash did the same, bit for bit. As JSON lines, two traces can be compared with any diff.
"""

from __future__ import annotations

import hashlib
import json
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from ..hal import HalData

FORMAT = "pyfrc-trace 1"


class Trace:
    """Records each value of `hal_data` that differs from the packet before.

    :param hal_data: the tree to watch
    :param out: where to write the changes, one JSON line for each packet that changed something
    """

    def __init__(self, hal_data: HalData, out: IO[str] | None = None) -> None:
        self._hal_data = hal_data
        self._out = out
        self._before: dict[str, object] = {}
        self._hash = hashlib.sha256()
        if out is not None:
            out.write(json.dumps({"format": FORMAT}) + "\n")

    def look(self, now: float) -> None:
        """Record what has changed by `now`, in seconds of robot time."""
        values = dict(self._hal_data.leaves())
        before = self._before
        # NaN differs from itself, so it is told apart by how it is written.
        changed = {
            path: value
            for path, value in values.items()
            if path not in before
            or (before[path] is not value and before[path] != value and repr(before[path]) != repr(value))
        }
        gone = [path for path in before if path not in values]
        if not changed and not gone:
            return
        self._before = values
        line = json.dumps({"t": round(now, 6), "set": changed} | ({"gone": gone} if gone else {}), sort_keys=True)
        self._hash.update(line.encode())
        if self._out is not None:
            self._out.write(line + "\n")

    def digest(self) -> str:
        """The hash of everything recorded so far, in hexadecimal."""
        return self._hash.hexdigest()

    def finish(self) -> str:
        """Write the hash as the last line, and answer it."""
        digest = self.digest()
        if self._out is not None:
            self._out.write(json.dumps({"sha256": digest}) + "\n")
        return digest
