"""The robot that runs this agent: the processes of its program, and stopping and starting it.

`RealRobot` and `virtual.VirtualRobotClient` have the same attributes and methods; a `Host` is either.
"""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Union

from .console import PORTS, Console, ConsoleClient, OutputCommand
from .disk import text_of
from .release_record import Boot
from .robot_paths import Refusal, RobotPaths
from .system import KILL, is_own, ticks_per_second
from .virtual import VirtualRobotClient

_SHELLS = ("/bin/bash", "/bin/sh")  # a script may need bash, and lack a first line that names it
#: The port of NetworkTables 4. WPILib opens it when the robot class is constructed, before `robotInit`.
NETWORK_TABLES_PORT = 5810
_NOT_EXECUTED = (126, 127)  # a shell's exit codes
_POWER_CYCLE = "Switch the robot off and on again: it starts the new program then."
_COMMAND_SECONDS = 15.0
_END_SECONDS = 2.0  # for the old program to end, after the script and after each signal
_POLL_SECONDS = 0.05


class RealRobot:
    """A robot's controller.

    :param paths: its files
    """

    is_virtual = False

    def __init__(self, paths: RobotPaths) -> None:
        self.paths = paths
        layout = paths.layout
        self._code = (f"{layout.code}/".encode(), f"{paths.releases_on_robot}/".encode())
        self._home = f"{layout.home}/".encode()
        self._native_program = self._home + b"frcUserProgram"  # written in C++

    def console(self) -> Console:
        """Return a client for the program's output."""
        output = self.paths.layout.output
        return OutputCommand(output) if output else ConsoleClient("127.0.0.1", PORTS)

    def can_restart(self) -> bool:
        """Return whether the program can be stopped and started."""
        return self.paths.of(self.paths.layout.restart[0]).exists()

    def processes(self) -> set[int]:
        """Return the process ids of the robot program, which may be written in another language."""
        found = set()
        for entry in os.scandir("/proc"):
            if entry.name.isdigit() and int(entry.name) != os.getpid():
                try:
                    if not is_own(entry.stat()):
                        continue
                    words = Path(entry.path, "cmdline").read_bytes().split(b"\0")
                except OSError:
                    continue
                # The first word excludes programs that only read a file there, such as tail or an editor.
                name = words[0].rpartition(b"/")[2]
                is_python = name.startswith(b"python") and any(word.startswith(self._code) for word in words)
                is_java = name == b"java" and any(map(self._is_jar, words))
                if is_python or is_java or words[0] == self._native_program:
                    found.add(int(entry.name))
        return found

    def _is_jar(self, word: bytes) -> bool:
        return word.startswith(self._home) and word.endswith(b".jar")

    def is_running(self, process: int) -> bool:
        """Return whether a process of the program still runs; much cheaper than `processes`."""
        try:
            return bool(Path(f"/proc/{process}/cmdline").read_bytes())  # empty: a zombie
        except OSError:
            return False

    def boot(self) -> Boot:
        """Return the last start of the system. In a container, this is the start of its first process."""
        name = text_of(Path("/proc/sys/kernel/random/boot_id"))
        age = age_of([1])
        return Boot("") if name is None or age is None else Boot(f"{name.strip()} {_start_of(1)}", age)

    def serves_network_tables(self, process: int) -> bool | None:
        """Return whether a process listens at the port of NetworkTables."""
        sockets = {
            f"socket:[{row.split()[9]}]"
            for table in ("tcp", "tcp6")
            for row in Path(f"/proc/{process}/net/{table}").read_text(encoding="utf-8").splitlines()[1:]
            if row.split()[1].endswith(f":{NETWORK_TABLES_PORT:04X}") and row.split()[3] == "0A"
        }
        for each in Path(f"/proc/{process}/fd").iterdir() if sockets else ():
            with suppress(FileNotFoundError):  # closed meanwhile
                if str(each.readlink()) in sockets:
                    return True
        return False

    def stop(self, start: bool, meanwhile: Callable[[], None] = lambda: None) -> bool:
        """Stop the program, and start it again if wanted. Return when all old processes have ended.

        The exit code of the command is ignored where it fails if no program runs.

        :param meanwhile: called repeatedly until the old processes have ended
        :return: whether the program survived the command and was ended by a signal
        :raises Refusal: if the command is missing, cannot be executed or fails, or the program does not end
        """
        before = self.processes()
        command = self.paths.layout.restart if start else self.paths.layout.stop
        printed = self._run(command, meanwhile)
        survivors = self._wait_for_end(before, meanwhile)
        survived = bool(survivors)
        for number in (signal.SIGTERM, KILL):
            for process in survivors:
                with suppress(ProcessLookupError):
                    os.kill(process, number)
            survivors = survivors and self._wait_for_end(before, meanwhile)
        if survivors:
            raise Refusal(
                "restart",
                f"{self.paths.layout.stopper} has not stopped the old program: {printed or 'it printed nothing'}",
                _POWER_CYCLE,
            )
        return survived

    def _run(self, command: Sequence[str], meanwhile: Callable[[], None]) -> str:
        """Run a command, and return its output."""
        import subprocess
        import tempfile

        script = self.paths.of(command[0])
        if not script.exists():
            raise Refusal(
                "restart",
                f"there is no {command[0]} on the robot, so its program cannot be restarted",
                "Switch the robot off and on again; if that does not help, image it.",
            )
        shell = next((each for each in _SHELLS if os.access(each, os.X_OK)), _SHELLS[-1])
        profiles = [str(self.paths.of(path)) for path in self.paths.layout.profiles]
        sourcing = '[ ! -r "$1" ] || . "$1"; shift; ' * len(profiles)
        deadline = time.monotonic() + _COMMAND_SECONDS
        # A file instead of a pipe: background processes of the command keep its output open after its end.
        with tempfile.TemporaryFile() as output:
            run = subprocess.Popen(
                [shell, "-c", sourcing + 'exec "$@"', shell, *profiles, str(script), *command[1:]],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )
            while run.poll() is None and time.monotonic() < deadline:
                meanwhile()
                with suppress(subprocess.TimeoutExpired):
                    run.wait(_POLL_SECONDS)
            if run.poll() is None:
                with suppress(PermissionError):  # a command of the administrator goes on
                    run.kill()
                    run.wait()
                return f"it did not end within {_COMMAND_SECONDS:g} s"
            output.seek(0)
            printed = output.read(4096).decode(errors="replace").strip()
        reason = printed.rpartition("\n")[2]  # bash prints it twice
        if run.returncode in _NOT_EXECUTED:
            raise Refusal("restart", f"{command[0]} cannot be executed: {reason}", _POWER_CYCLE)
        if run.returncode and self.paths.layout.can_fail:
            raise Refusal("restart", f"{self.paths.layout.stopper} has failed: {reason}", _POWER_CYCLE)
        return printed

    def _wait_for_end(self, before: set[int], meanwhile: Callable[[], None]) -> set[int]:
        """Wait for processes to end. Return those that are still there after the time limit."""
        deadline = time.monotonic() + _END_SECONDS
        while (left := before & self.processes()) and time.monotonic() < deadline:
            meanwhile()
            time.sleep(_POLL_SECONDS / 2)
        return left


Host = Union[RealRobot, VirtualRobotClient]  # noqa: UP007 - the agent runs on Python 3.9, too


def age_of(processes: Iterable[int]) -> float | None:
    """Return the age of the oldest of these processes in seconds; None without processes or ``/proc``."""
    ages = []
    for process in processes:
        with suppress(OSError, ValueError, IndexError):
            uptime = float(Path("/proc/uptime").read_text(encoding="utf-8").split()[0])
            ages.append(max(0.0, uptime - _start_of(process) / ticks_per_second()))
    return max(ages, default=None)


def _start_of(process: int) -> int:
    """Return the start of a process, in clock ticks since the system's start."""
    return int(Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[19])


def cpu_seconds(process: int) -> float:
    """Return the processor time of a process in seconds.

    :raises OSError: if it has ended, or there is no ``/proc``
    """
    fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / ticks_per_second()
