"""What a robot did, packet by packet: the changes of `hal_data`, and one hash over all of them.

Two runs with the same hash did the same, bit for bit. As JSON lines, two traces can be compared with any diff.

Values of devices that are simulated in real time (`compat.real_time_devices`) do not repeat. They are marked: a line
has them under ``real_time``, and the hash leaves them out.
"""

from __future__ import annotations

import hashlib
import json
from typing import IO, TYPE_CHECKING

from ..compat.real_time_devices import is_real_time, real_time_libraries
from ..hal.change_reader import MISSING
from .trace_lines import trace_line, with_real_time

if TYPE_CHECKING:
    from ..hal import HalData

FORMAT = "pyfrc-trace 2"


class Trace:
    """Records each value of `hal_data` that differs from the packet before.

    :param hal_data: the tree to watch
    :param out: where to write the changes, one JSON line for each packet that changed something
    """

    def __init__(self, hal_data: HalData, out: IO[str] | None = None) -> None:
        self._changes = hal_data.changes()
        self._out = out
        #: The paths whose values do not repeat.
        self._real_time: set[str] = set()
        self._hash = hashlib.sha256()
        if out is not None:
            out.write(json.dumps({"format": FORMAT}) + "\n")

    def look(self, now: float) -> None:
        """Record what has changed by `now`, in seconds of robot time."""
        found, gone = self._changes.look()
        changed = {path: new for path, old, new in found if old != new}
        if not changed and not gone:
            return
        marked = {}
        if real_time_libraries():
            self._real_time.update(path for path, old, _ in found if old is MISSING and is_real_time(path))
            marked = {path: changed.pop(path) for path in list(changed) if path in self._real_time}
        line = trace_line(round(now, 6), changed, gone)
        if changed or gone:
            self._hash.update(line.encode())
        if self._out is not None:
            self._out.write(f"{with_real_time(line, marked) if marked else line}\n")

    def digest(self) -> str:
        """Return the hash of everything recorded so far, in hexadecimal."""
        return self._hash.hexdigest()

    def finish(self) -> str:
        """Write the hash as the last line, and return it."""
        digest = self.digest()
        if self._out is not None:
            self._out.write(json.dumps({"sha256": digest}) + "\n")
        return digest
