"""The first difference between two traces."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

from .robot_time import to_us
from .trace import repeatable_part


@dataclass(frozen=True)
class Difference:
    """The first difference between two traces.

    :param now: robot time, in seconds
    :param path: the path in `hal_data`
    :param recorded: the recorded value; None when there is none, or it did not change
    :param replayed: the value in the replay
    """

    now: float
    path: str
    recorded: Any
    replayed: Any


def first_difference(recorded: Path, replayed: Path, run_us: int | None = None) -> Difference | None:
    """Return the first difference between two traces; None if there is none.

    :param run_us: differences from this time on do not count
    """
    for old, new in zip_longest(_changes(recorded), _changes(replayed)):
        if old == new:
            continue
        moments = [change["t"] for change in (old, new) if change is not None]
        now = min(moments)
        if run_us is not None and to_us(now) >= run_us:
            return None
        before = old.get("set", {}) if old is not None and old["t"] == now else {}
        after = new.get("set", {}) if new is not None and new["t"] == now else {}
        for path in sorted({*before, *after}):
            if before.get(path) != after.get(path) or (path in before) != (path in after):
                return Difference(now, path, before.get(path), after.get(path))
        return Difference(now, "what there is", (old or {}).get("gone"), (new or {}).get("gone"))
    return None


def _changes(trace: Path) -> Iterator[dict[str, Any]]:
    with trace.open(encoding="utf-8") as lines:
        for line in lines:
            change = json.loads(line)
            if "t" in change and (repeats := repeatable_part(change)) is not None:
                yield repeats
