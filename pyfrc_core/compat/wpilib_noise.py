"""WPILib's simulated mechanisms add noise (`measurementStdDevs`), from C++ generators that each update seeds by chance.

WPILib's C++ makes a `std::random_device` in each update, also without noise, and offers no way to seed it. Where the
libraries are ELF files loaded by GNU's C library (Linux), the addresses through which they call it are replaced: it
then returns the numbers of a generator with a known seed. It is also no longer prepared: that asks which instructions
the processor has, which takes tens of microseconds on a virtual machine.
"""

from __future__ import annotations

import ctypes
import mmap
import os
import random
import struct
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

#: The packages that contain the C++ of mechanisms, and the names of its files there.
_LIBRARIES = {
    "wpilib.simulation": "_simulation*.so",
    "wpimath": "_controls/_controls*.so",
    "native.wpilib": "lib/libwpilibc.so",
    "native.wpimath": "lib/libwpimath.so",
}
_DRAW = "_ZNSt13random_device9_M_getvalEv"
_PREPARE = "_ZNSt13random_device7_M_initERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEE"
#: Bytes at the beginning of a `std::random_device` that say what it has opened; zeros: nothing that its end must close.
_OPENED = 24

# From the ELF specification: tags of the dynamic section, and the sizes of its entries, of relocations and of symbols.
_DT_NULL, _DT_PLTRELSZ, _DT_STRTAB, _DT_SYMTAB, _DT_RELA, _DT_RELASZ, _DT_JMPREL = 0, 2, 5, 6, 7, 8, 23
_DYNAMIC, _RELOCATION, _SYMBOL = struct.Struct("qQ"), struct.Struct("QQq"), 24
_READ_WRITE = 1 | 2  # PROT_READ | PROT_WRITE
#: Pointers are relocated by entries of these types: R_X86_64_GLOB_DAT and JUMP_SLOT, R_AARCH64_GLOB_DAT and JUMP_SLOT.
_POINTERS = {"x86_64": (6, 7), "aarch64": (1025, 1026)}

_generator = random.Random(0)


@cache
def replace_chance() -> bool:
    """Have WPILib's mechanisms draw from our generator. Done before a process forks, its forks need not do it.

    :return: whether the noise now depends on `seed_mechanism_noise` alone
    """
    if sys.platform != "linux" or not os.confstr("CS_GNU_LIBC_VERSION"):
        return False
    pointers = _POINTERS.get(os.uname().machine)
    files = list(_files())
    if pointers is None or not files:
        return False
    try:
        for file in files:
            wanted = {_PREPARE: _prepare, _DRAW: _draw}
            for name, slot in _imported(file, pointers):
                if name in wanted:
                    _write(slot, wanted.pop(name))
                    if not wanted:
                        break
    except OSError:
        return False
    return True


def seed_mechanism_noise(seed: int) -> None:
    """Start the noise of WPILib's simulated mechanisms from this seed, where `replace_chance` could be done."""
    _generator.seed(seed)


def _prepare_nothing(device: int, _source: int) -> None:
    ctypes.memset(device, 0, _OPENED)


def _draw_seeded(_device: int) -> int:
    return _generator.getrandbits(32)


# Kept for as long as this process lives: the libraries have their addresses.
_prepare = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(_prepare_nothing)
_draw = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_void_p)(_draw_seeded)


def _files() -> Iterator[Path]:
    for name, pattern in _LIBRARIES.items():
        for directory in getattr(sys.modules.get(name), "__path__", ()):
            yield from Path(directory).glob(pattern)


def _imported(file: Path, pointers: tuple[int, ...]) -> Iterator[tuple[str, int]]:
    """Yield the names of what a loaded library takes from others, and the address of the pointer to each.

    The handle of a library is its `struct link_map` (glibc's ``link.h``): its base address, its name, its dynamic
    section, whose addresses glibc has relocated.
    """
    base, _, dynamic = (ctypes.c_size_t * 3).from_address(ctypes.CDLL(str(file))._handle)
    tags: dict[int, int] = {}
    while True:
        tag, value = _DYNAMIC.unpack(ctypes.string_at(dynamic, _DYNAMIC.size))
        if tag == _DT_NULL:
            break
        tags[tag] = value
        dynamic += _DYNAMIC.size
    for table, size in ((_DT_JMPREL, _DT_PLTRELSZ), (_DT_RELA, _DT_RELASZ)):
        if table not in tags:
            continue
        for offset, info, _ in _RELOCATION.iter_unpack(ctypes.string_at(tags[table], tags[size])):
            if info & 0xFFFFFFFF in pointers:
                named = ctypes.c_uint32.from_address(tags[_DT_SYMTAB] + _SYMBOL * (info >> 32)).value
                yield ctypes.string_at(tags[_DT_STRTAB] + named).decode(), base + offset


def _write(slot: int, function: Any) -> None:
    page = slot & ~(mmap.PAGESIZE - 1)
    libc = ctypes.CDLL(None, use_errno=True)
    libc.mprotect.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int)
    if libc.mprotect(page, mmap.PAGESIZE, _READ_WRITE) != 0:
        raise OSError(ctypes.get_errno(), "mprotect")
    ctypes.c_void_p.from_address(slot).value = ctypes.cast(function, ctypes.c_void_p).value
