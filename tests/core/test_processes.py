"""Child processes: messages in their order, before the exit; how crashes are described; what ends with its owner."""

from __future__ import annotations

import gc
import io
import multiprocessing
import os
import select
import selectors
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.errors import RobotCodeError, UsageError
from pyfrc_core.processes import channel, frames, output_pipe, spawn
from pyfrc_core.processes.call import Call, ForkedCall, begin_call, run_in_subprocess
from pyfrc_core.processes.crash_report import CrashLog
from pyfrc_core.processes.exit import (
    exit_by_signal,
)
from pyfrc_core.processes.fork import FORK_IS_SAFE, Fork
from pyfrc_core.processes.frames import FrameTooLargeError, decode, encode, read_frame
from pyfrc_core.processes.interpreter import spawn_worker
from pyfrc_core.processes.output_pipe import OutputPipe
from pyfrc_core.processes.worker import ForkedWorker, Send, Work, Worker, wait_for_any
from pyfrc_core.project import Project
from pyfrc_core.project.robot_files import RobotFiles

only_forked = pytest.mark.skipif(not FORK_IS_SAFE, reason="no fork")
only_linux = pytest.mark.skipif(sys.platform != "linux", reason="where processes end with their owner")

#: Wall seconds, for what takes a hundredth of that.
PATIENCE = 60

#: This file counts as the project's.
FILES = RobotFiles(Path(__file__).parent)

BOTH = [pytest.param(ForkedWorker, marks=only_forked), spawn_worker]


def finish(worker: Worker) -> list[Any]:
    """Poll a worker until it has finished, and return its messages."""
    deadline = time.monotonic() + PATIENCE
    while not worker.finished:
        assert time.monotonic() < deadline
        wait_for_any([worker])
    return list(worker.messages())


@pytest.fixture
def begin() -> Iterator[Callable[[type[Worker], Work], Worker]]:
    """Start workers, which end with the test."""
    started: list[Worker] = []

    def begin(kind: Any, work: Work) -> Worker:
        started.append(kind(work))
        return started[-1]

    yield begin
    for worker in started:
        worker.close()


Begin = Callable[[Any, Work], Worker]


# -- frames ------------------------------------------------------------------------------------------------------------


def test_objects_come_in_their_order_however_a_stream_is_cut() -> None:
    sent = [None, "text", {"key": [1.5, b"\0"]}, ()]
    each = [encode(content) for content in sent]
    stream = b"".join(each)
    for cut in range(len(stream) + 1):
        whole = sum(sum(map(len, each[: count + 1])) <= cut for count in range(len(each)))
        assert list(decode(stream[:cut])) == sent[:whole]


def test_what_is_too_large_is_no_object(monkeypatch: pytest.MonkeyPatch) -> None:
    frame = encode("x" * 10)
    size = len(frame) - 8
    monkeypatch.setattr(frames, "MOST_BYTES", size)
    assert (encode("x" * 10), list(decode(frame)), read_frame(io.BytesIO(frame))) == (frame, ["x" * 10], "x" * 10)
    with pytest.raises(EOFError, match="the stream has ended"):
        read_frame(io.BytesIO(frame[:-1]))
    monkeypatch.setattr(frames, "MOST_BYTES", size - 1)
    with pytest.raises(FrameTooLargeError, match=f"{size} bytes are more than the {size - 1} that one message may"):
        encode("x" * 10)
    assert list(decode(frame)) == []
    with pytest.raises(EOFError, match="not the length of an object"):
        read_frame(io.BytesIO(frame))


# -- workers: messages, then the exit ----------------------------------------------------------------------------------


def send_three(send: Send, log: CrashLog) -> int:
    for number in range(3):
        send(number)
    return 7


@pytest.mark.parametrize("kind", BOTH)
def test_messages_then_the_exit_code(kind: type[Worker], begin: Begin) -> None:
    worker = begin(kind, send_three)
    assert finish(worker) == [0, 1, 2]
    assert worker.status == 7


def test_interpreters_are_waited_for_where_nothing_can_be_selected_from(
    begin: Begin, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On Windows, to select from no descriptors is an error."""

    def select(*arguments: object) -> list[object]:
        raise OSError(10022, "An invalid argument was supplied")

    for name in ("PollSelector", "SelectSelector", "DefaultSelector"):
        if hasattr(selectors, name):
            monkeypatch.setattr(getattr(selectors, name), "select", select)
    assert finish(begin(spawn_worker, send_three)) == [0, 1, 2]


@only_forked
def test_a_process_that_ended_before_anything_was_read(begin: Begin) -> None:
    worker = begin(ForkedWorker, send_three)
    assert isinstance(worker, ForkedWorker)
    os.waitid(os.P_PID, worker._fork._pid, os.WEXITED | os.WNOWAIT)
    assert not worker.finished
    worker.poll()
    assert worker.finished
    assert list(worker.messages()) == [0, 1, 2]


@only_forked
def test_a_message_larger_than_a_pipe(begin: Begin) -> None:
    def send_much(send: Send, log: CrashLog) -> None:
        send(b"much" * (1 << 20))
        send("more")

    much, more = finish(begin(ForkedWorker, send_much))
    assert much == b"much" * (1 << 20)
    assert more == "more"


class Cycle:
    """Garbage for the collector alone, which notes in which process it is collected."""

    def __init__(self, collected_in: list[int]) -> None:
        self.itself, self.collected_in = self, collected_in

    def __del__(self) -> None:
        self.collected_in.append(os.getpid())


@only_forked
def test_a_fork_collects_its_own_garbage_only(begin: Begin) -> None:
    """WPILib's objects, when they are destroyed, wait for locks that the threads of the other process may have held."""
    collected_in: list[int] = []

    def collect(send: Send, log: CrashLog) -> None:
        gc.collect()
        send(len(collected_in))
        Cycle(collected_in)
        gc.collect()
        send(len(collected_in))

    gc.collect()
    gc.disable()
    try:
        Cycle(collected_in)
        worker = begin(ForkedWorker, collect)
    finally:
        gc.enable()
    assert finish(worker) == [0, 1]


@only_forked
def test_a_fork_ends_its_own_child_processes_only(begin: Begin) -> None:
    """Tests may have a program of their own beside the robot, such as a camera's, which all tests share."""
    fork = multiprocessing.get_context("fork")

    def answer(connection: Connection) -> None:
        while connection.recv() == "are you there?":
            connection.send("yes")

    here, there = Pipe()
    shared = fork.Process(target=answer, args=(there,), daemon=True)
    shared.start()
    there.close()
    lives, held = Pipe()

    def start_another(send: Send, log: CrashLog) -> None:
        send(multiprocessing.active_children() != [])
        fork.Process(target=time.sleep, args=(PATIENCE,)).start()  # it holds the pipe open

    assert finish(begin(ForkedWorker, start_another)) == [True]
    held.close()
    with pytest.raises(EOFError):
        lives.recv()
    here.send("are you there?")
    assert here.recv() == "yes"
    here.send("good bye")
    shared.join()


# -- an outbox: never waits


def test_messages_to_a_process_that_does_not_read_wait_in_their_order() -> None:
    ours, theirs = Pipe()
    box = channel.Outbox(ours)
    sent = [*range(5000), "long" * 100_000, *range(5000)]
    for message in sent:  # more than any pipe takes
        box.send(message)
    assert [theirs.recv() for _ in sent] == sent
    box.send("at once")
    assert theirs.recv() == "at once"
    theirs.close()
    for number in range(5000):
        box.send(number)  # the other end is closed: no error


# -- ends --------------------------------------------------------------------------------------------------------------


def send_and_exit(send: Send, log: CrashLog) -> None:
    send("before")
    os._exit(3)


def send_and_die(send: Send, log: CrashLog) -> None:
    send("before")
    assert log.time_us is not None
    log.time_us[0] = 1_520_000
    log.set_mode("disabled autonomous")
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.parametrize("kind", BOTH)
def test_an_exit_in_the_middle_names_its_line(kind: type[Worker], begin: Begin) -> None:
    worker = begin(kind, send_and_exit)
    assert finish(worker) == ["before"]
    line = send_and_exit.__code__.co_firstlineno + 2
    assert worker.describe_exit(FILES, "meanwhile").startswith(
        f"test_processes.py:{line}: the robot's process ended itself with exit code 3, meanwhile\n\nos._exit(3) was"
    )


@pytest.mark.skipif(sys.platform == "win32", reason="no signals")
@pytest.mark.parametrize("kind", BOTH)
def test_the_moment_of_a_process_that_is_killed(kind: type[Worker], begin: Begin) -> None:
    worker = begin(kind, send_and_die)
    assert finish(worker) == ["before"]
    assert worker.status == -signal.SIGKILL
    assert (
        worker.describe_exit(FILES, "meanwhile")
        == "the robot's process was ended by signal 9 (SIGKILL), at 1.52 s in disabled autonomous mode"
    )


def finish_by_signal(worker: Worker, monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """Kill a process that is measured when it has sent something, and return its messages; it ends by itself."""
    monkeypatch.setattr(Fork, "grace_seconds", float(PATIENCE))
    while not list(worker.messages()):
        wait_for_any([worker])
    worker.kill()
    assert worker.status == 128 + signal.SIGTERM
    return list(worker.messages())


@only_forked
def test_a_kill_leaves_time_to_save_measurements(begin: Begin, monkeypatch: pytest.MonkeyPatch) -> None:
    def save_when_terminated(send: Send, log: CrashLog) -> None:
        signal.signal(signal.SIGTERM, partial(exit_by_signal, prepare=partial(send, "saved")))
        send("ready")
        signal.pause()

    assert finish_by_signal(begin(ForkedWorker, save_when_terminated), monkeypatch) == ["ready", "saved"]


# -- nothing outlives its owner ----------------------------------------------------------------------------------------

OWNER = """
import os, signal, sys
from functools import partial
from multiprocessing import Pipe
from pyfrc_core.processes import fork, spawn

held = int(sys.argv[2])
def stay(send):
    os.write(held, b"x")
    signal.pause()

if sys.argv[1] == "fork":
    fork.Fork(stay)
else:
    spawn.start(spawn.Start(partial(exec, "import signal; print(1, flush=True); signal.pause()"), stdout=held))
signal.pause()
"""


@only_linux
@pytest.mark.parametrize("way", ["fork", "spawn"])
def test_a_process_ends_when_its_owner_is_killed(way: str) -> None:
    reading, writing = os.pipe()
    owner = subprocess.Popen([sys.executable, "-c", OWNER, way, str(writing)], pass_fds=[writing])
    os.close(writing)
    try:
        assert os.read(reading, 1)  # it runs
    finally:
        owner.kill()
        owner.wait()
    while select.select([reading], [], [], PATIENCE)[0]:
        if not os.read(reading, 100):  # the last process that could write has ended
            break
    else:
        pytest.fail("it has outlived its owner")
    os.close(reading)


@only_linux
def test_a_fork_by_a_thread_that_ends_goes_on(begin: Begin) -> None:
    reading, writing = os.pipe()

    def wait_and_send(send: Send, log: CrashLog) -> None:
        os.read(reading, 1)
        send("still there")

    workers: list[Worker] = []
    thread = threading.Thread(target=lambda: workers.append(begin(ForkedWorker, wait_and_send)))
    thread.start()
    thread.join()
    os.write(writing, b".")
    assert finish(workers[0]) == ["still there"]
    os.close(reading)
    os.close(writing)


# -- calls -------------------------------------------------------------------------------------------------------------


def result_of(call: Callable[[CrashLog], Any]) -> Any:
    forked = ForkedCall(call)
    try:
        deadline = time.monotonic() + PATIENCE
        while not forked.finished:
            assert time.monotonic() < deadline
            forked.poll()
        return forked.result(FILES, "meanwhile")
    finally:
        forked.close()


def fail_with(error: BaseException) -> Callable[[CrashLog], Any]:
    def fail(log: CrashLog) -> None:
        raise error

    return fail


@only_forked
def test_what_becomes_of_a_call(capfd: pytest.CaptureFixture[str]) -> None:
    def print_and_return(log: CrashLog) -> str:
        os.write(1, b"not shown")
        return "the result"

    assert result_of(print_and_return) == "the result"
    assert capfd.readouterr().out == ""
    # Ctrl-C, which each process of a terminal gets, is for the one that has started it.
    assert result_of(lambda log: signal.raise_signal(signal.SIGINT) or "goes on") == "goes on"
    with pytest.raises(UsageError, match="the user's mistake"):
        result_of(fail_with(UsageError("the user's mistake")))
    with pytest.raises(RuntimeError, match="a mistake in pyfrc itself") as raised:
        result_of(fail_with(LookupError("ours")))
    assert "LookupError: ours" in str(raised.value.__cause__)
    with pytest.raises(RobotCodeError, match=r"exit\(3\) was called"):
        result_of(fail_with(SystemExit(3)))
    with pytest.raises(RuntimeError, match="a mistake in pyfrc itself"):
        result_of(lambda log: lambda: "cannot be pickled")
    with pytest.raises(RobotCodeError, match="ended itself with exit code 4, meanwhile"):
        result_of(lambda log: os._exit(4))


def name_of(project: Project, log: CrashLog) -> str:
    return project.main_file.name


def test_a_call_in_a_new_interpreter(tmp_path: Path) -> None:
    project = Project(tmp_path / "robot.py")
    assert run_in_subprocess(name_of, project, "meanwhile") == "robot.py"


def test_a_call_in_an_interpreter_says_how_many_follow_and_whose_line_stands_still(tmp_path: Path) -> None:
    begun: list[tuple[object, int]] = []
    ended: list[object] = []
    worker: Any = SimpleNamespace(finished=True, fileno=lambda: None)
    interpreters: Any = SimpleNamespace(begin=lambda work, more: begun.append((work, more)) or worker, end=ended.append)
    call: Call[str] = begin_call(interpreters, name_of, Project(tmp_path / "robot.py"), 4)
    assert [more for _, more in begun] == [4]
    call.close()
    assert ended == [worker]


def test_what_a_new_interpreter_prints_has_the_encoding_of_its_reader(monkeypatch: pytest.MonkeyPatch) -> None:
    """That of this process if it prints beside it, else UTF-8."""

    def encoding(stdout: int | None) -> str:
        return spawn._output_encoding(spawn.Start(len, stdout=stdout))["PYTHONIOENCODING"]  # type: ignore[arg-type]

    monkeypatch.setattr(sys, "stdout", SimpleNamespace(encoding="cp1252"))
    assert [encoding(None), encoding(3)] == ["cp1252:backslashreplace", "utf-8:backslashreplace"]
    monkeypatch.setattr(sys, "stdout", None)
    assert encoding(None) == "utf-8:backslashreplace"


def test_what_is_printed_into_a_pipe_comes_out_in_order_and_without_marks() -> None:
    found: list[tuple[str, Any]] = []
    pipe = OutputPipe(lambda text, stamps: found.append((text, list(stamps))))

    def printed(data: bytes) -> None:
        os.write(pipe.writing_end, data)

    stamp = pipe.stamp.format(20_000).encode()
    printed(b"one\n" + stamp + b"two")
    pipe.flush()
    assert "".join(text for text, _ in found) == "one\ntwo"
    assert found[0][1] == [(4, 20_000)]
    found.clear()
    for piece in (stamp[:5], stamp[5:-3], stamp[-3:-1], stamp[-1:], b"\xc3", b"\xa4"):
        printed(piece)
    pipe.flush()
    assert "".join(text for text, _ in found) == "ä"
    assert [stamps for _, stamps in found if stamps] in ([], [[(0, 20_000)]])
    found.clear()
    printed(b"a\0b\0pyfrc-no")
    pipe.close()
    assert "".join(text for text, _ in found) == "a\0b\0pyfrc-no"
    pipe.flush()
    pipe.close()


def test_what_may_begin_a_mark_is_kept_until_its_rest_has_come(monkeypatch: pytest.MonkeyPatch) -> None:
    pieces, shown = SimpleQueue[bytes](), SimpleQueue[tuple[str, Any]]()
    monkeypatch.setattr(output_pipe, "read", lambda descriptor, most: pieces.get())
    pipe = OutputPipe(lambda text, stamps: shown.put((text, list(stamps))))
    name = pipe.stamp.partition("@")[0].encode()
    for piece, expected in (
        (b"a" + name[:4], "a"),
        (name[4:], ""),
        (b"@2", ""),
        (b"0\0b\0c", "b\0c"),
        (name + b"@", ""),
        (b"7\0d" + name + b"@x", f"d{name.decode()}@x"),
        (name + b"0", ""),
        (b"\0", ""),
    ):
        pieces.put(piece)
        if expected:
            text, stamps = shown.get(timeout=PATIENCE)
            assert (text, stamps) == (expected, {"b": [(0, 20)], "d": [(0, 7)]}.get(text[0], []))
    pipe.close()
    assert shown.empty()


def test_forks_close_a_connection_where_there_are_forks(monkeypatch: pytest.MonkeyPatch) -> None:
    connection: Any = SimpleNamespace(close=lambda: None)
    registered: list[Any] = []
    monkeypatch.setattr(
        channel, "os", SimpleNamespace(register_at_fork=lambda after_in_child: registered.append(after_in_child))
    )
    channel.close_in_forks(connection)
    assert registered == [connection.close]
    monkeypatch.setattr(channel, "os", SimpleNamespace())
    channel.close_in_forks(connection)
