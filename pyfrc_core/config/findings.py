"""What is wrong with, or without effect in, a settings file: where it stands, what it is, what to do about it.

Serves pyproject.toml and ``sim/config.json`` alike. pydantic finds the mistakes; here they get the file's own
places and words.
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

#: So many findings are told of one file; a file with more has one cause for most of them.
MOST_TOLD = 20

_UNKNOWN_KEY = ("unexpected_keyword_argument", "extra_forbidden")
_NO_TABLE = ("model_type", "dict_type", "dataclass_type")
_NO_NUMBER = ("float_type", "int_type")
_NO_ARRAY = ("tuple_type", "list_type")


class SettingsWarning(UserWarning):
    """Something in a settings file that has no effect, such as a key that nobody knows; the warning's place is there.

    Its text is about the place only: Python tells that with every warning.
    """


class Document(Protocol):
    """A settings file that can tell where a value stands."""

    #: The file as the user knows it, such as ``sim/config.json``.
    name: str
    #: What the file's format calls a collection of keys and values.
    table: str

    def line_of(self, path: Path) -> int | None:
        """The line of a key or an item, from 1; of the nearest thing around it where it is not there."""

    def excerpt(self, path: Path, value: object) -> str:
        """The value as it stands in the file, shortened when it is long."""


@dataclass(frozen=True)
class Finding:
    """One sentence about one place in a settings file."""

    file: str
    #: From 1, where it is known.
    line: int | None
    message: str
    remedy: str | None = None

    @property
    def where(self) -> str:
        """``sim/config.json:7``."""
        return self.file if self.line is None else f"{self.file}:{self.line}"

    @property
    def text(self) -> str:
        """What is to be said, without its place."""
        return f"{self.message}\n  {self.remedy}" if self.remedy else self.message

    def __str__(self) -> str:
        return f"{self.where}: {self.text}"


def finding_at(document: Document, path: Path, message: str, remedy: str | None = None) -> Finding:
    return Finding(document.name, document.line_of(path), message, remedy)


def in_order(findings: Iterable[Finding]) -> list[Finding]:
    """In the order of the file."""
    return sorted(findings, key=lambda finding: finding.line or 0)


def dotted(path: Path) -> str:
    """``pyfrc.robot.start_positions[0].x``; a key that is no plain word stands in quotes and brackets."""
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
    """The text on one line that a terminal can show, with its length when that is more than what is shown."""
    start = " ".join(text[: 4 * most].split())
    start = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in start)
    if len(start) <= most and len(text) <= 4 * most:
        return start
    return f"{start[:most]}... ({len(text)} characters)"


def settings_error(findings: Sequence[Finding]) -> SettingsError:
    """All of a file's mistakes as one error, whose first line is the first of them."""
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
    """What pydantic found wrong, in the order of the file, for the user.

    :param data: what was checked
    :param prefix: where in the document `data` stands
    :param known: the keys there are in each table, by its path in `data`, for those of which others are mistakes
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
            # Of a key that may be one of several types, each says what is wrong with it.
            said = ", or ".join(dict.fromkeys(_words(error, document) for error in errors))
            remedy = _hint(errors[0])
            message = f"{dotted(whole) or 'the whole file'} = {document.excerpt(whole, errors[0]['input'])}: {said}"
        findings.append(finding_at(document, whole, message, remedy))
    told = in_order(findings)
    if len(by_path) > MOST_TOLD:
        told.append(Finding(document.name, None, f"... and {len(by_path) - MOST_TOLD} mistakes more"))
    return told


def _path_in(data: Any, error: Any) -> Path:
    """Where the error is, without pydantic's own names in its path: those that lead nowhere in the data."""
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
    """What to do, where that is certain: a number in quotes."""
    if error["type"] in _NO_NUMBER and isinstance(error["input"], str):
        number = error["input"].strip()
        if re.fullmatch(r"-?[0-9]{1,15}(\.[0-9]{1,15})?", number):
            return f"Write it without quotes: {number}"
    return None


def _words(error: Any, document: Document) -> str:
    """pydantic's message, in the words of the file's format."""
    if error["type"] in _NO_TABLE:
        return f"input should be {document.table}"
    if error["type"] in _NO_ARRAY:
        return "input should be an array"
    if error["type"] == "too_long":
        return str(error["msg"]).replace("Tuple", "input").removesuffix(f" after validation, not {len(error['input'])}")
    message = str(error["msg"]).replace("Value error, ", "")
    return message[:1].lower() + message[1:]
