"""What a robot did, packet by packet: the changes of `hal_data`, and one hash over all of them.

Two runs with the same hash did the same, bit for bit. As JSON lines, two traces can be compared with any diff.
"""

from __future__ import annotations

import hashlib
import json
from itertools import compress
from operator import ne
from typing import IO, TYPE_CHECKING, Any

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
        self._paths: list[str] = []
        self._values: list[Any] = []
        self._hash = hashlib.sha256()
        if out is not None:
            out.write(json.dumps({"format": FORMAT}) + "\n")

    def look(self, now: float) -> None:
        """Record what has changed by `now`, in seconds of robot time."""
        # Two lists, since as many pairs at each packet would keep the garbage collector busy.
        paths, values = self._hal_data.paths_and_values()
        before = self._values
        if paths is self._paths:
            if values == before:
                return
            # Nearly all are equal: to find the others, no Python code runs for each of them.
            others = compress(zip(paths, before, values, strict=True), map(ne, before, values))
            changed = {path: new for path, old, new in others if _differ(old, new)}
            gone = []
        else:
            had, has = dict(zip(self._paths, before, strict=True)), dict(zip(paths, values, strict=True))
            changed = {path: value for path, value in has.items() if path not in had or _differ(had[path], value)}
            gone = [path for path in had if path not in has]
            self._paths = paths
        self._values = values
        if not changed and not gone:
            return
        line = json.dumps({"t": round(now, 6), "set": changed} | ({"gone": gone} if gone else {}), sort_keys=True)
        self._hash.update(line.encode())
        if self._out is not None:
            self._out.write(line + "\n")

    def digest(self) -> str:
        """Return the hash of everything recorded so far, in hexadecimal."""
        return self._hash.hexdigest()

    def finish(self) -> str:
        """Write the hash as the last line, and return it."""
        digest = self.digest()
        if self._out is not None:
            self._out.write(json.dumps({"sha256": digest}) + "\n")
        return digest


def _differ(old: object, new: object) -> bool:
    # NaN differs from itself, so it is compared by its text.
    return old != new and repr(old) != repr(new)
