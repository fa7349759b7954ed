"""Starts the robot program and restarts it after its end, as the supervisor of a robot does."""

from __future__ import annotations

import os
import secrets
import shlex
import site
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

from ..deploy.agent.robot_paths import RobotPaths
from ..processes.groups import kill_group
from . import children

_RUNNER = "pyfrc_core.virtual_robot.program"
_FINAL_OUTPUT_SECONDS = 1.0


class Supervisor:
    """Keeps the robot program of a virtual robot running until `close`.

    :param on_line: called in a separate thread with each line of the program's output
    :param on_end:  called in a separate thread with the reason for the program's end, or for not starting it
    """

    def __init__(self, paths: RobotPaths, on_line: Callable[[bytes], object], on_end: Callable[[str], object]) -> None:
        self._paths = paths
        self._on_line = on_line
        self._on_end = on_end
        self._mark = secrets.token_hex(8)
        self._state = threading.Condition()
        self._wanted = True
        self._closed = False
        self._process: subprocess.Popen[bytes] | None = None
        self._thread = threading.Thread(target=self._run, name="virtual robot: supervisor", daemon=True)

    def start(self) -> None:
        """Start the current program on the robot's disk."""
        self._thread.start()

    def processes(self) -> list[int]:
        """Return the process ids of the program."""
        with self._state:
            return [] if self._process is None else [self._process.pid]

    def stop(self) -> None:
        """Stop the program. Return when it has ended."""
        with self._state:
            self._wanted = False
            process = self._process
        if process is not None:
            children.end(process)
            with self._state:
                self._state.wait_for(lambda: self._process is not process)

    def restart(self) -> None:
        """Stop the program and start the current one. Return when the old one has ended."""
        self.stop()
        with self._state:
            self._wanted = True
            self._state.notify_all()

    def close(self) -> None:
        """Stop the program for good."""
        with self._state:
            self._closed = True
            self._state.notify_all()
        self.stop()
        self._thread.join()

    def _run(self) -> None:
        while True:
            with self._state:
                self._state.wait_for(lambda: self._wanted or self._closed)
                if self._closed:
                    return
                process = self._start()
                if process is None:
                    self._wanted = False
                    continue
                self._process = process
            reader = threading.Thread(target=self._read, args=(process,), daemon=True)
            reader.start()
            code = process.wait()
            kill_group(process)
            children.kill_marked(self._mark)
            reader.join(_FINAL_OUTPUT_SECONDS)  # child processes of the program may keep its output open
            with self._state:
                asked_for = not self._wanted
                self._process = None
                self._state.notify_all()
            if not asked_for:
                self._on_end(f"the robot program has ended ({_end_of(code)}); restarting it")

    def _start(self) -> subprocess.Popen[bytes] | None:
        command = self._paths.start_command()
        if not command:
            return None
        words = program_words(command, self._paths)
        if words is None:
            self._on_end(f"no program is started: this is not a start command of a Python program: {command.strip()}")
            return None
        home = str(self._paths.home)
        user = {"HOME": home, "USERPROFILE": home, "PYTHONUSERBASE": site.getuserbase()}
        environment = {**os.environ, **user, children.MARK: self._mark}
        return children.start(words, self._paths.home, environment, stderr=subprocess.STDOUT)

    def _read(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdout is not None
        unfinished = b""
        while piece := process.stdout.read(65536):
            *lines, unfinished = (unfinished + piece).split(b"\n")
            for line in lines:
                self._on_line(line.removesuffix(b"\r"))
        if unfinished:
            self._on_line(unfinished)
        process.stdout.close()
        assert process.stdin is not None
        process.stdin.close()


def program_words(command: str, paths: RobotPaths) -> list[str] | None:
    """Translate a robot's start command to a command for this computer, or return None if it is another command.

    ``... python3 -u -O -m robotpy --main /home/lvuser/py/robot.py run`` keeps the options of Python and of `robotpy`.
    """
    try:
        words = shlex.split(command)
        python = next(number for number, word in enumerate(words) if Path(word).name.startswith("python3"))
        module = words.index("-m", python)
        main = words.index("--main", module) + 1
    except (ValueError, StopIteration):
        return None
    if words[module + 1] != "robotpy" or main == len(words):
        return None
    words[main] = str(paths.of(words[main]))
    return [sys.executable, "-X", "utf8", *words[python + 1 : module], "-m", _RUNNER, *words[module + 2 :]]


def _end_of(code: int) -> str:
    return f"exit code {code}" if code >= 0 else f"signal {-code}"
