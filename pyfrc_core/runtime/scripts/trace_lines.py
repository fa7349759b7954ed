"""The lines of a trace: JSON, one line for each packet that changed something.

pydantic_core writes them, since a trace has hundreds of megabytes an hour. It writes the shortest digits of a number,
as `json` does, though not always in the same form: 0.00001 is 1e-05 with `json`.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from typing import Any

#: The key of a line's values that do not repeat.
UNREPEATABLE = "unrepeatable"

#: What a line has before its time.
_TIME = '{"t":'


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


def line_time(line: str) -> float:
    """Return the time of a line, which is its first item, without reading the values after it."""
    return float(line[len(_TIME) : line.index(",")])


def hashed_part(line: str) -> str:
    """Return what the hash covers of a line; empty if the line has only values that do not repeat."""
    if f'"{UNREPEATABLE}"' not in line:
        return line
    change = repeatable_part(json.loads(line))
    return "" if change is None else trace_line(change["t"], change["set"], change.get("gone", ()))


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
