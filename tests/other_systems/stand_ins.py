"""What only Windows has, as far as pyfrc uses it, and sockets in place of pipes in what waits."""

from __future__ import annotations

import array
import fcntl
import os
import select
import selectors
import socket
import stat
import struct
import termios
from types import ModuleType, SimpleNamespace
from typing import Any

from .files import O_BINARY, error, make_junction
from .processes import SIGNAL

_NOT_A_SOCKET = (10038, 88, "An operation was attempted on something that is not a socket")
_WRONG = (10022, 22, "An invalid argument was supplied")

_select = select.select


def _checked_select(readers: Any, writers: Any, others: Any, timeout: float | None = None) -> Any:
    """Do what `select.select` does with sockets, and nothing else."""
    everything = [*readers, *writers, *others]
    if not everything:
        raise error(_WRONG)
    for each in everything:
        if not stat.S_ISSOCK(os.fstat(each if isinstance(each, int) else each.fileno()).st_mode):
            raise error(_NOT_A_SOCKET)
    return _select(readers, writers, others, timeout)


class SelectSelector(selectors.SelectSelector):
    """Waits for sockets only."""

    def _select(self, readers: Any, writers: Any, _: Any, timeout: float | None = None) -> Any:
        return _checked_select(readers, writers, [], timeout)


def _module(name: str, **content: Any) -> ModuleType:
    module = ModuleType(name)
    vars(module).update(content)
    return module


def _locking(descriptor: int, mode: int, size: int) -> None:
    """Lock a range of bytes, as `msvcrt.locking` does from the current position, against any other open file."""
    fcntl.fcntl(descriptor, fcntl.F_OFD_SETLK, struct.pack("hhqqi", fcntl.F_WRLCK, os.SEEK_CUR, 0, size, 0))


def _peek_named_pipe(pipe: int, buffer: Any, size: int, read: Any, available: Any, left: Any) -> int:
    """Say how much is in a pipe; 0 when its other end is closed."""
    count = array.array("i", [0])
    fcntl.ioctl(pipe, termios.FIONREAD, count)
    poll = select.poll()
    poll.register(pipe, 0)
    available._obj.value = count[0]
    return int(bool(count[0]) or not poll.poll(0))


_KERNEL32 = SimpleNamespace(PeekNamedPipe=_peek_named_pipe)
_SHCORE = SimpleNamespace(SetProcessDpiAwareness=lambda awareness: 0)

#: Modules of Windows' Python.
ONLY_WINDOWS = {
    "msvcrt": _module(
        "msvcrt",
        LK_LOCK=1,
        LK_NBLCK=2,
        LK_UNLCK=0,
        locking=_locking,
        get_osfhandle=lambda descriptor: descriptor,
        setmode=lambda descriptor, flags: O_BINARY,
    ),
    "_winapi": _module("_winapi", CreateJunction=make_junction),
    "winreg": _module("winreg"),
}

#: What modules have there in place of their own, or besides.
INSTEAD: dict[str, dict[str, Any]] = {
    "sys": {"platform": "win32", "getwindowsversion": lambda: SimpleNamespace(major=10, minor=0, build=22631)},
    "os": {"name": "nt", "linesep": "\r\n", "devnull": "nul", "O_BINARY": O_BINARY, "O_NOINHERIT": 0},
    "signal": SIGNAL,
    "select": {"select": _checked_select},
    "selectors": {"SelectSelector": SelectSelector, "DefaultSelector": SelectSelector},
    "socket": {"SO_EXCLUSIVEADDRUSE": socket.SO_REUSEADDR},
    "ctypes": {"windll": SimpleNamespace(kernel32=_KERNEL32, shcore=_SHCORE)},
}
