"""Where the HAL keeps the values of SimDevices, to read hundreds of them in a packet.

`HALSIM_EnumerateSimValues` passes the address of each value to a callback. Until the device is freed, the HAL keeps the
value there; that is not promised, so a caller compares it with what the HAL returns before it relies on it. A read of
memory takes a quarter of the time of a call into WPILib, and less of the processor's caches, which the robot's code
needs.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import hal

from .wpilib_private import NATIVE_HAL

if TYPE_CHECKING:
    _Place: TypeAlias = "ctypes._Pointer[_Value]"

_Number = ctypes.c_double | ctypes.c_int32 | ctypes.c_int64


class NumberMemory(NamedTuple):
    """The memory of one number.

    :param number: the number
    :param bits: the same memory as an integer, by which two numbers can be compared: 0.0 and -0.0 differ in it, and
        NaN does not differ from itself
    """

    number: _Number
    bits: ctypes.c_int32 | ctypes.c_int64

    def bits_of(self, number: float) -> int:
        """Return what `bits` has if the memory has this number."""
        kind: Any = type(self.number)
        return type(self.bits).from_buffer(kind(number)).value


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
    kinds: dict[int, tuple[type[_Number], type[ctypes.c_int32 | ctypes.c_int64]]] = {
        int(hal.Type.DOUBLE): (ctypes.c_double, ctypes.c_int64),
        int(hal.Type.INT): (ctypes.c_int32, ctypes.c_int32),
        int(hal.Type.ENUM): (ctypes.c_int32, ctypes.c_int32),
        int(hal.Type.LONG): (ctypes.c_int64, ctypes.c_int64),
    }
    found: dict[int, NumberMemory] = {}

    def note(_name: bytes, _parameter: object, handle: int, _direction: int, place: _Place) -> None:
        if kind := kinds.get(place.contents.type):
            at, (number, bits) = ctypes.addressof(place.contents), kind
            found[handle] = NumberMemory(number.from_address(at), bits.from_address(at))

    NATIVE_HAL.find().HALSIM_EnumerateSimValues(device, None, _CALLBACK(note))
    return found
