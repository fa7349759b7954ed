"""What the robot sends, checked field by field: it may be broken, or a computer that pretends to be a robot.

By hand and not with pydantic, whose import takes longer (0.1 to 0.3 s) than all the rest of a deploy before the first
round trip. Texts that are shown in one line are made safe for a terminal here.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, TypeVar

from ..terminal_text import one_line

#: No size or number that a robot sends is larger.
_LARGEST = 1 << 53
#: Values in an answer, counted by the brackets and commas of its JSON, also those in texts: a path may have some.
_MOST_VALUES = 150_000

Kind = TypeVar("Kind")


class AnswerError(Exception):
    """A field is missing, or is not what it should be."""


def parse_json(text: bytes) -> dict[str, Any]:
    """Return the object in an answer.

    :raises AnswerError: when it is no object in JSON, or has too many values: each takes far more memory than its text
    """
    if sum(map(text.count, (b",", b"[", b"{"))) > _MOST_VALUES:
        raise AnswerError("a frame has too many values")
    try:
        value = json.loads(text)
    except RecursionError as error:
        raise AnswerError("values are nested too deeply in a frame") from error
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise AnswerError(f"a frame is not JSON: {error}") from error
    except ValueError as error:  # Python's own message is about a setting of the interpreter
        raise AnswerError("a number in a frame has too many digits") from error
    if not isinstance(value, dict):
        raise AnswerError("a frame does not hold one JSON object")
    return value


class Fields:
    """An object that the robot has sent. Each method returns a field, or raises `AnswerError`."""

    def __init__(self, value: object, name: str = "its answer") -> None:
        if not isinstance(value, dict):
            raise AnswerError(f"{name} is {_shown(value)}, not an object")
        self._fields: dict[str, Any] = value
        self._name = name

    def __contains__(self, key: str) -> bool:
        return key in self._fields

    def text(self, key: str) -> str:
        """A text of any length, as it was sent."""
        return self._of(key, str, "a text")

    def line(self, key: str) -> str:
        """A text in one line."""
        return one_line(self.text(key))

    def line_or_none(self, key: str) -> str | None:
        """The same, or none."""
        return None if self._is_null(key) else self.line(key)

    def text_or_none(self, key: str) -> str | None:
        """A text of any length, or none."""
        return None if self._is_null(key) else self.text(key)

    def flag(self, key: str) -> bool:
        """Whether."""
        return self._of(key, bool, "true or false")

    def flag_or_none(self, key: str) -> bool | None:
        """The same, or none."""
        return None if self._is_null(key) else self.flag(key)

    def count(self, key: str) -> int:
        """A number from 0 on."""
        number = self._of(key, int, "a number")
        if not 0 <= number <= _LARGEST:
            raise AnswerError(f"{key!r} is {_shown(number)}, out of range")
        return number

    def count_or_none(self, key: str) -> int | None:
        """The same, or none."""
        return None if self._is_null(key) else self.count(key)

    def seconds(self, key: str) -> float:
        """A time from 0 on."""
        number = self._fields.get(key)
        if not isinstance(number, (int, float)) or number is True or not 0 <= number <= _LARGEST:
            raise AnswerError(f"{key!r} is {_shown(number)}, not a time")
        return float(number)

    def seconds_or_none(self, key: str) -> float | None:
        """The same, or none."""
        return None if self._is_null(key) else self.seconds(key)

    def one_of(self, key: str, known: Sequence[str]) -> str:
        """A word of those that are known."""
        word = self.text(key)
        if word not in known:
            raise AnswerError(f"{key!r} is {_shown(word)}, not one of: {', '.join(known)}")
        return word

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of texts, as they were sent."""
        values = self._of(key, list, "a list")
        if not all(isinstance(each, str) for each in values):
            raise AnswerError(f"{key!r} is not a list of texts")
        return tuple(values)

    def objects(self, key: str) -> list[Fields]:
        """A list of objects."""
        return [Fields(each, repr(key)) for each in self._of(key, list, "a list")]

    def object(self, key: str) -> Fields:
        """An object."""
        return Fields(self._of(key, dict, "an object"), repr(key))

    def record(self, key: str) -> dict[str, str]:
        """An object of texts, as a file on the robot has it: whatever it holds, in lines; empty where it is none."""
        return _record(self._fields.get(key))

    def record_in_text(self, key: str) -> dict[str, str]:
        """The same, in a text with JSON."""
        try:
            return _record(json.loads("{}" if self._is_null(key) else self.text(key) or "{}"))
        except (ValueError, RecursionError):
            return {}

    def _is_null(self, key: str) -> bool:
        return self._fields.get(key, ...) is None

    def _of(self, key: str, kind: type[Kind], what: str) -> Kind:
        if key not in self._fields:
            raise AnswerError(f"{key!r} is missing in {self._name}")
        value = self._fields[key]
        if not isinstance(value, kind) or type(value) is not kind:  # true is no number
            raise AnswerError(f"{key!r} is {_shown(value)}, not {what}")
        return value


def _record(about: object) -> dict[str, str]:
    if not isinstance(about, dict):
        return {}
    return {one_line(key): one_line(value if isinstance(value, str) else _shown(value)) for key, value in about.items()}


def _shown(value: object) -> str:
    if isinstance(value, (dict, list)):
        return "an object" if isinstance(value, dict) else "a list"
    try:
        return one_line(json.dumps(value), 40)
    except ValueError:  # Python writes no integers of thousands of digits
        return "a huge number"
