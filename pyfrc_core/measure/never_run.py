"""Functions of which no line was run: code without any test."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..wording import counted


def never_run(report: Mapping[str, Any]) -> str:
    """Return the functions that were never run as text: the files with most such lines first, in each file the longest
    functions first. Empty when there are none.

    :param report: coverage.py's JSON report
    """
    found = []
    for file, measured in report["files"].items():
        functions = sorted(
            (-len(function["missing_lines"]), function.get("start_line", function["missing_lines"][0]), name)
            for name, function in measured["functions"].items()
            # Lines outside of functions have no name.
            if name and function["missing_lines"] and not function["executed_lines"]
        )
        if functions:
            found.append((sum(lines for lines, _, _ in functions), file, functions))
    text = ["", "Functions never run, worst first:"]
    for total, file, functions in sorted(found):
        text.append(f"{file}: {counted(len(functions), 'function')}, {counted(-total, 'line')}")
        text += [f"  {name} ({file}:{start}), {counted(-lines, 'line')}" for lines, start, name in functions]
    return "\n".join(text) if found else ""
