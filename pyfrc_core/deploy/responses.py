"""Validation of the robot's messages, field by field: a robot may be broken, or another computer may imitate it.

Not done with pydantic, whose import takes longer (0.1 to 0.3 s) than all other work of a deploy before the first round
trip. Texts for display in one line are made safe for a terminal here.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, TypeVar

from ..terminal_text import one_line

#: The maximum of all numbers from a robot.
_MAX_NUMBER = 1 << 53
#: The maximum number of values in a message, estimated from the brackets and commas in its JSON.
_MAX_VALUES = 150_000

Kind = TypeVar("Kind")


class ResponseError(Exception):
    """A field is missing or invalid."""


def parse_json(text: bytes) -> dict[str, Any]:
    """Return the JSON object in a message.

    :raises ResponseError: if it is not a JSON object, or has too many values, which need far more memory than their
        text
    """
    if sum(map(text.count, (b",", b"[", b"{"))) > _MAX_VALUES:
        raise ResponseError("a frame has too many values")
    try:
        value = json.loads(text)
    except RecursionError as error:
        raise ResponseError("values are nested too deeply in a frame") from error
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise ResponseError(f"a frame is not JSON: {error}") from error
    except ValueError as error:  # Python's message refers to a setting of the interpreter
        raise ResponseError("a number in a frame has too many digits") from error
    if not isinstance(value, dict):
        raise ResponseError("a frame does not hold one JSON object")
    return value


class Fields:
    """An object from the robot. Each method returns a field, or raises `ResponseError` if it is missing or invalid."""

    def __init__(self, value: object, name: str = "its response") -> None:
        if not isinstance(value, dict):
            raise ResponseError(f"{name} is {_shown(value)}, not an object")
        self._fields: dict[str, Any] = value
        self._name = name

    def __contains__(self, key: str) -> bool:
        return key in self._fields

    def text(self, key: str) -> str:
        """Return a text unchanged."""
        return self._of(key, str, "a text")

    def line(self, key: str) -> str:
        """Return a text as one line that is safe for a terminal."""
        return one_line(self.text(key))

    def line_or_none(self, key: str) -> str | None:
        """Return a text as one line, or None."""
        return None if self._is_null(key) else self.line(key)

    def text_or_none(self, key: str) -> str | None:
        """Return a text unchanged, or None."""
        return None if self._is_null(key) else self.text(key)

    def flag(self, key: str) -> bool:
        """Return a Boolean."""
        return self._of(key, bool, "true or false")

    def flag_or_none(self, key: str) -> bool | None:
        """Return a Boolean, or None."""
        return None if self._is_null(key) else self.flag(key)

    def count(self, key: str) -> int:
        """Return an integer that is not negative."""
        number = self._of(key, int, "a number")
        if not 0 <= number <= _MAX_NUMBER:
            raise ResponseError(f"{key!r} is {_shown(number)}, out of range")
        return number

    def count_or_none(self, key: str) -> int | None:
        """Return an integer that is not negative, or None."""
        return None if self._is_null(key) else self.count(key)

    def seconds(self, key: str) -> float:
        """Return a time in seconds that is not negative."""
        number = self._fields.get(key)
        if not isinstance(number, (int, float)) or number is True or not 0 <= number <= _MAX_NUMBER:
            raise ResponseError(f"{key!r} is {_shown(number)}, not a time")
        return float(number)

    def seconds_or_none(self, key: str) -> float | None:
        """Return a time in seconds that is not negative, or None."""
        return None if self._is_null(key) else self.seconds(key)

    def one_of(self, key: str, known: Sequence[str]) -> str:
        """Return a text that is one of `known`."""
        word = self.text(key)
        if word not in known:
            raise ResponseError(f"{key!r} is {_shown(word)}, not one of: {', '.join(known)}")
        return word

    def texts(self, key: str) -> tuple[str, ...]:
        """Return a list of texts, unchanged."""
        values = self._of(key, list, "a list")
        if not all(isinstance(each, str) for each in values):
            raise ResponseError(f"{key!r} is not a list of texts")
        return tuple(values)

    def texts_or_none(self, key: str) -> dict[str, str | None]:
        """Return an object with a text or None for each name, unchanged."""
        values = self.object(key)
        return {name: values.text_or_none(name) for name in values._fields}

    def objects(self, key: str) -> list[Fields]:
        """Return a list of objects."""
        return [Fields(each, repr(key)) for each in self._of(key, list, "a list")]

    def object(self, key: str) -> Fields:
        """Return an object."""
        return Fields(self._of(key, dict, "an object"), repr(key))

    def record(self, key: str) -> dict[str, str]:
        """Return an object's fields as lines that are safe for a terminal; empty if it is not an object."""
        return _record(self._fields.get(key))

    def record_in_text(self, key: str) -> dict[str, str]:
        """Return the same for a text that contains JSON."""
        try:
            return _record(json.loads("{}" if self._is_null(key) else self.text(key) or "{}"))
        except (ValueError, RecursionError):
            return {}

    def _is_null(self, key: str) -> bool:
        return self._fields.get(key, ...) is None

    def _of(self, key: str, kind: type[Kind], what: str) -> Kind:
        if key not in self._fields:
            raise ResponseError(f"{key!r} is missing in {self._name}")
        value = self._fields[key]
        if not isinstance(value, kind) or type(value) is not kind:  # True is an int in Python, but not a number in JSON
            raise ResponseError(f"{key!r} is {_shown(value)}, not {what}")
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
    except ValueError:  # Python refuses to print integers with thousands of digits
        return "a huge number"
