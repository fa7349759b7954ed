"""Base classes that make the live containers of `hal_data` instances of Python's `dict` and `list`.

Tests of 2019 check ``isinstance(hal_data, dict)``, and pass parts of the tree to code that accepts only a dict or a
list. The values stay in the HAL: `dict` and `list` are bases for the type check, and their own storage holds no value.
Every method that would use the storage is overridden here. Python's own C code uses these methods for a subclass:
``json.dumps``, ``dict(x)``, ``{**x}``, ``x | y``, ``x == y``, ``copy``, ``pickle``, ``list(x)``, ``x + y``. A C
extension that reads the storage itself, such as `orjson`, finds one entry with a remedy, not an empty dict.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Mapping, MutableMapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

from .kinds import WrongType

#: The only entry in a dict's own storage. `json` treats a dict without entries as empty.
_STORED = ("live", "these values are in the HAL: take a copy with dict(...) or hal_data.snapshot()")


if TYPE_CHECKING:
    # The standard library's two descriptions of a dict differ in some parameters of the same method.
    _Dict = dict[Any, Any]
    _List = list[Any]
else:

    class _Dict(MutableMapping, dict):
        """Every method of `dict`, based on the few methods of a `MutableMapping`."""

    class _List(Sequence, list):
        """The reading methods of `list`, based on the few methods of a `Sequence`."""


class LiveMapping(_Dict):
    """A dict whose entries are stored elsewhere; subclasses provide the access, as for a `MutableMapping`."""

    def __init__(self) -> None:
        dict.__setitem__(self, *_STORED)

    def copy(self) -> dict[Any, Any]:
        """Return a dict of the current values. Containers in it are live."""
        return {key: self[key] for key in self}

    @classmethod
    def fromkeys(cls, iterable: Iterable[object], value: object = None) -> dict[Any, Any]:
        """Return an ordinary dict, like `dict.fromkeys`."""
        return dict.fromkeys(iterable, value)

    def __reversed__(self) -> Iterator[Any]:
        yield from reversed(list(self))

    def __or__(self, other: Any) -> Any:
        return self.copy() | _values_of(other) if isinstance(other, Mapping) else NotImplemented

    def __ror__(self, other: object) -> Any:
        return _values_of(other) | self.copy() if isinstance(other, Mapping) else NotImplemented

    def __ior__(self, other: Any) -> Any:
        self.update(other)
        return self

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Mapping) and self.copy() == _values_of(other))

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = None

    def __copy__(self) -> dict[Any, Any]:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, object]) -> dict[Any, Any]:
        return copy.deepcopy(self.copy(), memo)

    def __reduce_ex__(self, protocol: object) -> tuple[Any, ...]:
        return dict, (self.copy(),)


class LiveSequence(_List):
    """A list of fixed length whose entries are stored elsewhere; subclasses provide the access, as for a `Sequence`."""

    def __init__(self, path: str) -> None:
        self._path = path

    def copy(self) -> list[Any]:
        """Return a list of the current values. Containers in it are live."""
        return list(self)

    def _fixed(self, *_: object, **__: object) -> NoReturn:
        problem, remedy = "the list has a fixed length and order", "write its entries, or copy it with list(...)"
        raise WrongType(problem, where=self._path, remedy=remedy)

    append = extend = insert = pop = remove = clear = sort = reverse = _fixed
    __delitem__ = __iadd__ = __imul__ = _fixed

    def __add__(self, other: object) -> Any:
        return list(self) + list(other) if isinstance(other, list) else NotImplemented

    def __radd__(self, other: object) -> Any:
        return list(other) + list(self) if isinstance(other, list) else NotImplemented

    def __mul__(self, times: Any) -> Any:
        return list(self) * times

    __rmul__ = __mul__

    def __eq__(self, other: object) -> bool:
        if isinstance(other, (list, tuple)):
            return self is other or list(self) == list(other)
        return NotImplemented

    def __ne__(self, other: object) -> bool:
        return not self == other

    def __lt__(self, other: object) -> Any:
        return list(self) < list(other) if isinstance(other, list) else NotImplemented

    def __le__(self, other: object) -> Any:
        return list(self) <= list(other) if isinstance(other, list) else NotImplemented

    def __gt__(self, other: object) -> Any:
        return list(self) > list(other) if isinstance(other, list) else NotImplemented

    def __ge__(self, other: object) -> Any:
        return list(self) >= list(other) if isinstance(other, list) else NotImplemented

    __hash__ = None

    def __copy__(self) -> list[Any]:
        return list(self)

    def __deepcopy__(self, memo: dict[int, object]) -> list[Any]:
        return copy.deepcopy(list(self), memo)

    def __reduce_ex__(self, protocol: object) -> tuple[Any, ...]:
        return list, (list(self),)


def _values_of(mapping: Mapping[object, object]) -> dict[Any, Any]:
    return {key: mapping[key] for key in mapping}
