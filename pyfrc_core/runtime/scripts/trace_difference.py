"""The first difference between two traces."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

from ...hal.rows import role_of
from ...wording import from_here
from ..robot_time import to_us
from .script import ScriptError
from .trace_lines import repeatable_part


@dataclass(frozen=True)
class Difference:
    """The first difference between two traces.

    :param now: robot time, in seconds
    :param path: the path in `hal_data`
    :param recorded: the recorded value; None when there is none
    :param replayed: the value in the replay; None when there is none
    """

    now: float
    path: str
    recorded: Any
    replayed: Any


def first_difference(recorded: Path, replayed: Path, run_us: int | None = None) -> Difference | None:
    """Return the first difference between two traces; None if there is none.

    :param run_us: differences from this time on do not count
    :raises ScriptError: when a trace is damaged
    """
    equal: dict[str, Any] = {}  # the values of both until then
    for old, new in zip_longest(_changes(recorded), _changes(replayed)):
        if old == new:
            equal.update(old["set"] if old is not None else {})
            continue
        moments = [change["t"] for change in (old, new) if change is not None]
        now = min(moments)
        if run_us is not None and to_us(now) >= run_us:
            return None
        before = equal | old["set"] if old is not None and old["t"] == now else equal
        after = equal | new["set"] if new is not None and new["t"] == now else equal
        different = [path for path in before | after if before.get(path) != after.get(path)]
        if different:
            path = min(different, key=rank)
            return Difference(now, path, before.get(path), after.get(path))
        return Difference(now, "what there is", (old or {}).get("gone"), (new or {}).get("gone"))
    return None


def rank(path: str) -> tuple[bool, str]:
    """Return what puts the outputs that robot code sets before the sensors that follow from them."""
    return role_of(path) != "output", path


def _changes(trace: Path) -> Iterator[dict[str, Any]]:
    with trace.open(encoding="utf-8", errors="replace") as lines:
        for number, line in enumerate(lines, 1):
            try:
                change = json.loads(line)
            except ValueError:
                raise ScriptError(
                    "this trace is cut or damaged, so the run cannot be compared with it",
                    where=f"{from_here(trace)}:{number}",
                    remedy="Remove it, and the script is replayed without a comparison.",
                ) from None
            if "t" in change and (repeats := repeatable_part(change)) is not None:
                yield repeats
