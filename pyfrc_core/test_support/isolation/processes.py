"""The processes that tests run in: forked from this one, or started anew. What differs by platform is here."""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import tempfile
from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

import pytest

from ...measure.processes import save_here
from ...runtime import forks
from ...runtime.own_process import LastWords, end_processes_of_the_robot, exit_now, explain_end, write_all
from ..pytest_plugin import PyFrcPlugin
from .messages import Teller


class TestProcess(ABC):
    """One test in its own process."""

    __test__ = False  # pytest: not a test class, for all its name

    def __init__(self, item: pytest.Item, plugin: PyFrcPlugin) -> None:
        self.item = item
        self._files = plugin.project.files
        self._message: bytes = b""
        #: Where the process leaves word when it ends without a report.
        self._last_words: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - closed by `close`
        #: What it printed, to stdout and stderr, and pytest had not yet collected.
        self._captured: list[IO[bytes]] = []
        for _ in ("stdout", "stderr"):
            self._captured.append(tempfile.TemporaryFile())  # noqa: SIM115 - closed likewise
        self.finished = False
        self._status = 0

    @abstractmethod
    def poll(self) -> None:
        """Take in what has come, and see whether the process has ended."""

    @abstractmethod
    def kill(self) -> None:
        """End the process without waiting for its test."""

    def close(self) -> None:
        """Let go of what the process has left, once it is reported."""
        for file in (self._last_words, *self._captured):
            file.close()

    def fileno(self) -> int | None:
        """What becomes readable when there is something to `poll`, if there is such a thing."""
        return None

    def output(self) -> bytes:
        """The messages the process sent."""
        return self._message

    def captured(self) -> str:
        """What the process printed since its last report."""
        text = ""
        for file in self._captured:
            file.seek(0)
            text += file.read().decode(errors="replace")
        return text.strip()

    def explain_crash(self) -> str:
        """Why the process ended without finishing its test: the user's line first, where it can be told."""
        self._last_words.seek(0)
        words = self._last_words.read().decode(errors="surrogateescape")
        return explain_end(words, self._status, self._files, "in the middle of the test")


def wait_for_any(processes: list[TestProcess]) -> None:
    """Return when at least one of these has something new, or may have ended."""
    numbers = [process.fileno() for process in processes if not process.finished]
    forks.wait_for_any([number for number in numbers if number is not None])
    for process in processes:
        if not process.finished:
            process.poll()


class ForkedTest(TestProcess):
    """A fork of this process: everything imported is there already."""

    def __init__(self, item: pytest.Item, plugin: PyFrcPlugin) -> None:
        super().__init__(item, plugin)
        self._fork = forks.Fork(
            lambda send: _become_the_test(
                item,
                plugin,
                send,
                self._last_words.fileno(),
                (self._captured[0].fileno(), self._captured[1].fileno()),
            )
        )

    def fileno(self) -> int | None:
        return self._fork.fileno()

    def poll(self) -> None:
        self._fork.poll()
        self._take_over()

    def kill(self) -> None:
        self._fork.kill()
        self._take_over()

    def _take_over(self) -> None:
        self.finished, self._status, self._message = self._fork.finished, self._fork.status, self._fork.message


class SpawnedTest(TestProcess):
    """A new interpreter that collects the tests again and runs one of them."""

    def __init__(self, item: pytest.Item, plugin: PyFrcPlugin) -> None:
        super().__init__(item, plugin)
        handle, name = tempfile.mkstemp(prefix="pyfrc-test-")
        os.close(handle)
        self._file = Path(name)
        words, words_name = tempfile.mkstemp(prefix="pyfrc-words-")
        os.close(words)
        self._words_file = Path(words_name)
        invocation = item.config.invocation_params
        job = {
            "args": [str(argument) for argument in invocation.args],
            "directory": str(invocation.dir),
            "nodeid": item.nodeid,
            "main_file": str(plugin.project.main_file),
            "class_name": plugin.project.class_name,
            "options": plugin.options,
            "output": name,
            "last_words": words_name,
            "path": sys.path,
        }
        self._process = subprocess.Popen(
            [sys.executable, "-m", "pyfrc_core.test_support.isolation.spawned"],
            stdin=subprocess.PIPE,
            stdout=self._captured[0],
            stderr=self._captured[1],
            cwd=str(invocation.dir),
        )
        assert self._process.stdin is not None
        with self._process.stdin as stdin:
            stdin.write(pickle.dumps(job))

    def poll(self) -> None:
        status = self._process.poll()
        if status is not None:
            self._status = status
            self._collect()

    def kill(self) -> None:
        if not self.finished:
            self._process.kill()
            self._process.wait()
            self._collect()

    def _collect(self) -> None:
        self._message = self._file.read_bytes()
        self._last_words.write(self._words_file.read_bytes())
        self._file.unlink()
        self._words_file.unlink()
        self.finished = True


# -- on the other side -----------------------------------------------------------------------------------------------


def _become_the_test(
    item: pytest.Item,
    plugin: PyFrcPlugin,
    send: Callable[[bytes], None],
    last_words: int,
    captured: tuple[int, int],
) -> None:
    """What the forked process does. Never returns."""
    status = 1
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    try:
        _capture_anew(item.config, captured)
        leave_word_on_crash(plugin, last_words)
        Teller(send).run(item)
        save_here()
        end_processes_of_the_robot()
        status = 0
    except BaseException:
        import traceback

        write_all(last_words, traceback.format_exc().encode())
    finally:
        # With -s nothing captures what the test has printed: in a pipe, Python still holds it.
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):  # its reader has gone, or the robot has closed it
                stream.flush()
        exit_now(status)


def leave_word_on_crash(plugin: PyFrcPlugin, descriptor: int) -> None:
    """Have what ends this process too early say where: also code that cannot be stopped."""
    plugin.own_process = True
    plugin.when_python_is_stuck = descriptor
    words = LastWords(descriptor)
    plugin.last_words = words.write
    plugin.when_opened = words.follow
    words.leave_on_crash(before_exit=save_here)


def _capture_anew(config: pytest.Config, files: tuple[int, int]) -> None:
    """Capture output in files that the parent can still read when this process is gone."""
    capture: Any = config.pluginmanager.getplugin("capturemanager")
    if capture is None or not capture.is_globally_capturing():
        return
    capture.stop_global_capturing()
    capture.start_global_capturing()
    streams = capture._global_capturing.out, capture._global_capturing.err
    for stream, file in zip(streams, files, strict=True):
        if hasattr(stream, "targetfd"):  # captures the file descriptor, not only sys.stdout
            os.dup2(file, stream.tmpfile.fileno())
    capture.suspend_global_capture(in_=False)
