"""The dicts and lists of `hal_data`: they contain functions to read and write, never the values.

`builtin_types` provides the behaviour of `dict` and `list`. This module adds speed (a read is one dict look-up and one
bound method of WPILib), errors that name the place, and listeners.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from numbers import Integral, Real
from typing import Any, NamedTuple

from pyfrc_core.errors import nearest

from .builtin_types import LiveMapping, LiveSequence
from .kinds import ANY, UnknownKey, ValueKind, WrongIndex, WrongType, WrongValue
from .paths import join

Callback = Callable[[Any, Any], object]


class Slot(NamedTuple):
    """Access to one value.

    :param get: reads the value
    :param set: writes the value; None for a read-only value
    :param kind: the check of values that are written
    :param watch: makes the HAL call a function on each change; returns an object that must be kept for as long
    :param canonical: the key whose listeners are also called; differs from the key for an alias of a value
    :param recorded: whether the value cannot be derived from other fields
    :param remedy: the advice in the error when the value cannot be written
    :param unset: the value to write for None, at an output of the robot; None where None cannot be written
    :param plain: reads the value as recordings have it, where `get` returns another form of it
    """

    get: Callable[[], Any]
    set: Callable[[Any], object] | None
    kind: ValueKind = ANY
    watch: Callable[[Callable[[], None]], object] | None = None
    canonical: str = ""
    recorded: bool = True
    remedy: str | None = None
    unset: Any = None
    plain: Callable[[], Any] | None = None


#: The number that stands for None in the HAL: robots never set it, and it acts like 0.
NOT_SET = 5e-324


def _get_unless_unset(slot: Slot) -> Any:
    value = slot.get()
    return None if value == NOT_SET else value


def stored(default: Any = None) -> Slot:
    """Return a slot for a value that the current HAL does not have. It is stored as written, so that older tests still
    work.
    """
    cell = [default]
    return Slot(partial(cell.__getitem__, 0), partial(cell.__setitem__, 0), recorded=False)


class _Watch:
    """The listeners of one value, and its callback in the HAL."""

    def __init__(self, owner: LiveDict, slot: Slot) -> None:
        self.owner = owner
        self.listeners: list[tuple[Any, Callback]] = []
        self.called = False
        self.store = slot.watch(self.fire) if slot.watch else None

    def fire(self) -> None:
        self.called = True
        for key, callback in list(self.listeners):
            callback(key, self.owner[key])


class LiveDict(LiveMapping):
    """A dict whose values are stored in the simulated HAL.

    Reads and writes go to WPILib. A wrong key raises a `KeyError` that lists the keys; an impossible value raises a
    `TypeError` or `ValueError` that names the place. Keys cannot be added or removed.
    """

    def __init__(self, path: str, build: Callable[[], Mapping[str, Slot]]) -> None:
        super().__init__()
        self._path = path
        self._build = build
        self._built: Mapping[str, Slot] | None = None
        self._getters: dict[Any, Callable[[], Any]] = {}
        self._watches: dict[str, _Watch] = {}

    # Built on first use: the tree has some two thousand values, and a test uses ten.
    @property
    def _slots(self) -> Mapping[str, Slot]:
        if self._built is None:
            self._built = self._build()
        return self._built

    def _slot(self, key: Any) -> Slot:
        try:
            return self._slots[key]
        except (KeyError, TypeError):
            raise self._unknown(key) from None

    def _unknown(self, key: Any, remedy: str | None = None) -> UnknownKey:
        where = self._path or "hal_data"
        keys = [str(k) for k in self]
        hint = nearest(str(key), keys)
        if hint.startswith("did you mean"):
            hint += " There is: " + ", ".join(sorted(keys))
        return UnknownKey(f"there is no key {key!r} in {where}", where=join(self._path, key), remedy=remedy or hint)

    def __getitem__(self, key: Any) -> Any:
        try:
            get = self._getters[key]
        except (KeyError, TypeError):
            get = self._getters[key] = self._slot(key).get
        return get()

    def __setitem__(self, key: Any, value: Any) -> None:
        slot = self._slot(key)
        if slot.set is None:
            current = slot.get()
            if isinstance(current, (LiveDict, LiveList)):
                current.assign(value)
                return
            raise WrongValue("cannot be written", where=join(self._path, key), remedy=slot.remedy)
        if value is None and slot.unset is not None:
            checked = slot.unset
            self._getters[key] = partial(_get_unless_unset, slot)
        else:
            checked = value if slot.kind is ANY else slot.kind.check(value, join(self._path, key))
        watch = self._watches.get(slot.canonical or key) if self._watches else None
        if watch is None:
            slot.set(checked)
            return
        # The HAL reports changes only, and for some values nothing: then the listeners are called here.
        watch.called = False
        slot.set(checked)
        if not watch.called:
            watch.fire()

    def __delitem__(self, key: Any) -> None:
        raise UnknownKey("a key of hal_data cannot be removed", where=join(self._path, key))

    def clear(self) -> None:
        """Remove every key; most dicts here raise an error."""
        for key in list(self):
            del self[key]

    def __iter__(self) -> Iterator[Any]:
        return iter(self._slots)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, key: object) -> bool:
        return key in self._slots

    def get(self, key: Any, default: Any = None) -> Any:
        """Return the value at `key`, or `default` if there is no such key."""
        if key in self:
            return self[key]
        return default

    def setdefault(self, key: Any, default: Any = None) -> Any:
        """Return the value at `key`. A missing key is written first; most dicts here raise an error."""
        if key not in self:
            self[key] = default
        return self[key]

    def assign(self, values: Mapping[Any, Any]) -> None:
        """Write every key of `values`."""
        if not isinstance(values, Mapping):
            raise WrongType(f"expected a dict, not a {type(values).__name__}", where=self._path)
        for key, value in values.items():
            self[key] = value

    def register(self, key: Any, callback: Callback, notify: bool = False) -> None:
        """Call ``callback(key, value)`` each time `key` is set, by the robot or through `hal_data`.

        The HAL reports the robot's writes only when they change the value. Values that only `hal_data` has are reported
        when they are written through it. An exception of the callback is raised where the value was set.

        :param notify: also call the callback now
        :raises KeyError: when there is no such key
        """
        slot = self._slot(key)
        name = slot.canonical or key
        watch = self._watches.get(name)
        if watch is None:
            watch = self._watches[name] = _Watch(self, slot)
        watch.listeners.append((key, callback))
        if notify:
            callback(key, self[key])

    def _changed(self, key: str) -> None:
        """Call the listeners after an entry of the list at `key` was written."""
        if key in self._watches:
            self._watches[key].fire()

    def __repr__(self) -> str:
        return f"<{self._path or 'hal_data'}: {plain(self)!r}>"


class LiveList(LiveSequence):
    """A list of fixed length, of devices or of values in the HAL (`ValueList`)."""

    def __init__(self, path: str, items: Sequence[Any]) -> None:
        super().__init__(path)
        self._items = items

    def __len__(self) -> int:
        return len(self._items)

    def __iter__(self) -> Iterator[Any]:
        return iter(self._items)

    def __getitem__(self, index: Any) -> Any:
        try:
            return self._items[index]
        except (IndexError, TypeError):
            raise self._wrong(index) from None

    def __setitem__(self, index: Any, value: Any) -> None:
        if isinstance(index, slice):
            self._set_slice(index, value)
        else:
            self[index].assign(value)

    def _set_slice(self, index: slice, values: Any) -> None:
        positions, values = range(len(self))[index], list(values)
        if len(positions) != len(values):
            raise WrongValue(f"{len(values)} values do not fit {len(positions)} entries", where=self._path)
        for position, value in zip(positions, values, strict=True):
            self[position] = value

    def _wrong(self, index: Any) -> WrongIndex | WrongType:
        if not isinstance(index, int):
            kind = type(index).__name__
            return WrongType(f"expected a list index, not {index!r} ({kind})", where=self._path)
        length = len(self)
        return WrongIndex(
            f"there is no entry {index}, the list has {length}",
            where=join(self._path, index),
            remedy=f"use 0 to {length - 1}" if length else None,
        )

    def assign(self, values: Sequence[Any]) -> None:
        """Write the first entries.

        :raises TypeError: when `values` is not a list
        :raises ValueError: when it is too long
        """
        if isinstance(values, str) or not isinstance(values, Sequence):
            raise WrongType(f"expected a list, not a {type(values).__name__}", where=self._path)
        if len(values) > len(self):
            raise WrongValue(f"{len(values)} values are too many for {len(self)} entries", where=self._path)
        for index, value in enumerate(values):
            self[index] = value

    def __repr__(self) -> str:
        return f"<{self._path}: {plain(self)!r}>"


class ValueList(LiveList):
    """A list of values of one kind.

    :param length: returns the current number of entries
    :param get: reads one entry
    :param put: writes one entry
    :param load: reads all entries at once
    :param changed: called after a write
    """

    def __init__(
        self,
        path: str,
        kind: ValueKind,
        length: Callable[[], int],
        get: Callable[[int], Any],
        put: Callable[[int, Any], object],
        load: Callable[[], list[Any]] | None = None,
        changed: Callable[[], object] | None = None,
    ) -> None:
        super().__init__(path, ())
        self._kind, self._length, self._get, self._put = kind, length, get, put
        self._load = load or (lambda: [get(i) for i in range(length())])
        self._changed = changed

    def __len__(self) -> int:
        return self._length()

    def __iter__(self) -> Iterator[Any]:
        return iter(self._load())

    def _position(self, index: Any) -> int:
        length = self._length()
        if not isinstance(index, int) and hasattr(index, "__index__"):  # as XboxController.Button.A of 2027
            index = index.__index__()
        if not isinstance(index, int) or not -length <= index < length:
            raise self._wrong(index)
        return index + length if index < 0 else index

    def check(self, index: Any, value: object) -> tuple[int, Any]:
        """Return the position and the value of a write, without writing.

        :raises PyfrcError: when the list has no such entry, or it cannot have this value
        """
        position = self._position(index)
        return position, self._kind.check(value, join(self._path, position))

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return self._load()[index]
        return self._get(self._position(index))

    def __setitem__(self, index: Any, value: Any) -> None:
        if isinstance(index, slice):
            self._set_slice(index, value)
            return
        self._put(*self.check(index, value))
        if self._changed is not None:
            self._changed()


def plain(value: Any) -> Any:
    """Return a copy made of dicts, lists, numbers, strings, bools and None only, as for ``json.dumps``."""
    if value is None or type(value) in (bool, int, float, str):
        return value
    if isinstance(value, Mapping):
        if all(isinstance(key, int) for key in value):
            return {key: plain(item) for key, item in value.items()}
        # Strings and numbers cannot be sorted together, as a recording's keys are.
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
        return [plain(v) for v in value]
    if isinstance(value, (set, frozenset)):
        return sorted((plain(v) for v in value), key=repr)
    if isinstance(value, str):
        return str(value)
    if isinstance(value, Real):
        return int(value) if isinstance(value, Integral) else float(value)
    try:
        text = str(value)
    except Exception:  # from the user's class
        text = ""
    # By default, an object's text contains its address, which differs from run to run.
    return text if text and " at 0x" not in text else f"<{type(value).__name__}>"
