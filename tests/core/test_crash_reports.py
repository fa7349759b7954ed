"""What a process leaves behind when it ends too early, and how that is described: the user's line first."""

from __future__ import annotations

import os
import signal
import sys
import tempfile
from pathlib import Path

import pytest

from pyfrc_core.processes import crash_report
from pyfrc_core.processes import exit as process_exit
from pyfrc_core.processes.crash_report import CrashLog, Moment, describe_exit, moment_of, write_all
from pyfrc_core.processes.exit import EXIT_HANGS
from pyfrc_core.processes.fork import FORK_IS_SAFE, Fork
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
        (-9, "the robot's process was ended by signal 9 (SIGKILL)"),
        (-99, "the robot's process was ended by signal 99 (unknown)"),
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
    assert moment_of(contents(log)) == Moment(0, "autonomous")
    log.time_us[0] = 15_020_000
    log.set_mode("teleop")
    assert str(moment_of(contents(log))) == "at 15.02 s in teleop mode"
    log.set_mode("x" * 50)
    assert moment_of(contents(log)) == Moment(15.02, "x" * 32)
    log.write("and a text")
    assert describe_exit(contents(log), 3, FILES, "meanwhile") == (
        f"the robot's process ended itself with exit code 3, meanwhile, at 15.02 s in {'x' * 32} mode\n\nand a text"
    )
    os.close(log.descriptor)


def test_what_is_no_moment() -> None:
    assert moment_of(b"") is None
    assert moment_of(b"Fatal Python error" * 10) is None
    assert moment_of(b"\0moment\n" + b"\0" * 39) is None
    assert moment_of(b"\0moment\n" + b"\0" * 40) == Moment(0, "")


def test_all_is_written_though_the_system_takes_a_part(monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[bytes] = []

    def write(descriptor: int, data: bytes) -> int:
        taken.append(data[:3])
        return len(taken[-1])

    monkeypatch.setattr(os, "write", write)
    write_all(9, b"abcdefgh")
    assert taken == [b"abc", b"def", b"gh"]


@pytest.mark.skipif(not FORK_IS_SAFE, reason="no fork")
def test_an_exit_of_robot_code_is_reported_and_what_has_to_happen_before_happens() -> None:
    def work(send: object) -> None:
        log = CrashLog(descriptor)
        log.enable()
        process_exit.before_sudden_exit["mark"] = lambda: log.write("saved")
        os._exit(5)

    with tempfile.TemporaryFile(buffering=0) as file:
        descriptor = file.fileno()
        fork = Fork(work)
        while not fork.finished:
            fork.poll()
        assert fork.status == 5
        report = os.pread(descriptor, 1 << 16, 0)
    line = work.__code__.co_firstlineno + 4
    text = f'os._exit(5) was called:\n  File "{__file__}", line {line} in work\nsaved'
    assert report.endswith(text.encode())


@pytest.mark.skipif(not FORK_IS_SAFE, reason="no fork")
def test_a_fault_in_c_code_leaves_its_stack() -> None:
    def work(send: object) -> None:
        CrashLog(descriptor).enable()
        os.kill(os.getpid(), signal.SIGSEGV)

    with tempfile.TemporaryFile(buffering=0) as file:
        descriptor = file.fileno()
        fork = Fork(work)
        while not fork.finished:
            fork.poll()
        assert fork.status == -signal.SIGSEGV
        report = os.pread(descriptor, 1 << 16, 0)
    described = describe_exit(report, fork.status, RobotFiles(Path(__file__).parent), "meanwhile")
    assert described.startswith(f"test_crash_reports.py:{work.__code__.co_firstlineno + 2}: the robot's process was")
