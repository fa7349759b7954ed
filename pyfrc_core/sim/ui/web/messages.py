"""JSON to and from pages.

Numbers that are not finite, which JSON does not have, are objects such as ``{"$": "NaN"}``. Whatever a page sends
becomes a checked `Message`, or a `CommandError` for the person at the page.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from typing import Any, NoReturn

#: How deep lists and objects may be in each other, and how long a number may be, in characters.
_MOST_DEPTH, _MOST_DIGITS = 40, 32
#: How much of a wrong value an error shows, in characters.
_MOST_SHOWN = 60
#: The most paths that a page may ask for at once: all curves of twenty full plots. It may show many more.
_MOST_PATHS, _MOST_SHOWN_PATHS = 256, 20_000
#: The latest and the earliest moment that a page may name, in seconds: thirty years.
_LATEST = 1e9


class CommandError(Exception):
    """A command is impossible; the text is for the person."""


class Message:
    """One message of a page: an object with finite numbers and whole texts.

    :param values: its content, which was checked
    """

    def __init__(self, values: dict[str, Any]) -> None:
        self._values = values
        number = values.get("id")
        #: By which the page knows the answer; None: it wants none.
        self.id = number if isinstance(number, (int, str)) and len(str(number)) <= _MOST_DIGITS else None

    def __contains__(self, key: str) -> bool:
        """Return whether the message says something for a key; null says nothing."""
        return self._values.get(key) is not None

    def raw(self, key: str) -> Any:
        """Return whatever the message has for a key; None for nothing."""
        return self._values.get(key)

    def text(self, key: str) -> str:
        value = self._values.get(key)
        return value if isinstance(value, str) else _refuse(key, "a text is needed", value)

    def one_of(self, key: str, names: tuple[str, ...]) -> Any:
        value = self.text(key)
        return value if value in names else _refuse(key, f"one of {', '.join(names)} is needed", value)

    def boolean(self, key: str) -> bool:
        value = self._values.get(key)
        return value if isinstance(value, bool) else _refuse(key, "true or false is needed", value)

    def number(self, key: str, low: float, high: float, default: float | None = None) -> float:
        value = self._values.get(key, default)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            _refuse(key, "a number is needed", value)
        return value if low <= value <= high else _refuse(key, f"from {low:g} to {high:g}", value)

    def integer(self, key: str, low: int, high: int, default: int | None = None) -> int:
        value = self.number(key, low, high, default)
        return int(value) if value == int(value) else _refuse(key, "a whole number is needed", value)

    def time(self, key: str) -> float:
        """Return a moment, in seconds of robot time; plots begin before 0."""
        return float(self.number(key, -_LATEST, _LATEST))

    def branch(self) -> int | None:
        """Return the number of a branch; None: the present run."""
        return self.integer("branch", 0, 1 << 31) if "branch" in self else None

    def paths(self) -> list[str]:
        return self.texts("paths", _MOST_PATHS)

    def texts(self, key: str, most: int = _MOST_SHOWN_PATHS) -> list[str]:
        value = self._values.get(key)
        if not isinstance(value, list) or len(value) > most or not all(isinstance(each, str) for each in value):
            _refuse(key, f"a list of at most {most} texts is needed", value)
        return list(value)


def read_message(text: str) -> Message:
    """Return a message.

    :raises CommandError: when it is none, whatever it is
    """
    try:
        values = json.loads(text, parse_int=_integer, parse_float=_float, parse_constant=_no_number)
    except RecursionError:
        raise CommandError("a message has lists in lists without end") from None
    except ValueError as wrong:
        raise CommandError(f"a message is one JSON object: {str(wrong)[:_MOST_SHOWN]}") from None
    if not isinstance(values, dict):
        raise CommandError("a message is one JSON object")
    for text in _texts_in(values):
        if any("\ud800" <= letter <= "\udfff" for letter in text):
            raise CommandError("a message has half of a letter in a text")
    return Message(values)


def _texts_in(values: object) -> Iterator[str]:
    """Yield all texts, keys included, and check how deep they are."""
    level: list[Any] = [values]
    for _ in range(_MOST_DEPTH):
        deeper: list[Any] = []
        for each in level:
            if isinstance(each, str):
                yield each
            elif isinstance(each, dict):
                yield from each
                deeper += each.values()
            elif isinstance(each, list):
                deeper += each
        if not deeper:
            return
        level = deeper
    raise CommandError(f"a message has more than {_MOST_DEPTH} lists and objects in each other")


def _integer(digits: str) -> int:
    return int(digits) if len(digits) <= _MOST_DIGITS else _no_number(digits)


def _float(digits: str) -> float:
    value = float(digits)
    return value if math.isfinite(value) else _no_number(digits)


def _no_number(digits: str) -> NoReturn:
    raise ValueError(f"{digits[:_MOST_DIGITS]} is too large")


def _refuse(key: str, wanted: str, value: object) -> NoReturn:
    shown = repr(value)
    raise CommandError(f"{key}: {wanted}, not {shown if len(shown) <= _MOST_SHOWN else shown[:_MOST_SHOWN] + '…'}")


def json_text(message: object) -> str:
    """Return a message as JSON."""
    try:
        return json.dumps(message, allow_nan=False, separators=(",", ":"), default=_plain)
    except ValueError:  # rare, so most messages are not looked through
        return json.dumps(_safe(message), allow_nan=False, separators=(",", ":"), default=str)


def _plain(value: object) -> object:
    return dict(value) if isinstance(value, Mapping) else str(value)


def _safe(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return {"$": "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"}
    if isinstance(value, Mapping):
        return {str(key): _safe(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_safe(each) for each in value]
    return value


def read_value(value: Any) -> Any:
    """Return a value that a page has sent, with numbers that are not finite."""
    if isinstance(value, dict):
        if value.keys() == {"$"}:
            return {"NaN": math.nan, "Infinity": math.inf, "-Infinity": -math.inf}.get(value["$"], value)
        return {key: read_value(each) for key, each in value.items()}
    return [read_value(each) for each in value] if isinstance(value, list) else value
