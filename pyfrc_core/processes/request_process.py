"""A new interpreter that handles requests, one at a time, for a process that must not be forked and has threads."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from . import spawn
from .frames import encode, read_frame

#: Returns the result of a request; both can be pickled.
Handler = Callable[[Any], object]


class RequestProcess:
    """A new interpreter that handles requests until this process ends.

    :param handle: called there for each request; it can be pickled
    :param environment: variables that differ from this process's
    """

    def __init__(self, handle: Handler, environment: Mapping[str, str]) -> None:
        # It ends with its standard input: the thread that starts it may end before this process.
        how = spawn.Start(
            partial(_serve, handle), stdout=subprocess.PIPE, environment=environment, ends_with_owner=False
        )
        self._process = spawn.open_interpreter(how)

    @property
    def pid(self) -> int:
        return self._process.pid

    def request(self, content: object) -> Any:
        """Return the result of a request.

        :raises EOFError: when the process has ended
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with suppress(OSError):  # it has ended, which reading its result shows
            self._process.stdin.write(encode(content))
            self._process.stdin.flush()
        return read_frame(self._process.stdout)

    def kill(self) -> None:
        """End the process; may be called by any thread: a request that waits then raises."""
        self._process.kill()
        self._process.wait()
        assert self._process.stdin is not None
        with suppress(OSError):  # what was not sent
            self._process.stdin.close()


def _serve(handle: Handler) -> None:
    requests = sys.stdin.buffer
    results = os.fdopen(os.dup(1), "wb")
    # Nothing that is printed is a result, and nothing that is read a request.
    sys.stdin = Path(os.devnull).open(encoding="utf-8")  # noqa: SIM115 - until this process ends
    os.dup2(2, 1)
    with suppress(EOFError):
        while True:
            results.write(encode(handle(read_frame(requests))))
            results.flush()
