"""Files as another system has them: who may open, replace, rename and remove what, and under which name.

The functions of `os` that take a path, and `open`, are replaced for all code, as the rules are the system's. What code
in C opens, and Python's own import, keep Linux.

On Windows, a file that is open cannot be replaced, renamed or removed, since Python opens files without the right to do
that; nor can a directory with such a file in it, or a process's current one. Whether a file is open, here or in another
process, Linux says when it is asked for a lease: it gives one only for a file that is open nowhere else.
"""

from __future__ import annotations

import builtins
import errno
import fcntl
import io
import os
import re
import signal
import stat
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from .callers import Owner, caller

_real = {name: getattr(os, name) for name in dir(os) if callable(getattr(os, name))}
_real_open = io.open
_lstat, _listdir, _os_open, _close = os.lstat, os.listdir, os.open, os.close

#: Where Linux keeps what other systems do not have: hidden from our code.
_LINUX = ("/proc", "/sys", "/dev", "/run")

_RESERVED = re.compile(r"(con|prn|aux|nul|com[1-9]|lpt[1-9])(\..*)?", re.IGNORECASE)
_NOT_IN_NAMES = re.compile(r'[<>:"|?*\x00-\x1f]|[. ]$')

#: Windows' errors: its number, Python's, and the text.
_NOT_FOUND = (3, errno.ENOENT, "The system cannot find the path specified")
_DENIED = (5, errno.EACCES, "Access is denied")
_IN_USE = (32, errno.EACCES, "The process cannot access the file because it is being used by another process")
_WRONG_NAME = (123, errno.EINVAL, "The filename, directory name, or volume label syntax is incorrect")
_EXISTS = (183, errno.EEXIST, "Cannot create a file when that file already exists")
_NO_PRIVILEGE = (1314, errno.EINVAL, "A required privilege is not held by the client")

#: What Windows adds to the target of a junction.
_LONG = "\\\\?\\"


def error(kind: tuple[int, int, str], *paths: Any) -> OSError:
    """Return an error as Windows' Python raises it."""
    number, code, text = kind
    failure = OSError(code, text, *[part for path in paths for part in (os.fspath(path), None)][:3])
    failure.winerror = number  # type: ignore[attr-defined]
    return failure


class Replaced:
    """A function in place of one of `os`; unlike a function in Python, it does not become a method in a class."""

    def __init__(self, call: Callable[..., Any], name: str) -> None:
        self._call = call
        self.__name__ = self.__qualname__ = name

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        return self._call(*arguments, **options)


def is_open(file: str) -> bool:
    """Return whether any process has this file open."""
    try:
        descriptor = _os_open(file, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW)
    except OSError:
        return False
    try:
        fcntl.fcntl(descriptor, fcntl.F_SETLEASE, fcntl.F_WRLCK)
        fcntl.fcntl(descriptor, fcntl.F_SETLEASE, fcntl.F_UNLCK)
    except BlockingIOError:
        return True
    finally:
        _close(descriptor)
    return False


class Names:
    """Finds existing files by names in another case, as Windows and macOS do.

    :param reserved: whether Windows' rules for names hold
    """

    def __init__(self, reserved: bool) -> None:
        self._reserved = reserved

    def __call__(self, path: Any) -> Any:
        """Return the path under which Linux finds this one.

        :raises OSError: when there can be no such name
        """
        if isinstance(path, int) or path is None:
            return path
        path = os.fspath(path)
        if isinstance(path, bytes):
            return path
        if self._reserved and path.lower() == "nul":
            return "/dev/null"
        if self._reserved:
            path = path.removeprefix(_LONG)
        if path.startswith(_LINUX) and path != "/dev/null":
            if caller() is Owner.OURS and f"{path}/".startswith(tuple(f"{place}/" for place in _LINUX)):
                raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)
            return path
        if self._reserved:
            for name in path.split("/"):
                if name not in (".", "..") and (_NOT_IN_NAMES.search(name) or _RESERVED.fullmatch(name)):
                    raise error(_WRONG_NAME, path)
        return self._existing(path)

    def _existing(self, path: str) -> str:
        with suppress(OSError):
            _lstat(path)
            return path
        head, name = os.path.split(path)
        if not name:
            return self._existing(head) + "/" if head.strip("/") else path
        head = self._existing(head) if head else ""
        with suppress(OSError):
            for entry in _listdir(head or "."):
                if entry.casefold() == name.casefold():
                    return os.path.join(head, entry)
        return os.path.join(head, name)


def _is_directory(path: str) -> bool:
    with suppress(OSError):
        return stat.S_ISDIR(_lstat(path).st_mode)
    return False


def _read_only(path: str) -> bool:
    with suppress(OSError):
        return stat.S_ISREG(mode := _lstat(path).st_mode) and not mode & stat.S_IWUSR
    return False


def _in_use(path: str) -> bool:
    """Return whether a file, or anything in a directory, is open, or a directory is this process's current one."""
    if not _is_directory(path):
        return is_open(path)
    with suppress(OSError):
        if f"{os.getcwd()}/".startswith(f"{os.path.realpath(path)}/"):
            return True
        return any(_in_use(f"{path}/{entry}") for entry in _listdir(path))
    return False


class CaseInsensitive:
    """What Windows and macOS have in common: files are found by names in another case, also by those of `os`."""

    #: The functions of `os` with one path, and those with two.
    _ONE = (
        *("access", "chdir", "chmod", "listdir", "lstat", "mkdir", "readlink", "remove", "rmdir", "scandir", "stat"),
        *("truncate", "unlink", "utime", "open"),
    )
    _TWO = ("link", "rename", "replace")

    def __init__(self, reserved: bool = False) -> None:
        self.names = Names(reserved)

    def install(self) -> None:
        for name in self._ONE:
            setattr(os, name, Replaced(getattr(self, f"_{name}", None) or self._with_path(_real[name]), name))
        for name in self._TWO:
            setattr(os, name, Replaced(getattr(self, f"_{name}", None) or self._with_paths(_real[name]), name))
        # Those that look at these sets do without, as on Windows.
        os.supports_dir_fd.clear()
        os.supports_fd.clear()

    def _with_path(self, function: Callable[..., Any]) -> Callable[..., Any]:
        return lambda path=".", *arguments, **options: self.call(function, self.names(path), *arguments, **options)

    def _with_paths(self, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(source: Any, target: Any, **options: Any) -> Any:
            found = self.names(target)
            # To change the case of a name is to rename it.
            same = _lexists(found) and os.path.samefile(self.names(source), found) if function is not os.link else False
            return self.call(function, self.names(source), os.fspath(target) if same else found, **options)

        return call

    def call(self, function: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
        """Call a function of `os` with paths that exist."""
        return function(*arguments, **options)


class WindowsFiles(CaseInsensitive):
    """Files as on Windows."""

    def __init__(self) -> None:
        super().__init__(reserved=True)
        #: Descriptors of `os.open` without O_BINARY: what `os.write` writes to them has its line ends translated.
        self._text_descriptors: set[int] = set()

    def install(self) -> None:
        signal.signal(signal.SIGIO, signal.SIG_IGN)  # another process opens a file during a lease
        super().install()
        os.symlink = Replaced(self._symlink, "symlink")  # type: ignore[assignment]
        os.write = Replaced(self._write, "write")  # type: ignore[assignment]
        os.close = Replaced(self._close, "close")  # type: ignore[assignment]

    def call(self, function: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
        try:
            return function(*arguments, **options)
        except NotADirectoryError:
            if function is _real["listdir"] or function is _real["scandir"]:
                raise
            # A path through a file, here, and on Windows a path that is not there.
            raise error(_NOT_FOUND, arguments[0]) from None

    def check_open(self, path: Any, writes: bool) -> None:
        """Check that a file may be opened.

        :raises PermissionError: for a directory, and a read-only file that is to be written
        """
        if isinstance(path, str) and (_is_directory(os.path.realpath(path)) or (writes and _read_only(path))):
            raise PermissionError(errno.EACCES, "Permission denied", path)

    def _open(self, path: Any, flags: int, mode: int = 0o777, *, dir_fd: int | None = None) -> int:
        path = self.names(path)
        ours = caller() is Owner.OURS
        if ours:
            self.check_open(path, bool(flags & (os.O_WRONLY | os.O_RDWR)))
        descriptor: int = self.call(_os_open, path, flags & 0xFFFFFF, mode)
        if ours and not flags & O_BINARY:
            self._text_descriptors.add(descriptor)
        return descriptor

    def _write(self, descriptor: int, data: Any) -> int:
        if descriptor in self._text_descriptors and caller() is Owner.OURS:
            _real["write"](descriptor, bytes(data).replace(b"\n", b"\r\n"))
            return len(data)
        return int(_real["write"](descriptor, data))

    def _close(self, descriptor: int) -> None:
        self._text_descriptors.discard(descriptor)
        _close(descriptor)

    def _remove(self, path: Any, *, dir_fd: int | None = None) -> None:
        path = self.names(path)
        if _is_directory(path) or _read_only(path):
            raise error(_DENIED, path)
        # What `tempfile` opens, and removes at once, Windows itself removes when it is closed.
        if is_open(path) and not sys._getframe(2).f_code.co_filename.endswith("/tempfile.py"):
            raise error(_IN_USE, path)
        self.call(_real["unlink"], path)

    _unlink = _remove

    def _rmdir(self, path: Any, *, dir_fd: int | None = None) -> None:
        path = self.names(path)
        if _is_directory(path) and not _listdir(path) and _in_use(path):
            raise error(_IN_USE, path)
        self.call(_real["rmdir"], path)

    def _rename(self, source: Any, target: Any, **options: Any) -> None:
        new = self.names(target)
        if _lexists(new) and not os.path.samefile(self.names(source), new):
            raise error(_EXISTS, source, target)
        self._replace(source, target)

    def _replace(self, source: Any, target: Any, **options: Any) -> None:
        old, new = self.names(source), self.names(target)
        if _lexists(new):
            if os.path.realpath(old) == os.path.realpath(new):
                new = os.fspath(target)
            elif _is_directory(new) or os.path.islink(new) or _read_only(new) or is_open(new):
                raise error(_DENIED, source, target)
        if _in_use(old):
            raise error(_DENIED if _is_directory(old) else _IN_USE, source, target)
        self.call(_real["replace"], old, new)

    def _symlink(self, source: Any, target: Any, *arguments: Any, **options: Any) -> None:
        raise error(_NO_PRIVILEGE, source, target)

    def _chmod(self, path: Any, mode: int, **options: Any) -> None:
        """Only whether a file is read-only can be changed."""
        path = self.names(path)
        if caller() is Owner.OURS:
            before = os.stat(path).st_mode
            mode = before | 0o222 if mode & stat.S_IWUSR or stat.S_ISDIR(before) else before & ~0o222
        self.call(_real["chmod"], path, stat.S_IMODE(mode))

    def _readlink(self, path: Any, **options: Any) -> Any:
        target = self.call(_real["readlink"], self.names(path))
        # Python's own `realpath` of Linux asks, too.
        direct = sys._getframe(2).f_code.co_filename
        return _LONG + target if isinstance(target, str) and not direct.endswith("posixpath.py") else target


#: Windows' flag for `os.open`, which Linux does not have.
O_BINARY = 1 << 28


def _lexists(path: Any) -> bool:
    try:
        _lstat(path)
    except OSError:
        return False
    return True


def make_junction(target: str, link: str) -> None:
    """Make what Windows has in place of a link to a directory, for everyone."""
    _real["symlink"](os.path.abspath(target), link)


class Open:
    """What `open` does.

    :param files: the system's, for the file's name
    :param text: changes the encoding and the line ends of text
    """

    def __init__(self, files: CaseInsensitive, text: Callable[[str, Any, Any], tuple[Any, Any]] | None = None) -> None:
        self._files = files
        self._text = text

    def install(self) -> None:
        io.open = builtins.open = self  # type: ignore[assignment]

    def __call__(
        self,
        file: Any,
        mode: str = "r",
        buffering: int = -1,
        encoding: str | None = None,
        errors: str | None = None,
        newline: str | None = None,
        closefd: bool = True,
        opener: Any = None,
    ) -> Any:
        file = self._files.names(file)
        if isinstance(self._files, WindowsFiles) and opener is None:
            self._files.check_open(file, any(letter in mode for letter in "wax+"))
        if self._text is not None and "b" not in mode:
            encoding, newline = self._text(mode, encoding, newline)
        return self._files.call(_real_open, file, mode, buffering, encoding, errors, newline, closefd, opener)
