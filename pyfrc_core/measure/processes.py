"""Measuring in every process of a run: this one, forks of it, and new interpreters.

A fork goes on measuring by itself; a new interpreter finds in its environment that it is to begin. Each keeps what it
has measured when it ends, in a file of its own, which is combined with the others by the process that began it all.
"""

from __future__ import annotations

import importlib
import json
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

from ..runtime import own_process
from ..runtime.forks import Fork
from .replacements import Replacements

#: How processes that are started anew hear of it: an environment variable with the settings as JSON, for each kind.
_KINDS = {"coverage": "PYFRC_COVERAGE", "profile": "PYFRC_PROFILE"}

#: How long a process that is ended may take to keep what it has measured, in seconds.
_PATIENCE = 0.8

_savers: list[Callable[[], object]] = []
_replaced = Replacements()
_exit_now = own_process.exit_now
_kill = Fork.kill


@contextmanager
def announced(kind: str, settings: dict[str, Any]) -> Iterator[None]:
    """Measure in this process, and have those that are started while this lasts do so, too.

    :param kind: the module of this package that does it
    :param settings: what its `begin` is given, here and there
    """
    os.environ[_KINDS[kind]] = json.dumps(settings)
    try:
        save = _begin(kind, settings)
        try:
            yield
        finally:
            save()
            _savers.remove(save)
    finally:
        del os.environ[_KINDS[kind]]
        if not _savers:
            _replaced.undo()


def is_announced(kind: str) -> bool:
    """Whether this process, or the one that started it, measures already."""
    return _KINDS[kind] in os.environ


def measure_here() -> None:
    """Measure in this new interpreter, if it is part of a run that is measured."""
    for kind, variable in _KINDS.items():
        if variable in os.environ:
            _begin(kind, json.loads(os.environ[variable]))
    if _savers and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, lambda number, frame: _save_and_exit(128 + number))


def save_here() -> None:
    """Keep what was measured in this process, if anything was."""
    for save in _savers:
        save()


def _begin(kind: str, settings: dict[str, Any]) -> Callable[[], object]:
    # Before those who end processes so bind its name.
    _replaced.replace(own_process, "exit_now", _save_and_exit)
    _replaced.replace(Fork, "kill", _end_gently)
    save: Callable[[], object] = importlib.import_module(f".{kind}", __package__).begin(settings)
    _savers.append(save)
    return save


def _save_and_exit(status: int) -> NoReturn:
    try:
        save_here()
    finally:
        _exit_now(status)


def _end_gently(fork: Fork) -> None:
    """`Fork.kill`, for a process that may have something to keep."""
    until = time.monotonic() + _PATIENCE
    if not fork.finished:
        os.kill(fork._pid, signal.SIGTERM)
    while not fork.finished and time.monotonic() < until:
        fork.poll()
        time.sleep(0.001)
    _kill(fork)
