"""What is said while Python and its libraries take seconds to load, as where a virus scanner reads every file."""

from __future__ import annotations

import io
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from unittest.mock import patch

import pytest
from conftest import MakeProject

from pyfrc_core import display
from pyfrc_core.processes import loading, standstill, worker
from pyfrc_core.processes.crash_report import CrashLog
from pyfrc_core.processes.fork import FORK_IS_SAFE
from pyfrc_core.processes.interpreter import spawn_worker
from pyfrc_core.processes.worker import ForkedWorker, Send
from pyfrc_core.project import find_project
from pyfrc_core.sim.engine import simulation
from pyfrc_core.sim.simulate import SimRequest, simulate
from pyfrc_core.sim.ui import headless

LINE = "still loading WPILib and other libraries"
#: Wall seconds, for what takes a hundredth of that.
PATIENCE = 60


class Printed(io.StringIO):
    """A stream that says when something is written to it."""

    def __init__(self) -> None:
        super().__init__()
        self.written = threading.Event()

    def write(self, text: str) -> int:
        self.written.set()
        return super().write(text)


@pytest.fixture
def at_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (display, loading, headless):
        monkeypatch.setattr(module, "has_terminal", lambda: True)


@contextmanager
def loading_for_a_command(quiet: bool = False) -> Iterator[Printed]:
    """Load what a command needs; what it prints meanwhile."""
    stream = Printed()
    with patch.object(sys, "stderr", stream), loading.loading(quiet):
        yield stream


@pytest.fixture
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is said after seconds is said at once."""
    for module in (standstill, loading):
        monkeypatch.setattr(module, "REPORTED_AFTER", 0.0)


@pytest.mark.usefixtures("at_terminal", "soon")
def test_a_command_that_takes_seconds_to_load_says_so_once() -> None:
    with loading_for_a_command() as stderr:
        assert stderr.written.wait(PATIENCE)
    assert stderr.getvalue().count(LINE) == 1
    assert stderr.getvalue().endswith("\n")
    assert all(not isinstance(thread, threading.Timer) for thread in threading.enumerate())


@pytest.mark.usefixtures("at_terminal")
def test_a_command_that_loads_quickly_says_nothing() -> None:
    with loading_for_a_command() as stderr:
        pass
    assert stderr.getvalue() == ""
    assert all(not isinstance(thread, threading.Timer) for thread in threading.enumerate())


@pytest.mark.usefixtures("at_terminal", "soon")
def test_nothing_is_said_when_the_user_wants_it_quiet() -> None:
    with loading_for_a_command(quiet=True) as stderr:
        assert all(not isinstance(thread, threading.Timer) for thread in threading.enumerate())
    assert stderr.getvalue() == ""


def begin_a_robot(go: Path, send: Send, log: CrashLog) -> None:
    while not go.exists():
        time.sleep(0.01)
    assert log.time_us is not None
    log.time_us[0] = 0
    send("begun")
    while go.exists():
        time.sleep(0.01)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr(worker, "_now", lambda: now[0])
    return now


def test_an_interpreter_is_loading_until_its_robot_begins(tmp_path: Path, clock: list[float]) -> None:
    go = tmp_path / "go"
    process = spawn_worker(partial(begin_a_robot, go))
    try:
        clock[0] = 102.5
        assert process.loading() is None
        clock[0] = 103.5
        stands = process.loading()
        assert stands is not None
        assert stands.text("tests/test_it.py::test_it").startswith(f"{LINE} for tests/test_it.py::test_it, after 4 s (")
        go.touch()
        while process.loading() is not None:
            worker.wait_for_any([process])
            assert not process.finished
        go.unlink()
        process.wait()
        assert list(process.messages()) == ["begun"]
    finally:
        process.close()


@pytest.mark.skipif(not FORK_IS_SAFE, reason="no fork")
def test_a_fork_has_nothing_to_load(clock: list[float]) -> None:
    process = ForkedWorker(lambda send, log: None)
    clock[0] = 200.0
    assert process.loading() is None
    process.close()


ROBOT = """
    import time
    from pathlib import Path

    while not Path(__file__).with_name("go").exists():  # as long as it takes a virus scanner to read WPILib
        time.sleep(0.01)

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""


@pytest.mark.usefixtures("at_terminal", "soon")
@pytest.mark.parametrize("quiet", [False, True])
def test_a_simulated_robot_that_takes_seconds_to_start(
    quiet: bool, make_project: MakeProject, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(simulation, "_SILENCE", 0.0)
    project = make_project({"robot.py": ROBOT})
    said: list[str] = []

    def say(text: str) -> None:
        said.append(text)
        if LINE in text:
            (project.path / "go").touch()

    if quiet:
        (project.path / "go").touch()
    request = SimRequest(ui="none", mode="teleop", seconds=0.1, quiet=quiet)
    assert simulate(find_project(project.path), request, say) == 0
    assert "".join(said).count(LINE) == (0 if quiet else 1)
