"""What a process leaves behind when it ends too early, and how that is described: the user's line first."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from pyfrc_core.processes import crash_report
from pyfrc_core.processes.crash_report import CrashLog, MomentOfExit, describe_exit, moment_of, standstill_of
from pyfrc_core.processes.exit import EXIT_HANGS
from pyfrc_core.project.robot_files import RobotFiles

PROJECT = Path("/home/user/project")
FILES = RobotFiles(PROJECT)
OURS = crash_report.__file__


def stack(*lines: str) -> bytes:
    return "\n".join(lines).encode()


SEGFAULT = stack(
    "Fatal Python error: Segmentation fault",
    "",
    "Current thread 0x00007f0000000001 (most recent call first):",
    '  File "/usr/lib/python3/ctypes/__init__.py", line 519 in string_at',
    f'  File "{PROJECT}/drive.py", line 12 in read',
    f'  File "{PROJECT}/robot.py", line 30 in teleopPeriodic',
    f'  File "{OURS}", line 80 in turn',
    '  File "/usr/lib/python3/_pytest/python.py", line 159 in call',
)


def test_a_fault_names_the_innermost_line_of_the_user() -> None:
    text = describe_exit(SEGFAULT, -11, FILES, "in the middle of the test")
    first, _, rest = text.partition("\n\n")
    assert first == "drive.py:12: the robot's process was ended by signal 11 (SIGSEGV, segmentation fault)"
    assert rest.startswith("Fatal Python error: Segmentation fault")
    assert rest.endswith(f'  File "{PROJECT}/robot.py", line 30 in teleopPeriodic')  # what is ours is left out


def test_threads_that_only_wait_for_their_turn_are_passed_over() -> None:
    report = stack(
        "Timeout (0:01:00)!",
        "Thread 0x00007f0000000002 (most recent call first):",
        f'  File "{OURS}", line 80 in wait',
        f'  File "{PROJECT}/robot.py", line 5 in waiting',
        "Thread 0x00007f0000000001 (most recent call first):",
        f'  File "{PROJECT}/robot.py", line 7 in computing',
    )
    assert describe_exit(report, 1, FILES, "meanwhile").startswith(
        "robot.py:7: the robot code hangs here, in a call that lets nothing else of Python run\n\nTimeout"
    )


@pytest.mark.parametrize(
    ("status", "what"),
    [
        pytest.param(
            -9,
            "the robot's process was ended by signal 9 (SIGKILL)",
            marks=pytest.mark.skipif(sys.platform == "win32", reason="there are no signals"),
        ),
        (-99, "the robot's process was ended by signal 99 (unknown)"),
        (0xC0000005, "the robot's process was ended by exception 0xC0000005 (access violation)"),  # on Windows
        (0xC0000FFF, "the robot's process was ended by exception 0xC0000FFF (unknown)"),
        (0, "the robot's process ended itself with exit code 0, in the middle of the test"),
        (7, "the robot's process ended itself with exit code 7, in the middle of the test"),
        (EXIT_HANGS, f"the robot's process ended itself with exit code {EXIT_HANGS}, in the middle of the test"),
    ],
)
def test_without_a_report_there_is_only_the_exit(status: int, what: str) -> None:
    assert describe_exit(b"", status, FILES, "in the middle of the test") == what


def test_what_was_written_of_code_that_hangs_is_all_that_is_said() -> None:
    assert (
        describe_exit(b"robot.py:3: it hangs\nWhy?\n", EXIT_HANGS, FILES, "meanwhile") == "robot.py:3: it hangs\nWhy?"
    )
    assert describe_exit(b"robot.py:3: it hangs", 1, FILES, "meanwhile").startswith("the robot's process ended itself")


def test_a_traceback_is_shown_whole() -> None:
    traceback = stack("Traceback (most recent call last):", f'  File "{OURS}", line 3, in f', "KeyError: 'a'")
    assert describe_exit(traceback, 1, FILES, "meanwhile").endswith("KeyError: 'a'")
    assert OURS in describe_exit(traceback, 1, FILES, "meanwhile")


# -- the moment --------------------------------------------------------------------------------------------------------


@pytest.fixture
def log(monkeypatch: pytest.MonkeyPatch) -> CrashLog:
    """A log whose faults are not this process's."""
    monkeypatch.setattr(os, "_exit", os._exit)
    monkeypatch.setattr(CrashLog, "enable_fault_handler", lambda log: None)
    return CrashLog(os.memfd_create("crash"))


def contents(log: CrashLog) -> bytes:
    return os.pread(log.descriptor, 1 << 16, 0)


@pytest.mark.skipif(sys.platform != "linux", reason="a file in memory")
def test_a_moment_counts_once_the_robot_has_started(log: CrashLog) -> None:
    log.set_mode("teleop")  # before there is a moment
    log.enable()
    assert moment_of(contents(log)) is None
    log.set_mode("autonomous")
    assert moment_of(contents(log)) is None
    assert log.time_us is not None
    log.time_us[0] = 0
    assert moment_of(contents(log)) == MomentOfExit(0, "autonomous")
    log.time_us[0] = 15_020_000
    log.set_mode("teleop")
    assert str(moment_of(contents(log))) == "at 15.02 s in teleop mode"
    log.set_mode("x" * 50)
    assert moment_of(contents(log)) == MomentOfExit(15.02, "x" * 32)
    log.write("and a text")
    assert describe_exit(contents(log), 3, FILES, "meanwhile") == (
        f"the robot's process ended itself with exit code 3, meanwhile, at 15.02 s in {'x' * 32} mode\n\nand a text"
    )
    os.close(log.descriptor)


@pytest.mark.skipif(sys.platform != "linux", reason="a file in memory")
def test_stacks_of_code_that_runs_again_do_not_count_any_more(log: CrashLog, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is removed from the file: on Windows, a mapped file cannot be made shorter."""
    monkeypatch.setattr(os, "ftruncate", None)
    waiting = f'Timeout (0:00:03)!\nThread 0x1 (most recent call first):\n  File "{PROJECT}/robot.py", line 7 in read\n'
    log.enable()
    log.forget_stacks()
    for _ in range(2):
        assert standstill_of(contents(log), FILES) is None
        for count in (1, 2, 3):
            log.write(waiting)
            stands = standstill_of(contents(log), FILES)
            assert stands is not None
            assert (stands.place, stands.seconds, stands.hopeless) == ("robot.py:7", 3.0 * count, count == 3)
        log.forget_stacks()
        forgotten = contents(log)
        log.forget_stacks()
        assert contents(log) == forgotten, "it is written once"
    log.write("os._exit(3) was called")
    assert describe_exit(contents(log), 3, FILES, "meanwhile").endswith("meanwhile\n\nos._exit(3) was called")
    os.close(log.descriptor)
