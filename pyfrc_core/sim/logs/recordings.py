"""pyfrc's own files: input scripts (``sim --record``, fuzz) and traces, which are JSON lines."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

from ...runtime.scripts.modes import mode_name, selected
from ...runtime.scripts.script import FORMAT as SCRIPT
from ...runtime.scripts.script import trace_beside
from ...runtime.scripts.trace import FORMAT as TRACE
from ...runtime.scripts.trace_lines import UNREPEATABLE
from ..engine.changes import frozen
from ..engine.messages import MODE, VALUE
from ..engine.past_run import Happened, PastRun
from ..engine.value_history import ValueHistory

#: About how much memory the values of a trace may take.
MOST_BYTES = 256 << 20
#: No run is longer, in seconds.
_LATEST = 1e6
#: After how many lines the size is looked at.
_LOOKED_AT = 500


def format_of(head: bytes) -> str:
    """Return the format that a file's first line names: `SCRIPT`, `TRACE`, or an empty text."""
    try:
        first = json.loads(head.split(b"\n", 1)[0].decode("utf-8-sig"))
    except (ValueError, RecursionError):
        return ""
    named = first.get("format") if isinstance(first, dict) else None
    return named if named in (SCRIPT, TRACE) else ""


def read_recording(file: Path, name: str, kind: str) -> tuple[PastRun, str]:
    """Return the run of an input script or of a trace, and what is wrong with the file; empty: nothing.

    :param name: for people
    :param kind: what `format_of` says
    """
    trace = trace_beside(file)
    if kind == SCRIPT and trace.is_file():
        file, kind = trace, TRACE
    happened, hal, network = [], ValueHistory(), ValueHistory()
    if kind == SCRIPT:
        text = f"{name}: there is no trace beside it, so it shows inputs only; pyfrc replay runs the robot with them."
        happened.append(Happened(0.0, "warning", text))
    problem, mode, end = "", "", 0.0
    with file.open("rb") as opened:
        opened.readline()
        for number, found in enumerate(_lines(opened), 2):
            if not isinstance(found, tuple):
                problem = f"line {number} {found}"
                break
            end, values, gone = found
            hal.add(end, {path: value for path, value in values.items() if not path.startswith(VALUE)}, gone)
            now = _mode_of(hal.now)
            changed = {path: value for path, value in values.items() if path.startswith(VALUE)}
            if now != mode:
                mode = changed[MODE] = now
            if changed:
                network.add(end, changed)
            if number % _LOOKED_AT == 0 and hal.size + network.size > MOST_BYTES:
                problem = f"it is very long: its first {end:.0f} s are shown"
                break
    if problem:
        happened.append(Happened(end, "warning", f"{name}: {problem}.", is_mark=True))
    return PastRun(name, end, {"hal": hal, "network": network}, tuple(happened)), problem


def _lines(opened: IO[bytes]) -> Iterator[tuple[float, dict[str, Any], tuple[str, ...]] | str]:
    """Yield time, values and gone paths of each line; what is wrong with a line that cannot be read."""
    before = 0.0
    for line in opened:
        try:
            change = json.loads(line)
            if "sha256" in change:  # the end of a trace
                return
            time, values = float(change["t"]), {**change["set"], **change.get(UNREPEATABLE, {})}
            gone = tuple(map(str, change.get("gone", ())))
            if not before <= time <= _LATEST:
                raise ValueError
            before = time
        except (ValueError, KeyError, TypeError, RecursionError):
            yield "is cut" if not line.endswith(b"\n") else "is damaged"
            return
        yield time, {path: frozen(value) for path, value in values.items()}, gone


def _mode_of(values: Any) -> str:
    if "mode" in values:  # of a script
        return str(values["mode"])
    enabled, autonomous, test = (values.get(f"control.{name}") for name in ("enabled", "autonomous", "test"))
    return mode_name(enabled, selected(autonomous, test))
