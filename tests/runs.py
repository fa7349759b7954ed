"""Which tests run by day and at night, how they are collected, and how long each may take."""

from __future__ import annotations

import faulthandler
import importlib
import os
from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from itertools import chain
from pathlib import Path
from typing import TypeVar

import pytest

from pyfrc_core.collector import collector_paused
from pyfrc_core.season import CURRENT

#: Seconds that one test may take by day and at night, its fixtures included: only a test that hangs takes so long.
TEST_LIMIT, SLOW_TEST_LIMIT = 120.0, 900.0

#: The files with the longest tests, by day and at night.
LONGEST = {
    "test_create_physics",
    "test_deploy_command",
    "test_deploy_installs",
    "test_deploy_over_ssh",
    "test_determinism",
    "test_docs",
    "test_fuzz_campaign",
    "test_fuzz_goes_on",
    "test_migrate_odd_projects",
    "test_remembered_passes",
    "test_sim_log",
    "test_sim_log_competition",
    "test_sim_session",
    "test_sim_web_page_journey",
    "test_sim_window",
    "test_virtual_robot",
}

Test = TypeVar("Test")

_STDERR = pytest.StashKey[int]()

TESTS = Path(__file__).parent


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option for the tests that take long."""
    parser.addoption("--run-slow", action="store_true", help="run the tests that are marked as slow, too")


@pytest.hookimpl(wrapper=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> Generator[None, object, object]:
    """Leave out the slow ones, unless they are asked for: all of them, or one by its name. The longest start first.

    Tests with a browser are slow, but for the one with the mark ``journey``.
    """
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()) and not item.get_closest_marker("journey"):
            item.add_marker("slow")
    if not config.getoption("run_slow") and not any("::" in each for each in config.args):
        slow = [item for item in items if item.get_closest_marker("slow")]
        config.hook.pytest_deselected(items=slow)
        items[:] = [item for item in items if not item.get_closest_marker("slow")]
    result = yield  # `-m` and others leave out more
    workers = getattr(config, "workerinput", {"workercount": 1})["workercount"]
    items[:] = longest_first(items, lambda item: item.path.stem, workers)
    return result


def longest_first(tests: Sequence[Test], file_of: Callable[[Test], str], workers: int) -> list[Test]:
    """Return the tests so that each worker begins with some of the `LONGEST` files, all tests of a file with one.

    pytest-xdist gives each worker a part of the list, one after the other, and those that have ended their parts take
    over the ends of others.
    """
    files: dict[str, list[Test]] = {}
    for test in tests:
        files.setdefault(file_of(test), []).append(test)
    longest = [files.pop(name) for name in list(files) if name in LONGEST]
    others, ordered = list(chain.from_iterable(files.values())), list[Test]()
    for number in range(workers):
        share = (len(tests) - len(ordered)) // (workers - number)
        first = list(chain.from_iterable(longest[number::workers]))
        rest = max(share - len(first), 0)
        ordered += first + others[:rest]
        del others[:rest]
    return ordered + others


def pytest_configure(config: pytest.Config) -> None:
    """Keep standard error: while a test runs, its own goes to pytest's capture."""
    config.stash[_STDERR] = os.dup(2)


@pytest.hookimpl(wrapper=True)
def pytest_collection(session: pytest.Session) -> Generator[None, object, object]:
    """Collect no garbage while tests are collected: looking through what is made then takes a quarter of the time.

    It stays, and is not looked through later either, here and in forks.
    """
    with collector_paused():
        _import_test_files(session.config)
        return (yield)


def _import_test_files(config: pytest.Config) -> None:
    """Import all test files, each worker from another one on.

    In a new clone, pytest rewrites the assertions of each file for some seconds in all. So each worker does that for a
    part of the files, and reads the others, which are compiled by then.
    """
    worker = getattr(config, "workerinput", None)
    if worker is None or CURRENT.year != 2026 or {Path(each).resolve() for each in config.args} != {TESTS}:
        return
    files = (*TESTS.glob("test_*.py"), *TESTS.glob("core/test_*.py"))
    names = sorted(".".join(file.relative_to(TESTS).with_suffix("").parts) for file in files)
    first = len(names) * int(worker["workerid"].removeprefix("gw")) // worker["workercount"]
    for name in (*names[first:], *names[:first]):
        with suppress(Exception, pytest.skip.Exception):  # collecting it reports that
            importlib.import_module(name)


def pytest_unconfigure(config: pytest.Config) -> None:
    """Close what `pytest_configure` has opened."""
    os.close(config.stash[_STDERR])


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """End this process with the stacks of all its threads when a test takes longer than its limit.

    No wait of a test needs a time limit of its own: this one ends each of them, in fixtures and in C code, too.
    Processes that the test has started see their pipes and sockets close. With xdist, the worker's crash is this
    test's failure.
    """
    limit = SLOW_TEST_LIMIT if item.get_closest_marker("slow") else TEST_LIMIT
    faulthandler.dump_traceback_later(limit, exit=True, file=item.config.stash[_STDERR])
    try:
        return (yield)
    finally:
        faulthandler.cancel_dump_traceback_later()
