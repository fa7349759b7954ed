"""The HAL's callbacks for SimDevices that its C interface has and its Python interface lacks.

The C interface says when a SimDevice or a value of one is created, and when a device is freed. It is documented
(``hal/simulation/SimDeviceData.h``); the library is the one that WPILib's Python packages have loaded.
"""

from __future__ import annotations

import atexit
import ctypes
import sys
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from itertools import compress, count
from operator import ne
from typing import Any, NamedTuple

from .wpilib_private import NATIVE_HAL

# A callback has up to three more arguments, which are not declared: the C calling conventions of all systems that
# WPILib supports allow it. So `dict.__setitem__` serves as the callback. It is no Python code, so no signal handler
# runs within it: the exception of a handler, such as KeyboardInterrupt, would be lost there.
_CALLBACK = ctypes.CFUNCTYPE(None, ctypes.c_size_t, ctypes.c_size_t)

#: Callbacks are never freed, since the HAL may call one as long as the process lives.
_KEPT: list[object] = []


class Registered(NamedTuple):
    """A callback in the HAL.

    :param number: what the HAL has returned for it
    :param resets: how many times all callbacks have been removed before
    """

    event: str
    number: int
    resets: int


#: What is registered, with its parameter, to be cancelled before Python ends: a thread of a vendor's library may still
#: write values then. When a device is freed and created again, the HAL returns the same numbers again.
_REGISTERED: dict[Registered, int] = {}
_resets = 0


@cache
def _library() -> Any:
    return NATIVE_HAL.find()


class HalNotes:
    """Notes of what the HAL has reported: the numbers under which the events were registered.

    The HAL may call from any thread, with the lock of its SimDevices held. A note only adds to a dict.
    """

    def __init__(self) -> None:
        #: The last note of each name, by the address of the name.
        self._notes: dict[int, int] = {}
        self._callback = _CALLBACK(self._notes.__setitem__)
        _KEPT.append(self._callback)

    def __bool__(self) -> bool:
        """Return whether there is any note."""
        return bool(self._notes)

    def take(self) -> Iterator[int]:
        """Return the notes, and clear them."""
        while self._notes:
            yield self._notes.popitem()[1]

    def note_devices(self, number: int) -> None:
        """Note `number` whenever a SimDevice is created or freed, until `resetSimDeviceData` is called."""
        self._register("SimDeviceCreated", b"", number)
        self._register("SimDeviceFreed", b"", number)

    def note_new_values(self, device: int, number: int) -> None:
        """Note `number` whenever the SimDevice with this handle gets a new value."""
        self._register("SimValueCreated", ctypes.c_int32(device), number)

    def _register(self, event: str, subject: Any, number: int) -> None:
        _register(event, subject, number, self._callback)


class WriteFlags:
    """Flags that show which values of SimDevices have been written.

    The callback is ``strtod(text, end)`` of the C library: it stores in ``*end`` where it has stopped reading, which is
    never 0. The HAL passes the name of the value, which is the text, and the address that was registered, which is that
    of the value's flag. So a report takes less time than reading the value, and needs no lock of Python's.

    :param values: the handles of the values
    """

    def __init__(self, values: Sequence[int]) -> None:
        self._flags = (ctypes.c_size_t * max(1, len(values)))()
        self._view = memoryview(self._flags).cast("B").cast("P")
        #: The flags at the last look, of which only those of `_kept` are set.
        self._before = bytearray(self._flags)
        self._words = memoryview(self._before).cast("P")
        self._kept: frozenset[int] = frozenset()
        begin, size, callback = ctypes.addressof(self._flags), ctypes.sizeof(ctypes.c_size_t), _strtod()
        _FLAGS[begin] = self._flags
        #: What is registered, and the address of its flag.
        self._registered = [
            (_register("SimValueChanged", ctypes.c_int32(value), address, callback), address)
            for address, value in zip(count(begin, size), values, strict=False)
        ]

    def take(self) -> list[int]:
        """Return the positions of the values that were written since the last call; read the values after it."""
        now = self._view.tobytes()
        if now == self._before:
            return []
        flags, words, kept = self._view, self._words, self._kept
        found = memoryview(now).cast("P")
        written = []
        for position in compress(count(), map(ne, found, words)):
            if position in kept:
                words[position] = found[position]  # always the same, so this is its first write since `keep`
            else:
                flags[position] = 0  # not all: another one may have been set meanwhile
                written.append(position)
        return written

    def keep(self, positions: Iterable[int]) -> None:
        """Leave only these out of what `take` returns, until the next call. Read them at each look.

        So values that are written all the time need no flags, which would have to be found and cleared.
        """
        for position in self._kept:
            self._words[position] = self._view[position] = 0
        self._kept = frozenset(positions)

    def close(self) -> None:
        """End the HAL's reports."""
        while self._registered:
            _cancel(*self._registered.pop())
        _FLAGS.pop(ctypes.addressof(self._flags), None)


#: The memory of flags that are not closed, by its address: the HAL may still write there.
_FLAGS: dict[int, object] = {}


@cache
def _strtod() -> ctypes.c_void_p:
    library = ctypes.CDLL("msvcrt" if sys.platform == "win32" else None)
    return ctypes.cast(library.strtod, ctypes.c_void_p)


def _register(event: str, subject: Any, parameter: int, callback: Any) -> Registered:
    register = getattr(_library(), f"HALSIM_Register{event}Callback")
    registered = Registered(event, register(subject, ctypes.c_void_p(parameter), callback, 0), _resets)
    _REGISTERED[registered] = parameter
    return registered


def _cancel(registered: Registered, parameter: int) -> None:
    """Cancel a callback, unless it has been removed with its device or by a reset: its number may be another's then."""
    if _REGISTERED.get(registered) == parameter:
        del _REGISTERED[registered]
        getattr(_library(), f"HALSIM_Cancel{registered.event}Callback")(registered.number)


def forget_registered() -> None:
    """Forget what was registered, after `resetSimDeviceData` has removed it."""
    global _resets
    _resets += 1
    _REGISTERED.clear()


@atexit.register
def _cancel_all() -> None:
    for registered, parameter in list(_REGISTERED.items()):
        _cancel(registered, parameter)


def led_bytes(index: int, buffer: ctypes.Array[ctypes.c_char]) -> bytes:
    """Return the colours of an LED strip: blue, green, red and 0 for each LED.

    :param buffer: from `led_buffer`
    """
    count = _library().HALSIM_GetAddressableLEDData(index, buffer)
    return ctypes.string_at(buffer, 4 * count)


def current_bytes(module: int, buffer: ctypes.Array[ctypes.c_double]) -> bytes:
    """Return the currents of a power distribution module as C doubles.

    :param buffer: memory for the module's channels
    """
    _library().HALSIM_GetPowerDistributionAllCurrents(module, buffer, len(buffer))
    return bytes(buffer)


def current_buffer(channels: int) -> ctypes.Array[ctypes.c_double]:
    """Return memory for the currents of a module."""
    return (ctypes.c_double * channels)()


def led_buffer() -> ctypes.Array[ctypes.c_char]:
    """Return memory for the longest strip."""
    return ctypes.create_string_buffer(4 * 5460)
