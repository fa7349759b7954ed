"""A disk that fails from any step of the agent on: full, or read-only, as after an error."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from pyfrc_core.deploy.agent import disk

_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT
_ADDING = frozenset({"open", "os.mkdir", "os.link", "os.symlink", "os.rename", "sync"})
#: What fails, by the error that it fails with.
FAILS = {
    errno.ENOSPC: _ADDING,
    errno.EROFS: _ADDING | {"os.remove", "os.rmdir", "os.chmod", "os.utime", "os.truncate"},
}


class FailingDisk:
    """Counts steps, and fails from the first one on."""

    def __init__(self, number: int, first: int) -> None:
        self._number = number
        self._first = first
        self._steps = 0

    @property
    def has_failed(self) -> bool:
        return self._steps >= self._first

    def step(self, event: str, file: Any = None) -> None:
        """Do the next step, if it is one."""
        if event in FAILS[self._number]:
            self._steps += 1
            if self.has_failed:
                raise OSError(self._number, os.strerror(self._number), file if isinstance(file, str) else None)


_active: FailingDisk | None = None


def _hook(event: str, args: Any) -> None:
    if _active is not None and (event != "open" or (args[2] or 0) & _WRITING):
        _active.step(event, args[0] if args else None)


sys.addaudithook(_hook)


@contextmanager
def failing(number: int, first: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[FailingDisk]:
    """Let each step of the code within fail from the first one on.

    :param number: of the error
    """
    global _active
    failing = FailingDisk(number, first)
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", lambda file: failing.step("sync"))
        patch.setattr(disk, "flush", lambda directory: failing.step("sync"))
        patch.delattr(os, "fork")  # the agent compiles by itself then
        _active = failing
        try:
            yield failing
        finally:
            _active = None
