"""Interpreters that are used again, without any: which one does the next work, and what is started ahead."""

from __future__ import annotations

import atexit
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest

from pyfrc_core.processes import exit as exits
from pyfrc_core.processes import interpreter, reuse, spawn
from pyfrc_core.processes.call import Call
from pyfrc_core.processes.interpreter import Interpreter, SpawnedWorker, WorkFiles, spawn_worker
from pyfrc_core.processes.reuse import Interpreters
from pyfrc_core.processes.standstill import Standstill
from pyfrc_core.test_support.isolation import interpreters as isolation


class Process:
    """What `spawn.open_interpreter` has started: it ends when a test says so."""

    started: ClassVar[list[Process]] = []

    def __init__(self, how: spawn.Start) -> None:
        self.how, self.status = how, None
        self.directory: Path = how.call.args[1]  # type: ignore[attr-defined]
        self.stdin = SimpleNamespace(write=self.take, flush=lambda: None, close=lambda: None)
        self.tasks = 0
        self.started.append(self)

    def take(self, task: bytes) -> None:
        self.tasks += 1

    def poll(self) -> int | None:
        return self.status

    def kill(self) -> None:
        self.status = -9 if self.status is None else self.status

    def wait(self) -> int | None:
        return self.status

    def finish(self, *left: str) -> None:
        """Do the work, and put itself back but for what is left."""
        files = WorkFiles(self.directory, self.tasks)
        files.done.write_text("0")
        files.left.write_text("\n".join(left))


@pytest.fixture
def processes(monkeypatch: pytest.MonkeyPatch) -> list[Process]:
    monkeypatch.setattr(Process, "started", [])
    monkeypatch.setattr(spawn, "open_interpreter", Process)
    monkeypatch.setattr(reuse, "usable_processors", lambda: 2)
    return Process.started


@pytest.fixture
def ones(processes: list[Process]) -> Iterator[Interpreters]:
    """Interpreters of which one was started ahead."""
    interpreters = Interpreters(len, 1)  # type: ignore[arg-type]
    yield interpreters
    interpreters.close()
    assert not any(each.directory.exists() or each.status is None for each in processes)


def work(ones: Interpreters, more: int = 0) -> SpawnedWorker:
    return ones.begin(len, more)  # type: ignore[arg-type]


def finish(worker: SpawnedWorker, process: Process, *left: str) -> None:
    process.finish(*left)
    worker.poll()
    assert (worker.finished, worker.goes_on, worker.status) == (True, True, 0)


def test_one_that_has_put_itself_back_does_the_next_work(ones: Interpreters, processes: list[Process]) -> None:
    assert len(processes) == 1
    first = work(ones)
    second = work(ones)
    assert [each.tasks for each in processes] == [1, 1]
    finish(second, processes[1])
    ones.end(second)
    assert not WorkFiles(processes[1].directory, 1).done.exists()
    third = work(ones, more=5)
    assert ([each.tasks for each in processes], ones.why_not_again()) == ([1, 2], "")
    finish(first, processes[0])
    ones.end(first)
    assert third.interpreter is second.interpreter
    assert work(ones).interpreter is first.interpreter
    assert len(processes) == 2


def test_after_one_that_has_left_something_others_are_started_ahead(
    ones: Interpreters, processes: list[Process]
) -> None:
    worker = work(ones)
    finish(worker, processes[0], "a thread", "a file")
    ones.end(worker)
    assert ones.why_not_again() == "a thread; a file"
    work(ones, more=5)
    assert (processes[0].status, [each.tasks for each in processes[1:]]) == (-9, [1, 0, 0])
    work(ones, more=1)
    assert [each.tasks for each in processes[1:]] == [1, 1, 0]
    assert ones.reason == "a thread; a file"


def test_one_that_has_ended_leaves_nothing_to_say(ones: Interpreters, processes: list[Process]) -> None:
    worker = work(ones)
    processes[0].status = 3
    worker.poll()
    assert (worker.finished, worker.goes_on, worker.status) == (True, False, 3)
    ones.end(worker)
    work(ones)
    assert ([each.tasks for each in processes], ones.why_not_again()) == ([1, 1], "")


def test_the_reason_is_what_was_left_first(ones: Interpreters, processes: list[Process]) -> None:
    for number, left in enumerate(("a thread", "a file")):
        worker = work(ones)
        finish(worker, processes[number], left)
        ones.end(worker)
    work(ones)
    assert ones.reason == "a thread"


def test_the_interpreter_of_a_rehearsal_does_the_first_work(ones: Interpreters, processes: list[Process]) -> None:
    ones.rehearse(len)  # type: ignore[arg-type]
    processes[0].finish()
    work(ones)
    assert [each.tasks for each in processes] == [2]


def test_tests_that_are_forked_or_run_here_need_none(monkeypatch: pytest.MonkeyPatch) -> None:
    closed: list[bool] = []
    made: Any = SimpleNamespace(close=lambda: closed.append(True))
    monkeypatch.setattr(isolation, "start_interpreters", lambda project: made)
    monkeypatch.setattr(isolation, "is_forked", lambda name: name == "fork")
    project: Any = None
    for name, opened in (("none", None), ("fork", None), ("reuse", made)):
        options: Any = SimpleNamespace(isolation=name)
        with isolation.opened_interpreters(project, options) as interpreters:
            assert (interpreters, closed) == (opened, [])
    assert closed == [True]


def test_what_takes_too_long_to_put_back(processes: list[Process], monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([0.0, 9.0, 11.0])
    monkeypatch.setattr(interpreter, "_now", lambda: next(clock))
    monkeypatch.setattr(interpreter, "wait_for_any", lambda numbers: None)
    one = Interpreter(len)  # type: ignore[arg-type]
    worker = one.begin(len)  # type: ignore[arg-type]
    assert (one.is_restored, one.poll()) == (False, None)
    assert one.left_over() == ["what takes longer than 10 s to put back"]
    assert one.poll() == -9
    clock = iter([0.0, 1.0])
    assert one.left_over() is None
    worker.close()
    one.close()
    assert not processes[0].directory.exists()


def test_a_worker_that_is_ended_ends_its_process(processes: list[Process], monkeypatch: pytest.MonkeyPatch) -> None:
    one = Interpreter(len)  # type: ignore[arg-type]
    worker = one.begin(len)  # type: ignore[arg-type]
    worker.kill()
    assert (worker.finished, worker.goes_on, worker.status) == (True, False, -9)
    worker.close()
    assert processes[0].directory.exists()
    one.close()
    owned = spawn_worker(len)  # type: ignore[arg-type]

    def interrupt(numbers: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(interpreter, "wait_for_any", interrupt)
    with pytest.raises(KeyboardInterrupt):
        owned.wait()
    assert (owned.finished, processes[1].status) == (True, -9)
    owned.close()
    assert not processes[1].directory.exists()


def test_what_a_worker_has_printed_is_that_of_its_own_work(processes: list[Process]) -> None:
    one = Interpreter(len, keeps_output=True)  # type: ignore[arg-type]
    (process,) = processes
    for text in ("first", "second"):
        worker = one.begin(len)  # type: ignore[arg-type]
        for stream in ("stdout", "stderr"):
            with (process.directory / stream).open("a") as file:
                file.write(f"{text} to {stream};")
        finish(worker, process)
        assert worker.printed() == f"{text} to stdout;{text} to stderr;"
        files = list(process.directory.glob(f"{process.tasks}-*"))
        worker.close()
        assert [file.name for file in files if file.exists()] == [f"{process.tasks}-left"]
    one.close()


# -- ends --------------------------------------------------------------------------------------------------------------


def test_a_process_ends_with_the_status_of_its_command_when_all_else_is_done(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[object] = []
    last: list[Callable[[], object]] = []
    monkeypatch.setattr(atexit, "register", last.append)
    monkeypatch.setattr(exits, "flush_output", lambda: done.append("flush"))
    monkeypatch.setattr(exits, "exit_now", done.append)
    set_status = exits.end_without_destruction()
    last[0]()
    assert done == []  # a command that has set none ends as Python does
    set_status(3)
    last[0]()
    assert done == ["flush", 3]
    monkeypatch.setattr(os, "getpid", lambda: 0)
    last[0]()
    assert done == ["flush", 3]  # not in a fork


def test_a_robots_start_is_no_standstill_where_many_follow_each_other(capfd: pytest.CaptureFixture[str]) -> None:
    now: list[Standstill | None] = [None]
    worker: Any = SimpleNamespace(finished=False, poll=lambda: None, standstill=lambda files: now[0])
    files: Any = object()
    calls = [Call(worker, lambda: None, each) for each in (files, None)]  # type: ignore[var-annotated]
    for seconds, robot_time in ((9, 0.0), (2, 1.5), (4, 1.5), (5, 1.5)):
        now[0] = Standstill(seconds, "robot.py:3", robot_time)
        for call in calls:
            call.poll()
    assert capfd.readouterr().err == "robot.py:3: no progress for 4 s (robot time stands at 1.50 s)\n"
