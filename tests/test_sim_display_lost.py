"""`pyfrc sim` with a window: what is kept, and what the terminal shows, also when display or terminal vanish."""

from __future__ import annotations

import platform
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from conftest import MakeProject, RobotProject
from sim_robots import PATIENCE, lines_until
from started_commands import StartedCommand
from virtual_display import VirtualDisplay, virtual_display

from pyfrc_core.interruption import ending_like_ctrl_c

pytestmark = pytest.mark.bare

ROBOT = """
    import sys

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        packets = 0

        def robotInit(self):
            print("to the terminal")
            print("an error as well", file=sys.stderr)

        def robotPeriodic(self):
            self.packets += 1
            if self.packets == 10:
                print("ten packets")
"""


START = ("sim", "--ui", "tk", "--nt-port", "0")


@contextmanager
def simulated(project: RobotProject, display: VirtualDisplay) -> Iterator[tuple[StartedCommand, list[str]]]:
    """A window; and what the terminal shows until the robot has seen ten packets."""
    files = ("--record", "run.jsonl", "--wpilog", "run.wpilog")
    with project.start(*START, *files, env=display.variable) as running:
        yield running, lines_until(running.stdout, "ten packets", "failed at")


@pytest.fixture
def screen() -> Iterator[VirtualDisplay]:
    """A display of the test's own, which it may end."""
    with virtual_display() as screen:
        yield screen


def shown_once(output: str) -> None:
    for text in ("to the terminal", "an error as well", "ten packets"):
        assert output.count(text) == 1, output


def files_written(project: RobotProject, output: str) -> None:
    for name in ("run.jsonl", "run.wpilog"):
        assert f"wrote {name}" in output
        assert (project.path / name).stat().st_size
    assert list(project.temporary.iterdir()) == []


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="only the GNU C library calls Python")
def test_the_display_vanishes(make_project: MakeProject) -> None:
    """Xlib ends the process by C's `exit`."""
    project = make_project({"robot.py": ROBOT})
    with virtual_display() as screen, simulated(project, screen) as (running, shown):
        screen.end()
        output = "".join(shown) + running.rest(PATIENCE)[0]
    assert running.wait() == 2, output
    assert output.count("error: the display has gone, and the window with it") == 1
    assert "Traceback" not in output
    shown_once(output)
    files_written(project, output)


def test_ended_by_a_signal(make_project: MakeProject, screen: VirtualDisplay) -> None:
    project = make_project({"robot.py": ROBOT})
    with simulated(project, screen) as (running, shown):
        running.send_signal(signal.SIGTERM)
        output = "".join(shown) + running.rest(PATIENCE)[0]
    assert running.wait() == 0, output
    shown_once(output)
    files_written(project, output)


@pytest.mark.usefixtures("hangup_ends_programs")
def test_the_terminal_is_closed(make_project: MakeProject, screen: VirtualDisplay) -> None:
    """Nothing can be said any more, and the system and the shell send a signal each."""
    project = make_project({"robot.py": ROBOT})
    with simulated(project, screen) as (running, _):
        running.stdout.close()
        running.send_signal(signal.SIGHUP)
        running.send_signal(signal.SIGTERM)
        running.wait(PATIENCE)
    assert (project.path / "run.jsonl").stat().st_size
    assert (project.path / "run.wpilog").stat().st_size
    assert list(project.temporary.iterdir()) == []


def test_tracebacks_reach_the_terminal(make_project: MakeProject, screen: VirtualDisplay) -> None:
    project = make_project({"robot.py": ROBOT.replace("self.packets += 1", 'raise LookupError("no arm")')})
    with simulated(project, screen) as (running, shown):
        running.send_signal(signal.SIGTERM)
        output = "".join(shown) + running.rest(PATIENCE)[0]
    place = project.place("robot.py", "no arm")
    assert output.count("Traceback (most recent call last)") == 1
    assert output.count(f": {place}: LookupError: no arm") == 1
    assert output.count("to the terminal") == 1


def test_a_second_signal_does_not_interrupt_the_writing(tmp_path: Path) -> None:
    with ending_like_ctrl_c() as interruption:
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGTERM)
        interruption.finish()
        signal.raise_signal(signal.SIGINT)
