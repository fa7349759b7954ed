"""The HAL's callbacks through its C interface: those that its Python interface lacks, and callbacks without Python.

The C interface also says when a SimDevice or a value of one is created, and when a device is freed. It is documented
(``hal/simulation/*Data.h``); the library is the one that WPILib's Python packages have loaded.
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


class Report(NamedTuple):
    """A change that the HAL reports.

    :param event: what changes, in the name of the C function: ``PWMSpeed`` of ``HALSIM_RegisterPWMSpeedCallback``
    :param subject: the numbers that say of what: a channel, a module and its channel, a handle, or nothing. Changes of
        one joystick are reported as those of each
    """

    event: str
    subject: tuple[int, ...]

    @property
    def exists(self) -> bool:
        """Whether this version of the HAL has it."""
        return hasattr(_library(), f"HALSIM_Register{self.event}Callback")

    @property
    def of_sim_device(self) -> bool:
        return self.event.startswith("Sim")


class Registered(NamedTuple):
    """A callback in the HAL.

    :param number: what the HAL has returned for it
    :param resets: how many times all callbacks of SimDevices have been removed before
    """

    report: Report
    number: int
    resets: int


#: What is registered, with its parameter, to be cancelled before Python ends: a thread of a vendor's library may still
#: write values then. When a device is freed and created again, the HAL returns the same numbers again.
_REGISTERED: dict[Registered, int] = {}
_resets = 0


class Resets:
    """Resets of the roboRIO's data in the HAL. They remove all callbacks of a device, without a sign.

    Attributes:
        announced: whether `announce` is called before each of them, so that a callback can be relied on
        number: how many were announced
    """

    def __init__(self) -> None:
        self.announced = False
        self.number = 0

    def announce(self) -> None:
        """Cancel all callbacks of the roboRIO's devices: those of the devices that are not reset, too."""
        self.number += 1
        for registered, parameter in list(_REGISTERED.items()):
            if not registered.report.of_sim_device:
                _cancel(registered, parameter)


resets = Resets()


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
        _register(Report("SimDeviceCreated", ()), number, self._callback)
        _register(Report("SimDeviceFreed", ()), number, self._callback)

    def note_new_values(self, device: int, number: int) -> None:
        """Note `number` whenever the SimDevice with this handle gets a new value."""
        _register(Report("SimValueCreated", (device,)), number, self._callback)


class WriteFlags:
    """Flags that show what has been written.

    The callback is ``strtod(text, end)`` of the C library: it stores in ``*end`` where it has stopped reading, which is
    never 0. The HAL passes the name of the value, which is the text, and the address that was registered, which is that
    of the value's flag. So a report takes less time than reading the value, and needs no lock of Python's.

    :param reports: for each flag, what sets it
    """

    def __init__(self, reports: Sequence[Iterable[Report]]) -> None:
        self._flags = (ctypes.c_size_t * max(1, len(reports)))()
        self._view = memoryview(self._flags).cast("B").cast("P")
        #: The flags at the last look, of which only those of `_kept` are set.
        self._before = bytearray(self._flags)
        self._words = memoryview(self._before).cast("P")
        self._kept: frozenset[int] = frozenset()
        begin, size, callback = ctypes.addressof(self._flags), ctypes.sizeof(ctypes.c_size_t), _strtod()
        _FLAGS[begin] = self._flags
        #: What is registered, and the address of its flag.
        self._registered = [
            (_register(report, address, callback), address)
            for address, of_flag in zip(count(begin, size), reports, strict=False)
            for report in of_flag
        ]

    def take(self) -> list[int]:
        """Return the positions of the values that were written since the last call; read the values after it."""
        now = self._view.tobytes()
        if now == self._before:
            return []
        flags, words, kept = self._view, self._words, self._kept
        found = memoryview(now).cast("P")
        written = []
        for first in range(0, len(found), _COMPARED):
            some = slice(first, first + _COMPARED)
            if found[some] == words[some]:
                continue
            for position in compress(count(first), map(ne, found[some], words[some])):
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


#: How many flags are compared at once. Few have been set since the last look, among hundreds.
_COMPARED = 32

#: The memory of flags that are not closed, by its address: the HAL may still write there.
_FLAGS: dict[int, object] = {}


@cache
def _strtod() -> ctypes.c_void_p:
    library = ctypes.CDLL("msvcrt" if sys.platform == "win32" else None)
    return ctypes.cast(library.strtod, ctypes.c_void_p)


def _register(report: Report, parameter: int, callback: Any) -> Registered:
    register = getattr(_library(), f"HALSIM_Register{report.event}Callback")
    subject, address = map(ctypes.c_int32, report.subject), ctypes.c_void_p(parameter)
    if report.of_sim_device:
        # The C functions for devices have the beginning of a name first, those for values a handle.
        number = register(*(subject if report.subject else (b"",)), address, callback, 0)
    else:
        number = register(*subject, callback, address, 0)
    registered = Registered(report, number, _resets)
    _REGISTERED[registered] = parameter
    return registered


def _cancel(registered: Registered, parameter: int) -> None:
    """Cancel a callback, unless it has been removed with its device or by a reset: its number may be another's then."""
    if _REGISTERED.get(registered) == parameter:
        del _REGISTERED[registered]
        report = registered.report
        # All joysticks have their callbacks in one list.
        subject = () if report.event.startswith(("Sim", "Joystick")) else report.subject
        getattr(_library(), f"HALSIM_Cancel{report.event}Callback")(*subject, registered.number)


def forget_registered() -> None:
    """Forget what was registered for SimDevices, after `resetSimDeviceData` has removed it."""
    global _resets
    _resets += 1
    for registered in [each for each in _REGISTERED if each.report.of_sim_device]:
        del _REGISTERED[registered]


@atexit.register
def _cancel_all() -> None:
    for registered, parameter in list(_REGISTERED.items()):
        _cancel(registered, parameter)


def led_bytes(index: int, buffer: ctypes.Array[ctypes.c_char]) -> bytes:
    """Return the colours of an LED strip: blue, green, red and 0 for each LED.

    :param buffer: from `led_buffer`
    """
    count: int = _library().HALSIM_GetAddressableLEDData(index, buffer)
    return buffer[: 4 * count]  # type: ignore[return-value]  # a slice of characters is bytes


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
