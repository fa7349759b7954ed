"""REV's library adds noise to the velocities that it simulates, from a C++ generator that it seeds by chance.

It offers no way to seed it, so the generator's state is written, where the library exports it: on Linux. It is the
`std::mt19937` of GCC's library, whose layout is part of that library's ABI.
"""

from __future__ import annotations

import ctypes
import sys
from functools import cache
from typing import Any

#: C++ names of `rev::spark::NoiseGenerator`'s generator, and of its normal distribution.
_GENERATOR = "_ZN3rev5spark14NoiseGenerator6m_randE"
_DISTRIBUTION = "_ZN3rev5spark14NoiseGenerator6m_distE"

_WORDS = 624  # of the generator's state
#: From the reference implementation: M. Matsumoto and T. Nishimura, "Mersenne Twister", `init_genrand`, 2002.
_MULTIPLIER = 1_812_433_253


class _Generator(ctypes.Structure):
    _fields_ = (("state", ctypes.c_ulong * _WORDS), ("position", ctypes.c_size_t))


class _Distribution(ctypes.Structure):
    """A normal distribution draws two values at a time, and keeps the second."""

    _fields_ = (
        ("mean", ctypes.c_double),
        ("deviation", ctypes.c_double),
        ("kept", ctypes.c_double),
        ("has_kept", ctypes.c_bool),
    )


def seed_noise(seed: int) -> bool:
    """Seed the noise of REV's simulation, if that library is imported.

    :return: whether the noise is the same in each run from now on; also true without the library
    """
    rev = sys.modules.get("rev")
    if rev is None:
        return True
    found = _find(rev)
    if found is None:
        return False
    generator, distribution = found
    word = seed % 2**32
    for index in range(_WORDS):
        if index:
            word = (_MULTIPLIER * (word ^ (word >> 30)) + index) % 2**32
        generator.state[index] = word
    generator.position = _WORDS  # all are used up: the next draw makes new ones
    distribution.has_kept = False
    return True


@cache
def _find(rev: Any) -> tuple[_Generator, _Distribution] | None:
    """Return the generator and the distribution inside the library, or None if it does not export them."""
    if sys.platform != "linux":
        return None
    try:
        library = ctypes.CDLL(sys.modules[rev.SparkSim.__module__].__file__)
        return _Generator.in_dll(library, _GENERATOR), _Distribution.in_dll(library, _DISTRIBUTION)
    except (AttributeError, KeyError, OSError, TypeError, ValueError):
        return None
