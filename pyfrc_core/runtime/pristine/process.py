"""What Python and the system keep for the whole process."""

from __future__ import annotations

import logging
import os
import random
import signal
import sys
import threading
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .part import StatePart


class Directory(StatePart):
    """The current directory."""

    def __init__(self) -> None:
        self._before = Path.cwd()

    def restore(self) -> None:
        os.chdir(self._before)

    def left_over(self) -> Iterator[str]:
        if Path.cwd() != self._before:
            yield f"the current directory {Path.cwd()}"


class EnvironmentVariables(StatePart):
    """The environment variables."""

    def __init__(self) -> None:
        self._before = dict(os.environ)

    def restore(self) -> None:
        for name in self._changed():
            if name in self._before:
                os.environ[name] = self._before[name]
            else:
                del os.environ[name]

    def left_over(self) -> Iterator[str]:
        yield from (f"the environment variable {name}" for name in self._changed())

    def _changed(self) -> list[str]:
        names = {*self._before, *os.environ}
        return sorted(name for name in names if os.environ.get(name) != self._before.get(name))


#: Those that a handler can have; the system keeps the others to itself.
_SIGNALS = [number for number in signal.Signals if number in signal.valid_signals()]


class Signals(StatePart):
    """The handlers of signals."""

    def __init__(self) -> None:
        self._before = {number: signal.getsignal(number) for number in _SIGNALS}

    def restore(self) -> None:
        for number in self._changed():
            handler = self._before[number]
            if handler is not None:  # one of C code cannot be had again
                signal.signal(number, handler)

    def left_over(self) -> Iterator[str]:
        yield from (f"the handler of signal {number.name}" for number in self._changed())

    def _changed(self) -> list[signal.Signals]:
        return [number for number, handler in self._before.items() if signal.getsignal(number) != handler]


class Streams(StatePart):
    """The standard streams, and the functions that Python calls at certain events."""

    _NAMES = (
        "stdin",
        "stdout",
        "stderr",
        "__stdin__",
        "__stdout__",
        "__stderr__",
        "excepthook",
        "displayhook",
        "unraisablehook",
        "breakpointhook",
        "dont_write_bytecode",
    )

    def __init__(self) -> None:
        self._owners: list[tuple[Any, str, Any]] = [(sys, name, getattr(sys, name)) for name in self._NAMES]
        self._owners.append((threading, "excepthook", threading.excepthook))
        self._filters = list(warnings.filters)
        self._limit = sys.getrecursionlimit(), sys.getswitchinterval()

    def restore(self) -> None:
        for owner, name, value in self._owners:
            setattr(owner, name, value)
        warnings.filters[:] = self._filters  # type: ignore[index]
        sys.setrecursionlimit(self._limit[0])
        sys.setswitchinterval(self._limit[1])

    def left_over(self) -> Iterator[str]:
        for owner, name, value in self._owners:
            if getattr(owner, name) is not value:
                yield f"{owner.__name__}.{name}"


class Logging(StatePart):
    """The handlers and levels of `logging`."""

    def __init__(self) -> None:
        self._before = {name: _state_of(logger) for name, logger in _loggers().items()}
        self._disabled = logging.root.manager.disable

    def restore(self) -> None:
        logging.disable(self._disabled)
        for name, logger in _loggers().items():
            handlers, filters, level, propagate, disabled = self._before.get(
                name, ((), (), logging.NOTSET, True, False)
            )
            logger.handlers[:], logger.filters[:] = handlers, filters
            logger.setLevel(level)
            logger.propagate, logger.disabled = propagate, disabled

    def left_over(self) -> Iterator[str]:
        for name, logger in _loggers().items():
            if name in self._before and _state_of(logger) != self._before[name]:
                yield f"the logger {name}"


def _loggers() -> dict[str, logging.Logger]:
    found = {name: each for name, each in logging.root.manager.loggerDict.items() if isinstance(each, logging.Logger)}
    return {"root": logging.root, **found}


def _state_of(logger: logging.Logger) -> tuple[tuple[Any, ...], tuple[Any, ...], int, bool, bool]:
    return tuple(logger.handlers), tuple(logger.filters), logger.level, logger.propagate, logger.disabled


class Randomness(StatePart):
    """The state of Python's random generator. Each run seeds numpy's (`seeds`)."""

    def __init__(self) -> None:
        self._before = random.getstate()

    def restore(self) -> None:
        random.setstate(self._before)

    def left_over(self) -> Iterator[str]:
        if random.getstate() != self._before:
            yield "the state of random"
