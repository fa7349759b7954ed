"""Findings in a settings file: mistakes and values without effect, each with its place and a remedy.

Used for pyproject.toml and ``sim/config.json``. pydantic finds the mistakes; this module adds the lines of the file and
the words of its format.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol

from ..errors import SettingsError, nearest

if TYPE_CHECKING:
    from pydantic import ValidationError

#: The keys and indices that lead to a value, from the top of its file.
Path = tuple[str | int, ...]

#: The maximum number of findings reported for one file; if there are more, most have the same cause.
MOST_TOLD = 20

_UNKNOWN_KEY = ("unexpected_keyword_argument", "extra_forbidden")
_NO_TABLE = ("model_type", "dict_type", "dataclass_type")
_NO_NUMBER = ("float_type", "int_type")
_NO_ARRAY = ("tuple_type", "list_type")


class SettingsWarning(UserWarning):
    """A part of a settings file that has no effect, such as an unknown key.

    Its text does not name the place: Python shows the file and line of every warning.
    """


class Document(Protocol):
    """A settings file that knows the line of each value."""

    #: The file as the user knows it, such as ``sim/config.json``.
    name: str
    #: The format's term for a collection of keys and values, with an article.
    table: str

    def line_of(self, path: Path) -> int | None:
        """Return the line of a key or an item, from 1; if it is missing, the line of the nearest enclosing key."""

    def excerpt(self, path: Path, value: object) -> str:
        """Return the value as written in the file, shortened when it is long."""


@dataclass(frozen=True)
class Finding:
    """One message about one place in a settings file."""

    file: str
    #: From 1; None when unknown.
    line: int | None
    message: str
    remedy: str | None = None

    @property
    def where(self) -> str:
        """The place, such as ``sim/config.json:7``."""
        return self.file if self.line is None else f"{self.file}:{self.line}"

    @property
    def text(self) -> str:
        """The message and remedy, without the place."""
        return f"{self.message}\n  {self.remedy}" if self.remedy else self.message

    def __str__(self) -> str:
        return f"{self.where}: {self.text}"


def finding_at(document: Document, path: Path, message: str, remedy: str | None = None) -> Finding:
    return Finding(document.name, document.line_of(path), message, remedy)


def in_order(findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings sorted by line."""
    return sorted(findings, key=lambda finding: finding.line or 0)


def dotted(path: Path) -> str:
    """Return a path as text, such as ``pyfrc.robot.start_positions[0].x``; unusual keys in quotes and brackets."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        elif re.fullmatch(r"[\w$-]+", part):
            text += f".{part}"
        else:
            text += f"[{shortened(ascii(part))}]"
    return text.removeprefix(".")


def shortened(text: str, most: int = 60) -> str:
    """Return the text as one printable line, shortened to `most` characters and with its length if it is longer."""
    start = " ".join(text[: 4 * most].split())
    start = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in start)
    if len(start) <= most and len(text) <= 4 * most:
        return start
    return f"{start[:most]}... ({len(text)} characters)"


def settings_error(findings: Sequence[Finding]) -> SettingsError:
    """Return all mistakes of a file as one error, which begins with the first of them."""
    first, *others = findings
    if not others:
        return SettingsError(first.message, where=first.where, remedy=first.remedy)
    return SettingsError("\n".join([first.text, *map(str, others)]), where=first.where)


def mistakes(
    invalid: ValidationError,
    data: object,
    document: Document,
    prefix: Path = (),
    known: Mapping[Path, list[str]] = MappingProxyType({}),
) -> list[Finding]:
    """Return pydantic's errors as findings, in the order of the file.

    :param data: the data that was validated
    :param prefix: the path of `data` in the document
    :param known: the allowed keys of each table that forbids others, by its path in `data`
    """
    by_path: dict[Path, list[Any]] = {}
    for error in invalid.errors(include_url=False, include_context=False):
        by_path.setdefault(_path_in(data, error), []).append(error)
    findings = []
    for path, errors in list(by_path.items())[:MOST_TOLD]:
        whole = prefix + path
        remedy = None
        if errors[0]["type"] in _UNKNOWN_KEY:
            message = f"unknown key {dotted(whole)!r}"
            remedy = nearest(str(path[-1]), known.get(path[:-1], []))
        elif errors[0]["type"] == "missing":
            last = path[-1]
            what = f"item {last + 1}" if isinstance(last, int) else f"the key {last!r}"
            message = f"{dotted(whole[:-1])}: {what} is missing"
        else:
            # For a key with several allowed types, pydantic reports an error for each type.
            said = ", or ".join(dict.fromkeys(_words(error, document) for error in errors))
            remedy = _hint(errors[0])
            message = f"{dotted(whole) or 'the whole file'} = {document.excerpt(whole, errors[0]['input'])}: {said}"
        findings.append(finding_at(document, whole, message, remedy))
    ordered = in_order(findings)
    if len(by_path) > MOST_TOLD:
        ordered.append(Finding(document.name, None, f"... and {len(by_path) - MOST_TOLD} mistakes more"))
    return ordered


def _path_in(data: Any, error: Any) -> Path:
    """Return the path of an error in the data, without the parts that pydantic adds for its own types."""
    path: Path = ()
    for part in error["loc"]:
        if (isinstance(data, dict) and part in data) or (
            isinstance(data, list | tuple) and isinstance(part, int) and part < len(data)
        ):
            data = data[part]
        elif error["type"] != "missing" or part != error["loc"][-1]:
            continue
        path += (part,)
    return path


def _hint(error: Any) -> str | None:
    """Return the remedy for a number in quotes, and for a value that there was once; None for other errors."""
    if error["type"] == "literal_error" and error["input"] == "spawn":
        return "spawn is no longer there. Write reuse: what a run leaves behind is put back or detected after each run."
    if error["type"] in _NO_NUMBER and isinstance(error["input"], str):
        number = error["input"].strip()
        if re.fullmatch(r"-?[0-9]{1,15}(\.[0-9]{1,15})?", number):
            return f"Write it without quotes: {number}"
    return None


def _words(error: Any, document: Document) -> str:
    """Return pydantic's message in the terms of the file's format."""
    if error["type"] in _NO_TABLE:
        return f"input should be {document.table}"
    if error["type"] in _NO_ARRAY:
        return "input should be an array"
    if error["type"] == "too_long":
        return str(error["msg"]).replace("Tuple", "input").removesuffix(f" after validation, not {len(error['input'])}")
    message = str(error["msg"]).replace("Value error, ", "")
    return message[:1].lower() + message[1:]
