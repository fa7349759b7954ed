"""Records which lines of pyfrc each test runs, in every process that the test starts; `tests/mutants.py` uses it.

Each interpreter of the environment that `mutants.py` makes imports this module at its start. An environment variable
names the running test's file; commands, forks and agents inherit it. Each line is written when it first runs, so a
process that is killed has written what it ran. `sys.monitoring` reports the lines, which needs Python 3.12: a tracer
would disturb the tests of coverage and profiles, which need it themselves.

pytest warns of a plugin that is imported before it, unless it reads here: PYTEST_DONT_REWRITE
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import CodeType
from typing import Any
from zlib import crc32

#: The environment variable with the name of the running test's file.
FILE = "MUTANTS_FILE"
#: The one with the directory of these files.
DIRECTORY = "MUTANTS_DIRECTORY"
#: The one with the file that names the tests to run, a line each, in this order.
SELECTED = "MUTANTS_SELECTED"

#: `pyfrc fuzz` uses 4.
_TOOL = 3
_PACKAGES = ("pyfrc", "pyfrc_cli", "pyfrc_core")

# Taken before a test replaces them.
_open, _write, _close = os.open, os.write, os.close


def record(tree: str) -> None:
    """Record the lines of the pyfrc in this directory, as long as this process lives."""
    monitoring: Any = sys.monitoring  # type: ignore[attr-defined,unused-ignore]
    events = monitoring.events
    if monitoring.get_tool(_TOOL) is not None:  # this interpreter reads its .pth files once more
        return
    # The agent's modules have their names as file names.
    ours = tuple(f"{tree}/{each}/" for each in _PACKAGES) + tuple(f"{each}." for each in _PACKAGES)

    def on_start(code: CodeType, offset: int) -> object:
        if code.co_filename.startswith(ours):
            monitoring.set_local_events(_TOOL, code, events.LINE)
        return monitoring.DISABLE

    def on_line(code: CodeType, number: int) -> object:
        if file := os.environ.get(FILE):
            _append(file, f"{code.co_filename.removeprefix(tree + '/')}:{number}\n")
        return monitoring.DISABLE

    monitoring.use_tool_id(_TOOL, "pyfrc's mutants")
    monitoring.register_callback(_TOOL, events.PY_START, on_start)
    monitoring.register_callback(_TOOL, events.LINE, on_line)
    monitoring.set_events(_TOOL, events.PY_START)
    os.register_at_fork(after_in_child=monitoring.restart_events)


def _append(file: str, text: str) -> None:
    # Opened each time: some tests count the open files of this process.
    descriptor = _open(file, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
    _write(descriptor, text.encode())
    _close(descriptor)


# -- as a plugin of pytest ---------------------------------------------------------------------------------------------


def _file_of(nodeid: str) -> str:
    return f"{os.environ[DIRECTORY]}/{crc32(nodeid.encode()):08x}"


def pytest_runtest_logstart(nodeid: str) -> None:
    """Record for this test from now on."""
    if DIRECTORY in os.environ:
        file = os.environ[FILE] = _file_of(nodeid)
        _append(file, f"= {nodeid}\n")
        sys.monitoring.restart_events()  # type: ignore[attr-defined,unused-ignore]


def pytest_runtest_logreport(report: Any) -> None:
    """Note how long this part of the test took, in seconds, and its outcome."""
    if DIRECTORY in os.environ:
        _append(_file_of(report.nodeid), f"@ {report.when} {report.outcome} {report.duration:.3f}\n")


def pytest_runtest_logfinish(nodeid: str) -> None:
    """Record no more."""
    os.environ.pop(FILE, None)


def pytest_collection_modifyitems(items: list[Any]) -> None:
    """Keep the selected tests, in their order."""
    if SELECTED in os.environ:
        names = Path(os.environ[SELECTED]).read_text("utf-8").splitlines()
        position = {name: number for number, name in enumerate(names)}
        items[:] = sorted((item for item in items if item.nodeid in position), key=lambda item: position[item.nodeid])
