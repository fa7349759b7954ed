"""Standard streams for robot code that runs in the same process as the command.

Robot code may replace `sys.stdout` by a recorder of its own, wrap it, or close it. So it gets copies of the streams,
and the command prints to those with which it was started.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from typing import TextIO

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


def _lend(name: str) -> TextIO:
    stream: TextIO = getattr(sys, name)
    if not isinstance(stream, TextIOWrapper):
        return stream
    try:
        descriptor = os.dup(stream.fileno())
    except (OSError, ValueError):  # not a file
        return stream
    copy = open(  # noqa: SIM115, PTH123 - left open: handlers of `logging` may have kept it
        descriptor,
        "w",
        buffering=1 if stream.line_buffering else -1,
        encoding=stream.encoding,
        errors=stream.errors,
    )
    # pytest's, of which it reads the file at any time
    copy.reconfigure(write_through=stream.write_through)
    if stream is getattr(sys, f"__{name}__"):
        setattr(sys, f"__{name}__", copy)
    setattr(sys, name, copy)
    return copy


def print_error(text: str) -> None:
    """Print a line to standard error, while robot code runs, too."""
    with suppress(OSError, ValueError):
        print(text, file=_Lent.own_stderr or sys.stderr, flush=True)
