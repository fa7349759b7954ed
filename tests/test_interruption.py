"""How commands end: by Ctrl-C and other signals, and with WPILib's threads still running. What is left behind."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import MakeProject, sampled

from pyfrc_core.interruption import Interruption, interruption
from pyfrc_core.project import Project
from pyfrc_core.runtime.loading import load_robot
from pyfrc_core.temporary import temporary_directory

pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals for one process"),
    pytest.mark.usefixtures("hangup_ends_programs"),
]

EXIT_CODES = {"SIGINT": 130, "SIGTERM": 143, "SIGHUP": 129}


@pytest.fixture
def handled() -> Iterator[Interruption]:
    """Signals of this process, handled as in a command."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    made = Interruption()
    made.begin()
    yield made
    for number, handler in before.items():
        signal.signal(number, handler)


def send(name: str) -> None:
    os.kill(os.getpid(), getattr(signal, name))


@pytest.mark.parametrize("name", EXIT_CODES)
def test_each_signal_raises_and_has_its_exit_code(name: str, handled: Interruption) -> None:
    assert handled.exit_code(1) == 1
    with pytest.raises(KeyboardInterrupt):
        send(name)
    assert handled.exit_code(1) == EXIT_CODES[name]


def test_ctrl_c_again_raises_again_and_the_first_signal_counts(handled: Interruption) -> None:
    for name in ("SIGINT", "SIGINT", "SIGTERM"):
        with pytest.raises(KeyboardInterrupt):
            send(name)
    assert handled.exit_code(0) == 130


def test_a_closed_terminal_is_reported_twice_and_raises_once(handled: Interruption) -> None:
    with pytest.raises(KeyboardInterrupt):
        send("SIGHUP")
    send("SIGHUP")
    assert handled.exit_code(0) == 129


def test_a_signal_while_files_are_written_changes_nothing(handled: Interruption) -> None:
    handled.finish()
    send("SIGTERM")
    assert handled.exit_code(0) == 0


def test_a_function_is_called_instead_in_event_loops(handled: Interruption) -> None:
    calls: list[int] = []
    with handled.calling(lambda: calls.append(1)):
        send("SIGTERM")
    assert (calls, handled.exit_code(0)) == ([1], 143)


def test_signals_that_nohup_ignores_stay_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        Interruption().begin()
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)


@pytest.mark.usefixtures("handled")
def test_what_robot_code_forks_ends_by_signals() -> None:
    context = multiprocessing.get_context("fork")
    handlers = context.SimpleQueue()

    def report() -> None:
        handlers.put([signal.getsignal(getattr(signal, name)) is signal.SIG_DFL for name in EXIT_CODES])

    process = context.Process(target=report)
    process.start()
    assert handlers.get() == [False, True, True]  # Ctrl-C raises KeyboardInterrupt, as usual in Python
    process.join()


@pytest.mark.parametrize("raised", ["KeyboardInterrupt", "ImportError('initialization failed')"])
def test_an_import_that_was_interrupted_is_no_fault_of_the_robot(
    raised: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A library in C++ reports it as a failed import."""
    monkeypatch.setattr(interruption, "number", signal.SIGINT)
    robot = tmp_path / "interrupted_robot.py"
    robot.write_text(f"raise {raised}\n")
    with pytest.raises(KeyboardInterrupt):
        load_robot(Project(robot))


@pytest.mark.parametrize(
    "line",
    sampled(
        ["SIGHUP coverage test", "SIGINT replay script.jsonl", "SIGTERM test"],
        "SIGHUP coverage test",
        "SIGINT replay script.jsonl",
    ),
)
def test_a_command_that_is_interrupted_while_the_robot_is_imported(line: str, make_project: MakeProject) -> None:
    name, *words = line.split()
    robot = f"import os, signal, threading\nos.kill(os.getpid(), signal.{name})\nthreading.Event().wait()\n"
    test = "def test_nothing(robot): pass\n"
    made = make_project({"robot.py": robot, "tests/test_robot.py": test, "script.jsonl": SCRIPT})
    result = made.run(*words)
    assert (result.code, result.complaints.strip()) == (EXIT_CODES[name], "interrupted"), result.output
    assert "Traceback" not in result.output
    assert "robot.py:" not in result.stderr
    assert list(made.temporary.iterdir()) == []


SCRIPT = '{"format": "pyfrc-input 1", "robot": "robot.py", "seed": 0, "end": 0.5}\n'

LISTENS = """
    import ntcore
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            tables = ntcore.NetworkTableInstance.getDefault()
            topic = tables.getDoubleTopic("/tune/p")
            self.published = topic.publish()
            self.published.set(0.1)
            self.listener = tables.addListener(topic, ntcore.EventFlags.kValueAll, print)
"""


@pytest.mark.parametrize(
    "line",
    sampled(["replay script.jsonl", "test --no-isolation"], "replay script.jsonl"),
)
def test_a_robot_with_a_listener_in_this_process_ends_with_the_result(line: str, make_project: MakeProject) -> None:
    """At the end of Python, NetworkTables' thread would end the process by SIGABRT."""
    test = "def test_it(control, robot): control.run_test(lambda time: time < 0.5)\n"
    made = make_project({"robot.py": LISTENS, "tests/test_robot.py": test, "script.jsonl": SCRIPT})
    result = made.run(*line.split(), cold=True)
    assert (result.code, result.complaints) == (0, ""), result.output


# -- directories that killed processes have left -----------------------------------------------------------------------


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def test_a_directory_of_a_killed_process_is_removed_by_the_next(temporary: Path) -> None:
    code = "import os, signal; from pyfrc_core.temporary import temporary_directory as make"
    code += "; made = make('fuzz'); open(made.name + '/1', 'w'); os.kill(os.getpid(), signal.SIGKILL)"
    subprocess.run([sys.executable, "-c", code], env={**os.environ, "TMPDIR": str(temporary)}, check=False)
    (left,) = temporary.iterdir()
    with temporary_directory("sim") as made:
        assert list(temporary.iterdir()) == [Path(made)]
    assert not left.exists()
    assert list(temporary.iterdir()) == []


def test_directories_of_running_processes_and_of_others_stay(temporary: Path) -> None:
    with temporary_directory("fuzz") as running:
        of_another_container = Path(running).name.replace("fuzz-", "fuzz-9", 1)
        kept = [running, *(str(temporary / name) for name in (of_another_container, "pyfrc-mine", "other"))]
        for name in kept[1:]:
            Path(name).mkdir()
        with temporary_directory("fuzz"):
            pass
        assert sorted(map(str, temporary.iterdir())) == sorted(kept)
