"""Functions that depend on the operating system: locks, links, atomic exchange, waiting for a pipe, users.

A robot runs Linux. A virtual robot runs on its user's system. Only Linux has been tested.
"""

from __future__ import annotations

import os
import select
import signal
import sys
import time
from io import FileIO
from pathlib import Path
from typing import IO, Any, BinaryIO

#: Whether one rename can replace a link by another link.
REPLACES_LINKS = sys.platform != "win32"

_EXCHANGE = 2  # flag of renameat2 and of renamex_np
_AT_FDCWD = -100
_RENAMEAT2 = {"x86_64": 316, "armv7l": 382, "aarch64": 276}
_SET_DEATH_SIGNAL = 1  # prctl

#: The signal that ends any process at once; on Windows, `os.kill` does that for each signal.
if sys.platform == "win32":
    KILL = signal.SIGTERM
else:
    KILL = signal.SIGKILL


def flush(directory: Path) -> None:
    """Wait until all data written to this file system is on the disk.

    One ``syncfs`` is as safe as an ``fsync`` for each file and directory, and much faster on flash memory. Windows can
    only flush single files, so a power cut may lose the last writes there.
    """
    if sys.platform == "win32":
        return
    import ctypes

    descriptor = os.open(directory, os.O_RDONLY)
    try:
        library = ctypes.CDLL(None, use_errno=True)
        if not hasattr(library, "syncfs"):
            os.sync()
        elif library.syncfs(descriptor) != 0:
            number = ctypes.get_errno()
            raise OSError(number, os.strerror(number), str(directory))
    finally:
        os.close(descriptor)


def exchange(one: Path, other: Path) -> bool:
    """Exchange two directory entries atomically. Return False if the system does not support this."""
    if sys.platform == "win32":
        return False
    import ctypes

    if sys.platform == "darwin":
        rename = ctypes.CDLL(None, use_errno=True).renamex_np
        return bool(rename(os.fsencode(one), os.fsencode(other), _EXCHANGE) == 0)
    number = _RENAMEAT2.get(os.uname().machine)
    if number is None:
        return False
    call = ctypes.CDLL(None, use_errno=True).syscall
    return bool(call(number, _AT_FDCWD, os.fsencode(one), _AT_FDCWD, os.fsencode(other), _EXCHANGE) == 0)


def make_link(link: Path, directory: Path, place: Path) -> None:
    """Create a link to `directory`. Its relative target is correct after a rename to `place`."""
    if sys.platform == "win32":
        import _winapi

        _winapi.CreateJunction(str(directory), str(link))  # symbolic links need the administrator there
    else:
        link.symlink_to(os.path.relpath(directory, place.parent))


def linked_directory(link: Path) -> Path | None:
    """Return the target of a link without following further links, or None if it is not a link."""
    try:
        target = str(link.readlink())
    except OSError:
        return None
    return link.parent / target.removeprefix("\\\\?\\") if sys.platform == "win32" else link.parent / target


def replace_link(link: Path, place: Path) -> None:
    """Rename a link to `place` and replace an existing link there; atomic if `REPLACES_LINKS`."""
    if not REPLACES_LINKS and linked_directory(place) is not None:
        place.unlink()
    link.replace(place)


def link_file(source: str, target: str) -> None:
    """Create `target` as a hard link to the file (or symbolic link) `source`.

    :raises OSError: if the file system does not support hard links
    """
    if os.link in os.supports_follow_symlinks:
        os.link(source, target, follow_symlinks=False)
    else:
        os.link(source, target)


def lock(stream: IO[Any] | FileIO) -> None:
    """Lock an open file. Closing it or the end of the process releases the lock.

    :raises OSError: if another process holds the lock
    """
    if sys.platform == "win32":
        import msvcrt

        # Windows prevents reading a locked range, so the lock covers one byte far beyond the content.
        os.lseek(stream.fileno(), 1 << 30, os.SEEK_SET)
        msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)


def readable(stream: BinaryIO, seconds: float) -> bool:
    """Wait up to `seconds` until an unbuffered pipe has data or is closed. Return False after a timeout."""
    if sys.platform == "win32":
        import ctypes
        import msvcrt

        pipe, count = msvcrt.get_osfhandle(stream.fileno()), ctypes.c_ulong()
        end = time.monotonic() + seconds
        while ctypes.windll.kernel32.PeekNamedPipe(pipe, None, 0, None, ctypes.byref(count), None) and not count.value:
            if time.monotonic() >= end:
                return False
            time.sleep(0.005)
        return True
    return bool(select.select([stream], [], [], seconds)[0])


def writable(descriptor: int, seconds: float) -> bool:
    """Wait up to `seconds` until a pipe can be written to. Return False after a timeout; never on Windows."""
    return sys.platform == "win32" or bool(select.select([], [descriptor], [], seconds)[1])


def end_with_parent() -> None:
    """Let the system kill this forked process when its parent ends (Linux only)."""
    import ctypes

    library = ctypes.CDLL(None)
    if hasattr(library, "prctl"):
        library.prctl(_SET_DEATH_SIGNAL, KILL)


def ticks_per_second() -> int:
    """Return the unit of times in ``/proc``.

    :raises OSError: on Windows, which has no ``/proc``
    """
    if sys.platform == "win32":
        raise OSError("there is no /proc")
    return os.sysconf("SC_CLK_TCK")


def user() -> str:
    """Return the user name of this process."""
    if sys.platform == "win32":
        import getpass

        return getpass.getuser()
    import pwd

    return pwd.getpwuid(os.geteuid()).pw_name


def is_own(file: os.stat_result) -> bool:
    """Return whether a file, or a process by its entry in ``/proc``, belongs to the user of this process."""
    return sys.platform == "win32" or file.st_uid == os.geteuid()


def is_root() -> bool:
    """Return whether this process may switch to another user."""
    return sys.platform != "win32" and os.geteuid() == 0


def become(name: str) -> None:
    """Switch this process to another user, who then owns new files."""
    if sys.platform != "win32":
        import pwd

        entry = pwd.getpwnam(name)
        os.initgroups(name, entry.pw_gid)
        os.setgid(entry.pw_gid)
        os.setuid(entry.pw_uid)
