"""Where the HAL keeps the values of SimDevices, to read hundreds of them in a packet.

`HALSIM_EnumerateSimValues` passes the address of each value to a callback. Until the device is freed, the HAL keeps the
value there; that is not promised, so a caller compares it with what the HAL returns before it relies on it. A read of
memory takes a quarter of the time of a call into WPILib, and less of the processor's caches, which the robot's code
needs.
"""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Sequence
from itertools import compress
from operator import itemgetter, ne
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import hal

from .wpilib_private import NATIVE_HAL

if TYPE_CHECKING:
    _Place: TypeAlias = "ctypes._Pointer[_Value]"


class NumberMemory(NamedTuple):
    """The memory of one number.

    :param address: where it is
    :param format: its type, as the module `struct` names it: ``d``, ``i`` or ``q``
    """

    address: int
    format: str

    def read(self) -> float:
        """Return the number."""
        memory = (ctypes.c_char * struct.calcsize(self.format)).from_address(self.address)
        number: float = struct.unpack(self.format, memory)[0]
        return number


class ManyNumbers:
    """Numbers that are read at once, to find those that have changed.

    They are compared by their bits: 0.0 and -0.0 differ in these, and NaN does not differ from itself. One call reads
    the bits of all, from one view of the memory from the first number to the last: an object for each would have to
    be fetched from memory, too.

    :param memory: the memory of at least one number, all of the same format
    :param positions: for each, its position in the lists of `update`
    :param last: what each was last read as
    """

    def __init__(self, memory: Sequence[NumberMemory], positions: Sequence[int], last: Sequence[float]) -> None:
        self._positions = positions
        kind = memory[0].format
        # Integers are their own bits.
        bits, size = "q" if kind == "d" else kind, struct.calcsize(kind)
        begin = min(place.address for place in memory)
        self._indexes = [(place.address - begin) // size for place in memory]
        all_between = (ctypes.c_char * (size * (max(self._indexes) + 1))).from_address(begin)
        view = memoryview(all_between).cast("B")
        self._numbers, self._bits = view.cast(kind), view.cast(bits)  # type: ignore[call-overload]
        # The first one once more: of one item, `itemgetter` makes no tuple.
        self._read = itemgetter(*self._indexes, self._indexes[0])
        number = len(memory)
        self._last = struct.unpack(f"{number}{bits}", struct.pack(f"{number}{kind}", *last))

    def update(self, found: list[Any], values: list[Any]) -> list[int]:
        """Store the numbers that have changed since they were last read, in both lists; return their positions."""
        last, self._last = self._last, self._read(self._bits)
        numbers, changed = self._numbers, []
        # A thread that writes after the bits were read changes them: the next call stores that number again.
        for position, index in compress(zip(self._positions, self._indexes, strict=True), map(ne, last, self._last)):
            found[position] = values[position] = numbers[index]
            changed.append(position)
        return changed


class _Value(ctypes.Structure):
    """`HAL_Value` of ``hal/Value.h``."""

    _fields_ = (("data", ctypes.c_int64), ("type", ctypes.c_int))


_CALLBACK: Any = ctypes.CFUNCTYPE(
    None, ctypes.c_char_p, ctypes.c_void_p, ctypes.c_int32, ctypes.c_int32, ctypes.POINTER(_Value)
)


def value_memory(device: int) -> dict[int, NumberMemory]:
    """Return the memory of each number of the SimDevice with this handle, by the handle of the value.

    It may be read until the device is freed.
    """
    formats = {
        int(hal.Type.DOUBLE): "d",
        int(hal.Type.INT): "i",
        int(hal.Type.ENUM): "i",
        int(hal.Type.LONG): "q",
    }
    found: dict[int, NumberMemory] = {}

    def note(_name: bytes, _parameter: object, handle: int, _direction: int, place: _Place) -> None:
        if kind := formats.get(place.contents.type):
            found[handle] = NumberMemory(ctypes.addressof(place.contents), kind)

    NATIVE_HAL.find().HALSIM_EnumerateSimValues(device, None, _CALLBACK(note))
    return found
