"""What changed in one packet, and its line in a trace, which is JSON.

pydantic_core writes them, since a trace has hundreds of megabytes an hour. It writes the shortest digits of a number,
as `json` does, though not always in the same form: 0.00001 is 1e-05 with `json`.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

#: The key of a line's values that do not repeat.
UNREPEATABLE = "unrepeatable"


@dataclass(frozen=True)
class Change:
    """What changed in one packet.

    :param time: robot time, in seconds
    :param values: the new values by their paths, as in `Snapshot.values`
    :param gone: the paths that no longer exist
    :param unrepeatable: the paths of those values that do not repeat exactly in another run
    """

    time: float
    values: Mapping[str, Any]
    gone: tuple[str, ...] = ()
    unrepeatable: frozenset[str] = frozenset()


def lines_of(change: Change) -> tuple[str, str]:
    """Return what the hash of a trace covers of a change, empty for values that do not repeat; and its whole line."""
    if not change.unrepeatable:
        line = trace_line(change.time, change.values, change.gone)
        return line, line
    marked = {path: value for path, value in change.values.items() if path in change.unrepeatable}
    others = {path: value for path, value in change.values.items() if path not in marked}
    line = trace_line(change.time, others, change.gone)
    return line if others or change.gone else "", with_unrepeatable(line, marked)


def trace_line(now: float, changed: Mapping[str, object], gone: Collection[str] = ()) -> str:
    """Return the line of one packet.

    :param now: the robot time in seconds, rounded
    :param changed: the values by path; they consist of what JSON has
    :param gone: the paths that no longer exist
    """
    line: dict[str, object] = {"t": now, "set": changed}
    if gone:
        line["gone"] = gone
    return _to_json(line)


def with_unrepeatable(line: str, marked: Mapping[str, object]) -> str:
    """Return a line with values that do not repeat, by path."""
    return f'{line[:-1]},"{UNREPEATABLE}":{_to_json(marked)}}}'


def repeatable_part(change: dict[str, object]) -> dict[str, Any] | None:
    """Return a line's object without the values that do not repeat; None if it has nothing else."""
    change = {key: value for key, value in change.items() if key != UNREPEATABLE}
    return change if change["set"] or "gone" in change else None


def _to_json(content: Mapping[str, object]) -> str:
    from pydantic_core import to_json  # only here: most commands trace nothing

    try:
        return to_json(content, inf_nan_mode="constants").decode()
    except ValueError:  # half of a surrogate pair, which UTF-8 lacks
        return json.dumps(content, separators=(",", ":"))
