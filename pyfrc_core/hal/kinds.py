"""What a value of `hal_data` may be: the checks on writing, and the errors that say what was expected.

Values from WPILib's own bindings raise a `TypeError` about C++ overloads; a student's test deserves the path
and the range instead, so every write passes through a `Kind` first.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import Any

from pyfrc_core.errors import PyfrcError


class UnknownKey(PyfrcError, KeyError):
    """There is no such key, or it cannot be removed or added."""


class WrongIndex(PyfrcError, IndexError):
    """A list of `hal_data` has no such entry."""


class WrongType(PyfrcError, TypeError):
    """The value is not of a type that can be stored there."""


class WrongValue(PyfrcError, ValueError):
    """The value has the right type but not a value that can be there."""


class WrongPath(PyfrcError, ValueError):
    """A text is not a path, or it leads through something that has no parts."""


class Choice(int):
    """One of a few named numbers, such as an alliance station.

    It is the number, so ``json.dumps`` and arithmetic work, and it equals WPILib's enum; it also equals its
    `name` (``hal_data['alliance_station'] == 'red1'``). It hashes as the number.
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
class Kind:
    """What a value may be.

    :param expected: completes "expected ..." in an error
    :param convert:  gives the value as stored; raises TypeError or ValueError for one that cannot be
    :param default:  what a field of this kind holds where the HAL has no such channel
    :param load:     gives the value as shown to the reader, from what WPILib returns
    :param plain:    gives the value as recorded, where that is not the value as shown
    """

    expected: str
    convert: Callable[[Any], Any]
    default: Any = None
    load: Callable[[Any], Any] | None = None
    plain: Callable[[Any], Any] | None = None

    def check(self, value: Any, where: str) -> Any:
        """The value as it is stored. Raises `WrongType` or `WrongValue`, which name `where`."""
        try:
            return self.convert(value)
        except TypeError:
            raise WrongType(f"expected {self.expected}, not {_show(value)}", where=where) from None
        except (ValueError, OverflowError):
            raise WrongValue(f"expected {self.expected}, not {_show(value)}", where=where) from None


def _show(value: Any) -> str:
    text = repr(value)
    return f"{text if len(text) <= 60 else text[:57] + '...'} ({type(value).__name__})"


def _as_float(value: Any) -> float:
    if type(value) is float:  # nearly always; asking the abstract class is slow
        return value
    # A bool is an int in Python; as a voltage or an axis it is a slip of the pen.
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


def _as_bool(value: Any) -> bool:
    # 0 and 1 are what older tests write; any other truth value ('off', []) is more likely a mistake.
    if isinstance(value, (str, bytes)) or not hasattr(value, "__bool__"):
        raise TypeError
    if value not in (0, 1):
        raise ValueError
    return bool(value)


def number(low: float | None = None, high: float | None = None) -> Kind:
    """A float; NaN and infinity are accepted only where there is no range, as sensors may report them."""
    if low is None or high is None:
        return Kind("a number", _as_float, 0.0)

    def convert(value: Any) -> float:
        result = _as_float(value)
        if not low <= result <= high:
            raise ValueError
        return result

    return Kind(f"a number from {low:g} to {high:g}", convert, 0.0)


def whole(low: int, high: int) -> Kind:
    """A whole number; a float is accepted if it is whole."""

    def convert(value: Any) -> int:
        result = _as_int(value)
        if not low <= result <= high:
            raise ValueError
        return result

    return Kind(f"a whole number from {low} to {high}", convert, 0)


def text(max_bytes: int) -> Kind:
    """A string of at most so many bytes of UTF-8: the HAL cuts longer ones silently."""

    def convert(value: Any) -> str:
        if not isinstance(value, str):
            raise TypeError
        if len(value.encode()) > max_bytes or "\0" in value:
            raise ValueError
        return value

    return Kind(f"a text of at most {max_bytes} bytes", convert, "")


def choice(names: dict[str, int], make: Callable[[int], Any] = int) -> Kind:
    """One of `names`: accepted as name in any case, number or enum; `make` gives what the HAL takes."""
    by_number = {value: Choice(value, name) for name, value in names.items()}

    def convert(value: Any) -> Any:
        if isinstance(value, str):
            if value.lower() not in lower:
                raise ValueError
            return make(lower[value.lower()])
        # The enums of the bindings are no Integral but have an index.
        chosen = _as_int(value)
        if chosen not in by_number:
            raise ValueError
        return make(chosen)

    def load(value: Any) -> Choice:
        raw = int(value)
        return by_number[raw] if raw in by_number else Choice(raw, f"unknown {raw}")  # 0 is false

    lower = {name.lower(): value for name, value in names.items()}
    expected = "one of " + ", ".join(f"{name!r} ({value})" for name, value in names.items())
    return Kind(expected, convert, 0, load=load, plain=int)


BOOL = Kind("True or False", _as_bool, False)
FLOAT = number()
INT32 = whole(-(2**31), 2**31 - 1)
INT64 = whole(-(2**63), 2**63 - 1)
ANY = Kind("anything", lambda value: value)
