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
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ..processes import spawn
from ..processes.exit import before_every_exit, exit_by_signal
from ..processes.fork import Fork

#: For each kind, the environment variable that gives new interpreters the settings, as JSON.
_KINDS = {"coverage": "PYFRC_COVERAGE", "profile": "PYFRC_PROFILE"}

#: How long a process that is ended may take to save its measurements, in seconds.
_PATIENCE = 0.8


@contextmanager
def announced(kind: str, settings: dict[str, object]) -> Iterator[None]:
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
            before_every_exit.remove(save)
    finally:
        del os.environ[_KINDS[kind]]
        if not before_every_exit:
            Fork.grace_seconds = 0.0
            spawn.first_calls.remove(measure_here)


def is_announced(kind: str) -> bool:
    """Whether this process, or the one that started it, measures already."""
    return _KINDS[kind] in os.environ


def measure_here() -> None:
    """Measure in this new interpreter, if it is part of a run that is measured."""
    if before_every_exit:  # it does already
        return
    for kind, variable in _KINDS.items():
        if variable in os.environ:
            _begin(kind, json.loads(os.environ[variable]))
    if before_every_exit and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, exit_by_signal)


def _begin(kind: str, settings: dict[str, object]) -> Callable[[], object]:
    Fork.grace_seconds = _PATIENCE
    if measure_here not in spawn.first_calls:
        spawn.first_calls.append(measure_here)
    save: Callable[[], object] = importlib.import_module(f".{kind}", __package__).begin(settings)
    before_every_exit.append(save)
    return save
