"""What a test can change of Python's process: each part is put back, and named where that was not possible."""

from __future__ import annotations

import logging
import os
import random
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from pyfrc_core.runtime.pristine.part import StatePart
from pyfrc_core.runtime.pristine.process import Directory, EnvironmentVariables, Logging, Randomness, Signals, Streams

NEW = "PYFRC_TEST_NEW"


@pytest.fixture(autouse=True)
def _put_back(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """Whatever a part does not put back, this does."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYFRC_TEST_THERE", "before")
    monkeypatch.delenv(NEW, raising=False)
    handler, state, limit = signal.getsignal(signal.SIGUSR2), random.getstate(), sys.getrecursionlimit()
    streams, filters, interval = (sys.stdout, threading.excepthook), list(warnings.filters), sys.getswitchinterval()
    yield
    signal.signal(signal.SIGUSR2, handler)
    random.setstate(state)
    sys.setrecursionlimit(limit)
    sys.setswitchinterval(interval)
    sys.stdout, threading.excepthook = streams
    warnings.filters[:] = filters  # type: ignore[index]
    logging.disable(logging.NOTSET)


def _handler(number: int, frame: object) -> None: ...


def _elsewhere() -> None:
    Path("below").mkdir()
    os.chdir("below")


def _variables() -> None:
    os.environ[NEW] = "x"
    os.environ["PYFRC_TEST_THERE"] = "after"


def _streams() -> None:
    sys.stdout = sys.__stderr__
    threading.excepthook = lambda args: None


@pytest.mark.parametrize(
    ("part", "change", "named"),
    [
        (Directory, _elsewhere, ["the current directory {below}"]),
        (
            EnvironmentVariables,
            _variables,
            [f"the environment variable {NEW}", "the environment variable PYFRC_TEST_THERE"],
        ),
        (
            EnvironmentVariables,
            lambda: os.environ.pop("PYFRC_TEST_THERE"),
            ["the environment variable PYFRC_TEST_THERE"],
        ),
        (Signals, lambda: signal.signal(signal.SIGUSR2, _handler), ["the handler of signal SIGUSR2"]),
        (Streams, _streams, ["sys.stdout", "threading.excepthook"]),
        (Randomness, random.random, ["the state of random"]),
    ],
)
def test_a_change_is_named_until_it_is_put_back(
    part: Callable[[], StatePart], change: Callable[[], object], named: list[str], tmp_path: Path
) -> None:
    before = dict(os.environ), Path.cwd(), signal.getsignal(signal.SIGUSR2), sys.stdout, random.getstate()
    made = part()
    assert list(made.left_over()) == []
    change()
    assert list(made.left_over()) == [each.format(below=tmp_path / "below") for each in named]
    made.restore()
    assert list(made.left_over()) == []
    assert (dict(os.environ), Path.cwd(), signal.getsignal(signal.SIGUSR2), sys.stdout, random.getstate()) == before


def test_a_handler_of_c_code_cannot_be_put_back() -> None:
    made = Signals()
    made._before[signal.SIGUSR2] = None  # a handler of C code
    signal.signal(signal.SIGUSR2, _handler)
    made.restore()
    assert signal.getsignal(signal.SIGUSR2) is _handler
    assert list(made.left_over()) == ["the handler of signal SIGUSR2"]


def test_limits_and_filters_of_warnings_are_put_back() -> None:
    made = Streams()
    before = sys.getrecursionlimit(), sys.getswitchinterval(), list(warnings.filters)
    sys.setrecursionlimit(before[0] + 1)
    sys.setswitchinterval(0.5)
    warnings.simplefilter("error")
    made.restore()
    assert (sys.getrecursionlimit(), sys.getswitchinterval(), list(warnings.filters)) == before


def test_loggers_are_put_back_and_new_ones_made_plain() -> None:
    there, handler, other = logging.getLogger("pyfrc-test-there"), logging.NullHandler(), logging.NullHandler()
    there.addHandler(handler)
    there.addFilter(refuse := logging.Filter("a"))
    there.setLevel(logging.ERROR)
    made = Logging()
    assert "the logger pyfrc-test-there" not in list(made.left_over())
    there.removeHandler(handler)
    there.addHandler(other)
    there.removeFilter(refuse)
    there.addFilter(logging.Filter("b"))
    there.setLevel(logging.DEBUG)
    there.propagate, there.disabled = False, True
    logging.disable(logging.CRITICAL)
    new = logging.getLogger("pyfrc-test-new")
    new.addHandler(other)
    new.addFilter(refuse)
    new.setLevel(logging.INFO)
    new.propagate, new.disabled = False, True
    assert list(made.left_over()) == ["the logger pyfrc-test-there"]
    made.restore()
    assert list(made.left_over()) == []
    assert (there.handlers, there.filters, there.level) == ([handler], [refuse], logging.ERROR)
    assert (there.propagate, there.disabled) == (True, False)
    assert (new.handlers, new.filters, new.level, new.propagate, new.disabled) == ([], [], logging.NOTSET, True, False)
    assert logging.root.manager.disable == logging.NOTSET
    there.handlers.clear()
    there.filters.clear()
