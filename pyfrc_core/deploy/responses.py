"""Validation of the robot's messages, field by field: a robot may be broken, or another computer may imitate it.

A dataclass says what a message has: the type of each field is what is checked. Not done with pydantic, whose import
takes longer (0.1 to 0.3 s) than all other work of a deploy before the first round trip.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from functools import cache, partial
from types import UnionType
from typing import Any, NewType, TypeVar, Union, get_args, get_origin, get_type_hints

from ..terminal_text import one_line

#: The maximum of all numbers from a robot.
_MAX_NUMBER = 1 << 53
#: The maximum number of values in a message, estimated from the brackets and commas in its JSON.
_MAX_VALUES = 150_000

#: A text from the robot as it is. All texts of the type ``str`` are lines that are safe for a terminal.
Raw = NewType("Raw", str)
T = TypeVar("T")


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


def parse(kind: type[T], message: object, **given: object) -> T:
    """Return the dataclass that a message holds. A field with a default may be missing.

    :param given: fields that are not in the message
    :raises ResponseError: if a field is missing or invalid
    """
    values = dict(given)
    types = _types_of(kind)
    for each in fields(kind):  # type: ignore[arg-type]
        key = each.metadata.get(_SENT_AS, each.name)
        is_optional = each.default is not MISSING and isinstance(message, dict) and key not in message
        if each.name not in given and not is_optional:
            values[each.name] = value_of(message, key, types[each.name])
    return kind(**values)


_SENT_AS = "sent_as"


def sent_as(key: str) -> Mapping[str, str]:
    """Return the metadata of a dataclass's field that has another name in messages."""
    return {_SENT_AS: key}


def value_of(message: object, key: str, kind: type[T]) -> T:
    """Return a field of a message.

    :raises ResponseError: if it is missing or invalid
    """
    if not isinstance(message, dict):
        raise ResponseError(f"{_shown(message)} is not an object")
    if key not in message:
        raise ResponseError(f"{key!r} is missing")
    try:
        converted: T = _converter(kind)(message[key])  # type: ignore[arg-type]
    except ResponseError as error:
        raise ResponseError(f"{key!r}: {error}") from None
    return converted


_types_of: Callable[[object], dict[str, Any]] = cache(get_type_hints)


@cache
def _converter(kind: object) -> Callable[[object], Any]:
    """Return the function that checks a value of this type, and converts it."""
    if kind in _PLAIN:
        return _PLAIN[kind]
    parts = get_args(kind)
    if get_origin(kind) in (UnionType, Union):  # with None
        convert = _converter(parts[0])
        return lambda value: None if value is None else convert(value)
    if get_origin(kind) is tuple:
        convert = _converter(parts[0])
        return lambda value: tuple(map(convert, _of_type(list, "a list", value)))
    if get_origin(kind) is dict:
        convert = _converter(parts[1])
        return lambda value: {name: convert(each) for name, each in _of_type(dict, "an object", value).items()}
    assert isinstance(kind, type)
    return partial(parse, kind)


def _of_type(kind: type[T], what: str, value: object) -> T:
    if not isinstance(value, kind) or type(value) is not kind:  # True is an int in Python, but not a number in JSON
        raise ResponseError(f"{_shown(value)} is not {what}")
    return value


def _line(value: object) -> str:
    return one_line(_of_type(str, "a text", value))


def _count(value: object) -> int:
    number = _of_type(int, "a number", value)
    if not 0 <= number <= _MAX_NUMBER:
        raise ResponseError(f"{_shown(number)} is out of range")
    return number


def _seconds(value: object) -> float:
    if not isinstance(value, (int, float)) or value is True or not 0 <= value <= _MAX_NUMBER:
        raise ResponseError(f"{_shown(value)} is not a time")
    return float(value)


def _record(value: object) -> dict[str, str]:
    """Return a JSON object, or one in a text, as lines. Files have them, which may hold anything: then it is empty."""
    if isinstance(value, str):
        try:
            value = json.loads(value)
        except (ValueError, RecursionError):
            value = None
    if not isinstance(value, dict):
        return {}
    return {one_line(key): one_line(each if isinstance(each, str) else _shown(each)) for key, each in value.items()}


_PLAIN: dict[object, Callable[[object], object]] = {
    bool: partial(_of_type, bool, "true or false"),
    int: _count,
    float: _seconds,
    str: _line,
    Raw: partial(_of_type, str, "a text"),
    Mapping[str, str]: _record,
}


def _shown(value: object) -> str:
    if isinstance(value, (dict, list)):
        return "an object" if isinstance(value, dict) else "a list"
    try:
        return one_line(json.dumps(value), 40)
    except ValueError:  # Python refuses to print integers with thousands of digits
        return "a huge number"
