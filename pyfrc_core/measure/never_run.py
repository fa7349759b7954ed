"""Functions of which no line was run: code without any test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..wording import counted


@dataclass(frozen=True)
class Unused:
    """A function of which no line was run.

    :param name: its qualified name, such as ``Arm.home``
    :param line: its first line
    :param lines: its number of statements
    """

    name: str
    line: int
    lines: int


def never_run(report: Mapping[str, Any]) -> dict[str, list[Unused]]:
    """Return the functions that were never run, by file: the files with most such lines first, in each file the longest
    functions first.

    :param report: coverage.py's JSON report
    """
    found = {
        file: sorted(
            (
                Unused(name, function.get("start_line", function["missing_lines"][0]), len(function["missing_lines"]))
                for name, function in measured["functions"].items()
                # Lines outside of functions have no name.
                if name and function["missing_lines"] and not function["executed_lines"]
            ),
            key=lambda function: (-function.lines, function.line),
        )
        for file, measured in report["files"].items()
    }
    order = sorted((file for file in found if found[file]), key=lambda file: (-_lines(found[file]), file))
    return {file: found[file] for file in order}


def summary(unused: Mapping[str, Sequence[Unused]]) -> str:
    """Return the functions that were never run as text; empty when there are none."""
    if not unused:
        return ""
    text = ["", "Functions never run, worst first:"]
    for file, functions in unused.items():
        text.append(f"{file}: {counted(len(functions), 'function')}, {counted(_lines(functions), 'line')}")
        text += [f"  {each.name} ({file}:{each.line}), {counted(each.lines, 'line')}" for each in functions]
    return "\n".join(text)


def _lines(functions: Sequence[Unused]) -> int:
    return sum(function.lines for function in functions)
