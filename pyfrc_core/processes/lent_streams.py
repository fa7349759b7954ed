"""Standard streams for robot code that runs in the same process as the command.

Robot code may replace `sys.stdout` by a recorder of its own, wrap it, or close it. So it gets copies of the streams,
and the command prints to those with which it was started.
"""

from __future__ import annotations

import os
import sys
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from typing import Any, TextIO

from .exit import flush_output

_NAMES = ("stdout", "stderr", "__stdout__", "__stderr__")


class _Lent:
    #: Where pyfrc writes errors meanwhile; None: to `sys.stderr`.
    own_stderr: TextIO | None = None


@contextmanager
def lent_streams() -> Iterator[None]:
    """Lend copies of the standard streams; afterwards, those from before are in place again."""
    before = {name: getattr(sys, name) for name in _NAMES}
    own_before, _Lent.own_stderr = _Lent.own_stderr, _Lent.own_stderr or sys.stderr
    flush_output()
    lent = [_lend(name) for name in ("stdout", "stderr")]
    try:
        yield
    finally:
        flush_output()
        for stream in lent:
            with suppress(OSError, ValueError):  # closed
                stream.flush()
        for name, stream in before.items():
            setattr(sys, name, stream)
        _Lent.own_stderr = own_before


def replace_streams(make: Callable[[TextIO], Any]) -> None:
    """Have robot code print to what `make` returns for each stream. pyfrc writes its errors to that from before."""
    _Lent.own_stderr = _Lent.own_stderr or sys.stderr
    for name in ("stdout", "stderr"):
        setattr(sys, name, make(getattr(sys, name)))


def _lend(name: str) -> TextIO:
    stream: TextIO = getattr(sys, name)
    if not isinstance(stream, TextIOWrapper):
        return stream
    try:
        descriptor = os.dup(stream.fileno())
    except (OSError, ValueError):  # not a file
        return stream
    # pytest's is written through, since its file is read at any time: nothing may wait when the process dies.
    file = open(descriptor, "wb", 0 if stream.write_through else -1, closefd=False)  # noqa: SIM115
    copy = TextIOWrapper(
        file,
        encoding=stream.encoding,
        errors=stream.errors,
        line_buffering=stream.line_buffering,
        write_through=stream.write_through,
    )
    # Handlers of `logging` may keep it: its descriptor is closed with the last reference.
    weakref.finalize(copy, _close, descriptor).atexit = False
    if stream is getattr(sys, f"__{name}__"):
        setattr(sys, f"__{name}__", copy)
    setattr(sys, name, copy)
    return copy


def _close(descriptor: int) -> None:
    with suppress(OSError):
        os.close(descriptor)


def print_error(text: str) -> None:
    """Print a line to standard error, while robot code runs, too."""
    with suppress(OSError, ValueError):
        print(text, file=_Lent.own_stderr or sys.stderr, flush=True)
