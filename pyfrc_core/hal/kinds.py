"""The kinds of values in `hal_data`: checks of writes, with errors that state the expected value.

WPILib's bindings raise a `TypeError` about C++ overloads. Students need the path and the range instead, so every write
is checked by a `ValueKind` first.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import Any

from pyfrc_core.errors import PyfrcError


class UnknownKey(PyfrcError, KeyError):
    """There is no such key, or keys cannot be added or removed."""


class WrongIndex(PyfrcError, IndexError):
    """A list of `hal_data` has no such entry."""


class WrongType(PyfrcError, TypeError):
    """The value has a type that cannot be stored there."""


class WrongValue(PyfrcError, ValueError):
    """The value has the right type, but is not allowed there."""


class WrongPath(PyfrcError, ValueError):
    """A text is not a path, or it leads through a value without parts."""


class Choice(int):
    """One of a few named numbers, such as an alliance station.

    It is an int, so ``json.dumps`` and arithmetic work, and it equals WPILib's enum. It also equals its `name`
    (``hal_data['alliance_station'] == 'red1'``). It hashes as the number.
    """

    name: str

    def __new__(cls, number: int, name: str) -> Choice:
        self = super().__new__(cls, number)
        self.name = name
        return self

    def __eq__(self, other: object) -> bool:
        return self.name == other if isinstance(other, str) else int.__eq__(self, other)

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = int.__hash__

    def __reduce__(self) -> tuple[type[Choice], tuple[int, str]]:
        return Choice, (int(self), self.name)

    def __repr__(self) -> str:
        return f"<{self.name}: {int(self)}>"

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True)
class ValueKind:
    """A kind of values.

    :param expected: completes "expected ..." in an error
    :param convert: returns the value to store; raises TypeError or ValueError for an invalid one
    :param default: the value of a field of this kind where the HAL has no such channel
    :param load: returns the value to show, from WPILib's value
    :param plain: returns the value to record, from WPILib's value, where that differs from the value to show
    :param max_bytes: the length of the longest text, for a kind of texts
    """

    expected: str
    convert: Callable[[Any], Any]
    default: Any = None
    load: Callable[[Any], Any] | None = None
    plain: Callable[[Any], Any] | None = None
    max_bytes: int = 0

    def check(self, value: object, where: str) -> Any:
        """Return the value to store.

        :raises WrongType: when it has the wrong type; names `where`
        :raises WrongValue: when it is not allowed; names `where`
        """
        try:
            return self.convert(value)
        except TypeError:
            raise WrongType(f"expected {self.expected}, not {_show(value)}", where=where) from None
        except (ValueError, OverflowError):
            raise WrongValue(f"expected {self.expected}, not {_show(value)}", where=where) from None


def _show(value: object) -> str:
    text = repr(value)
    return f"{text if len(text) <= 60 else text[:57] + '...'} ({type(value).__name__})"


def _as_float(value: object) -> float:
    if type(value) is float:  # nearly always; a check with the abstract class is slow
        return value
    # A bool is an int in Python; as a voltage or an axis it is a mistake.
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError
    return float(value)


def _as_int(value: Any) -> int:
    if isinstance(value, bool):
        raise TypeError
    if isinstance(value, Real) and not hasattr(value, "__index__"):
        number = float(value)
        if not number.is_integer():
            raise ValueError
        return int(number)
    return operator.index(value)


def _as_bool(value: object) -> bool:
    # Older tests write 0 and 1; any other truth value ('off', []) is probably a mistake.
    if isinstance(value, (str, bytes)) or not hasattr(value, "__bool__"):
        raise TypeError
    if value not in (0, 1):
        raise ValueError
    return bool(value)


def number(low: float | None = None, high: float | None = None) -> ValueKind:
    """Return the kind of floats; NaN and infinity are allowed only without a range, since sensors may report them."""
    if low is None or high is None:
        return ValueKind("a number", _as_float, 0.0)

    def convert(value: object) -> float:
        result = _as_float(value)
        if not low <= result <= high:
            raise ValueError
        return result

    return ValueKind(f"a number from {low:g} to {high:g}", convert, 0.0)


def whole(low: int, high: int) -> ValueKind:
    """Return the kind of whole numbers; a float is accepted if it is whole."""

    def convert(value: object) -> int:
        result = _as_int(value)
        if not low <= result <= high:
            raise ValueError
        return result

    return ValueKind(f"a whole number from {low} to {high}", convert, 0)


def text(max_bytes: int) -> ValueKind:
    """Return the kind of strings with at most this many bytes of UTF-8: the HAL silently cuts longer ones."""

    def convert(value: object) -> str:
        if not isinstance(value, str):
            raise TypeError
        if len(value.encode()) > max_bytes or "\0" in value:
            raise ValueError
        return value

    return ValueKind(f"a text of at most {max_bytes} bytes", convert, "", max_bytes=max_bytes)


def choice(names: dict[str, int], make: Callable[[int], Any] = int) -> ValueKind:
    """Return the kind of the values in `names`.

    :param names: the number of each name; names (in any case), numbers and enums are accepted
    :param make: returns the value for the HAL
    """
    by_number = {value: Choice(value, name) for name, value in names.items()}

    def convert(value: object) -> Any:
        if isinstance(value, str):
            if value.lower() not in lower:
                raise ValueError
            return make(lower[value.lower()])
        # The enums of the bindings are not Integral, but have an index.
        chosen = _as_int(value)
        if chosen not in by_number:
            raise ValueError
        return make(chosen)

    def load(value: Any) -> Choice:
        raw = int(value)
        return by_number[raw] if raw in by_number else Choice(raw, f"unknown {raw}")  # 0 is false

    lower = {name.lower(): value for name, value in names.items()}
    expected = "one of " + ", ".join(f"{name!r} ({value})" for name, value in names.items())
    return ValueKind(expected, convert, 0, load=load, plain=int)


BOOL = ValueKind("True or False", _as_bool, False)
FLOAT = number()
INT32 = whole(-(2**31), 2**31 - 1)
INT64 = whole(-(2**63), 2**63 - 1)
ANY = ValueKind("anything", lambda value: value)
