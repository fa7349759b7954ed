"""The form of an input script: JSON lines, first a header, then what is written and when.

    {"format": "pyfrc-input 1", "robot": "robot.py", "end": 16.0, ...}
    {"t": 1.0, "set": {"mode": "teleop"}}
    {"t": 1.5, "set": {"joysticks[0].axes[1]": -1.0, "dio[3].value": false}}

What can be written is in `targets`. Times are seconds of robot time; what is written at 1.5 is there when the packet of
1.5 s arrives. The robot is ended at `end`, before what would happen then.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ...errors import UsageError
from ...season import year_of
from ...text_files import write_whole
from ...wording import from_here
from ..robot_time import to_us

FORMAT = "pyfrc-input 1"
_TRACE = ".trace.jsonl"

#: Longer files are no input scripts; a match that mashes everything at each packet takes a tenth of this.
_MOST_BYTES = 64 * 1024 * 1024
#: No robot runs for longer than a day.
_LONGEST = 86_400.0


def trace_beside(script: Path) -> Path:
    """Return the file of a recording's trace, which lies beside the script."""
    return script.with_name(f"{script.stem}{_TRACE}")


def script_beside(trace: Path) -> Path | None:
    """Return the file of the script that lies beside a trace; None: by its name, the file is no trace."""
    return trace.with_name(f"{trace.name.removesuffix(_TRACE)}.jsonl") if trace.name.endswith(_TRACE) else None


class ScriptError(UsageError):
    """An input script is not what it must be, or does not fit the robot; `where` names its line."""


@dataclass(frozen=True)
class Step:
    """What is written at one moment, in this order.

    :param at_us: when, in microseconds of robot time
    :param writes: values by target, such as ``"dio[3].value"`` or ``"mode"``
    :param line: the line of the file, for errors
    """

    at_us: int
    writes: Mapping[str, Any]
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class InputScript:
    """The inputs of a robot in one run.

    :param steps: in the order of their times
    :param end_us: when the run ends
    :param start_us: when the robot is started; steps until then are written before
    :param robot: the file of the robot program
    :param seed: the seed of random generators
    :param packages: the versions of the packages with which it was recorded
    :param trace: the hash of the robot's trace at the time of the recording
    :param story: a description of what happens, in scripts that fuzzing has saved; a replay of these checks for all
        failures that fuzzing checks for
    :param repeats: False if fuzzing has saved it although the robot did not fail again with it
    :param found: in scripts that fuzzing has saved: in which match of which campaign it was found, and its failure
    :param file: where it was read from, for errors
    :param problem: how that file is damaged, as a sentence; empty: it is whole
    :param year: the year of the WPILib with which it was recorded, if that is known
    :param lacks: of a log, what inputs it does not have, such as ``no joysticks``, each after since when, in seconds
    """

    steps: tuple[Step, ...]
    end_us: int
    start_us: int = 0
    robot: str = ""
    seed: int = 0
    packages: Mapping[str, str] = field(default_factory=dict)
    trace: str | None = None
    story: tuple[str, ...] = ()
    repeats: bool = True
    found: Mapping[str, Any] = field(default_factory=dict)
    file: str = field(default="script", compare=False)
    problem: str = field(default="", compare=False)
    year: int | None = field(default=None, compare=False)
    lacks: tuple[tuple[float, str], ...] = field(default=(), compare=False)

    def lines(self) -> Iterator[str]:
        """The text, line by line."""
        header: dict[str, Any] = {"format": FORMAT, "robot": self.robot, "seed": self.seed}
        if self.start_us:
            header["start"] = self.start_us / 1_000_000
        header |= {"end": self.end_us / 1_000_000, "packages": dict(self.packages)}
        if self.trace is not None:
            header["trace"] = self.trace
        if self.story:
            header["story"] = list(self.story)
        if not self.repeats:
            header["repeats"] = False
        if self.found:
            header["found"] = dict(self.found)
        yield json.dumps(header, ensure_ascii=False)
        for step in self.steps:
            yield json.dumps({"t": step.at_us / 1_000_000, "set": dict(step.writes)}, ensure_ascii=False)

    def with_found(self, name: str, value: Any) -> InputScript:
        """Return this script with one more of what `found` says, or without it if there is none."""
        return replace(self, found={**self.found, name: value}) if value else self

    def save(self, file: Path) -> None:
        """Write it to `file`."""
        write_whole(file, (f"{line}\n" for line in self.lines()))


def load_script(file: Path) -> InputScript:
    """Read an input script.

    :raises ScriptError: naming the line and what is wrong with it
    """
    name = from_here(file)
    try:
        size = file.stat().st_size
        if size > _MOST_BYTES:
            raise ScriptError(
                f"{size // 2**20} MB are too many for an input script: at most {_MOST_BYTES // 2**20} MB",
                where=f"{name}:1",
            )
        with file.open(encoding="utf-8-sig") as lines:
            return parse_script(lines, name)
    except IsADirectoryError:
        raise ScriptError("this is a directory, not an input script", where=name) from None
    except FileNotFoundError:
        raise ScriptError(f"there is no file {file}") from None
    except UnicodeDecodeError as malformed:
        raise ScriptError(f"not UTF-8 text: {malformed}", where=name) from None


def parse_script(lines: Iterable[str], name: str = "script") -> InputScript:
    """An input script from its lines.

    :raises ScriptError: naming the line and what is wrong with it
    """
    numbered = ((number, line) for number, line in enumerate(lines, 1) if line.strip())
    try:
        number, first = next(numbered)
    except StopIteration:
        raise ScriptError("the file is empty: its first line must be the header", where=f"{name}:1") from None
    header = _Line(first, f"{name}:{number}")
    version = header.value.get("format")
    if version != FORMAT:
        raise ScriptError(
            f"unknown format {version!r}: this pyfrc reads {FORMAT!r}"
            if version is not None
            else f'the first line must be the header, with "format": "{FORMAT}"',
            where=header.where,
        )
    start, end = header.time("start", 0.0), header.time("end")
    if end < start:
        raise ScriptError('"end" comes before "start"', where=header.where)
    packages = header.of_type("packages", dict, "an object of versions", {})
    steps = []
    before = 0
    for number, text in numbered:
        line = _Line(text, f"{name}:{number}")
        at = line.time("t")
        if at < before:
            raise ScriptError(f"time goes back from {before / 1e6:g} s to {at / 1e6:g} s", where=line.where)
        if at > end:
            raise ScriptError(
                f"{at / 1e6:g} s is after the end of the script, at {end / 1e6:g} s: this would not be played",
                where=line.where,
                remedy='Change "end" in the first line',
            )
        before = at
        steps.append(Step(at, line.of_type("set", dict, "an object of what is written", None), number))
    return InputScript(
        tuple(steps),
        end,
        start,
        header.of_type("robot", str, "text", ""),
        header.of_type("seed", int, "a whole number", 0),
        packages,
        header.of_type("trace", str, "text", ""),
        header.texts("story"),
        header.flag("repeats", True),
        header.of_type("found", dict, "an object", {}),
        name,
        year=year_of(str(packages.get("wpilib", ""))),
    )


class _Line:
    """One line's JSON object, with errors that name the line."""

    def __init__(self, text: str, where: str) -> None:
        self.where = where
        try:
            value = json.loads(text, parse_constant=self._no_number)
        except json.JSONDecodeError as malformed:
            message = f"not valid JSON: {malformed.msg} (column {malformed.colno})"
            if not text.endswith("\n"):
                message += "; is the file cut off here?"
            raise ScriptError(message, where=where) from None
        except (RecursionError, ValueError) as malformed:  # too deep; a number of too many digits
            raise ScriptError(f"not an input script: {malformed}", where=where) from None
        if not isinstance(value, dict):
            raise ScriptError("each line must be a JSON object", where=where)
        self.value: dict[str, Any] = value

    def _no_number(self, name: str) -> float:
        raise ScriptError(f"{name} is no number that can be written", where=self.where)

    def of_type(self, key: str, kind: type, what: str, default: object) -> Any:
        value = self.value.get(key, default)
        if not isinstance(value, kind) or isinstance(value, bool):
            raise ScriptError(
                f'"{key}" must be {what}, not {_short(value)}' if key in self.value else f'"{key}" is missing: {what}',
                where=self.where,
            )
        return value

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of texts, which may be missing."""
        found = self.of_type(key, list, "a list of texts", [])
        if not all(isinstance(each, str) for each in found):
            raise ScriptError(f'"{key}" must be a list of texts', where=self.where)
        return tuple(found)

    def flag(self, key: str, default: bool) -> bool:
        """Return true or false."""
        value = self.value.get(key, default)
        if not isinstance(value, bool):
            raise ScriptError(f'"{key}" must be true or false, not {_short(value)}', where=self.where)
        return value

    def time(self, key: str, default: float | None = None) -> int:
        """A time in seconds, as microseconds."""
        value = self.value.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            message = (
                f'"{key}" must be a time in seconds, not {_short(value)}'
                if key in self.value
                else f'"{key}" is missing'
            )
            raise ScriptError(message, where=self.where)
        if not 0 <= value <= _LONGEST:
            raise ScriptError(f'"{key}" must be from 0 to {_LONGEST:g} s, not {value:g}', where=self.where)
        return to_us(value)


def _short(value: object) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
