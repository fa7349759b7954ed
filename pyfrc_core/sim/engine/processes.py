"""The simulation's side of its robot's process: makes it, hears it, ends it."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from itertools import count
from multiprocessing.connection import Client, Listener
from pathlib import Path
from typing import Any

from ...processes import spawn
from ...processes.channel import Channel, Connection, Outbox
from ...processes.crash_report import moment_of, standstill_of
from ...processes.fork import FORK_IS_SAFE
from ...processes.groups import kill_group
from ...processes.output_pipe import OutputPipe, Stamps
from ...processes.spawn import StartedProcess
from ...processes.standstill import Standstill, loading_for
from ...project.robot_files import RobotFiles
from ...temporary import temporary_directory
from .commands import Quit
from .host import CLOSING_SECONDS, Exited, Hosting, Kill, Launch, Preload, main
from .messages import Failed, Job, Message

#: The most bytes that the name of a socket may have on every system.
_LONGEST_NAME = 100
#: How long a process is given to end when it was asked to, in seconds.
_PATIENCE = 1.0
#: The same for a host, whose robot may have data logs to complete.
_HOST_PATIENCE = CLOSING_SECONDS + _PATIENCE

#: What a host's interpreter reads from its environment: a fixed order of sets, and output as it is printed.
ENVIRONMENT = {"PYTHONHASHSEED": "0", "PYTHONUNBUFFERED": "1", "PYTHONIOENCODING": "utf-8"}


@dataclass
class _Spare:
    """A host that has no robot yet.

    :param output: what it prints into
    """

    name: str
    process: StartedProcess
    output: OutputPipe
    connection: Connection | None = None


class RobotProcesses:
    """One robot's process at a time, each in place of the one before.

    The functions are called from threads of this object's.

    :param on_message: what a robot's process says, with the number of its launch
    :param on_exit: it has ended: the launch's number, the exit code, its crash log's contents
    :param on_output: what robots print, stamped with robot time
    :param fork: whether to fork them; where that is not safe, each is a new interpreter, and while one runs, the next
        is started ahead: to start the robot again takes no time
    """

    def __init__(
        self,
        on_message: Callable[[int, Message], object],
        on_exit: Callable[[int, int, bytes], object],
        on_output: Callable[[str, Stamps], object],
        fork: bool | None = None,
    ) -> None:
        self._on_message, self._on_exit, self._on_output = on_message, on_exit, on_output
        self._forks = FORK_IS_SAFE if fork is None else fork
        self._lock = threading.RLock()
        self._closed = False
        self._temporary = temporary_directory("sim")
        self._key = os.urandom(32)
        try:
            self._listener = Listener(_address(self._temporary.name), authkey=self._key)
        except OSError:  # a file system without sockets, or a name that is too long
            self._listener = Listener(("127.0.0.1", 0), authkey=self._key)
        self._number = 0
        self._launched_at = time.monotonic()
        self._host: StartedProcess | None = None
        self._host_name = ""
        self._hosts = count(1)
        #: The host that was started ahead.
        self._spare: _Spare | None = None
        #: What it is to import.
        self._preloaded: tuple[str, ...] = ()
        self._host_connection: Connection | None = None
        self._host_reader: threading.Thread | None = None
        self._robot: Outbox | None = None
        #: What the host, and so the robot, prints into.
        self._output: OutputPipe | None = None
        #: Set when the robot's process has ended.
        self._ended = threading.Event()
        self._channels: dict[int, Channel] = {}
        #: Set when the connection with this number has been accepted, and so all that were made before it.
        self._barriers: dict[str, threading.Event] = {}
        #: What is to be sent to the host as soon as it is there; likewise to the robot.
        self._for_host: list[object] = []
        self._for_robot: list[object] = []
        self._accepting = _thread(self._accept, "pyfrc sim: listener")

    def launch(self, job: Job) -> int:
        """Begin another robot's process, ending the one before; return the launch's number."""
        with self._lock:
            if self._closed:
                return self._number
            self._number += 1
            self._launched_at = time.monotonic()
            self._channels[self._number] = Channel(self._number, self._received, self._gone)
            if self._host is not None and not self._forks:
                self._end_host()
            self._robot, self._for_robot = None, []
            self._ended = threading.Event()
            if self._host is None or self._host.poll() is not None:
                self._begin_host()
            self._send_to_host(Launch(self._number, pickle.dumps(job), self._crash_log(self._number)))
            return self._number

    def send(self, command: object) -> None:
        """Tell the robot's process something; nothing, where there is none."""
        with self._lock:
            if self._robot is None:
                self._for_robot.append(command)
            else:
                self._robot.send(command)

    def kill(self) -> None:
        """End the robot's process."""
        with self._lock:
            self._robot, self._for_robot = None, []
            if self._forks:
                self._send_to_host(Kill())
            elif self._host is not None:
                self._end_host()

    def standstill(self, files: RobotFiles) -> Standstill | None:
        """Return where the robot's code, or its process's start, stands. End it if no Python code can run there."""
        report = self._crash_report(self._number)
        standstill = standstill_of(report, files)
        if standstill is None and moment_of(report) is None:
            return loading_for(time.monotonic() - self._launched_at)
        if standstill is not None and standstill.hopeless:
            self.kill()
        return standstill

    def preload(self, modules: tuple[str, ...]) -> None:
        """Have robots to come find these modules imported."""
        with self._lock:
            self._preloaded = modules
            if self._forks:
                self._send_to_host(Preload(modules))
            elif self._spare is not None and self._spare.connection is not None:
                with suppress(OSError):  # it has ended
                    self._spare.connection.send(Preload(modules))

    def close(self) -> None:
        """End everything; a robot that listens may bring its files to an end before."""
        with self._lock:
            robot, ended = self._robot, self._ended
        if robot is not None and not self._closed:
            robot.send(Quit())
            ended.wait(_PATIENCE)
        with self._lock:
            if self._closed:
                return
            self._closed = True
            output, self._output = self._output, None
            if self._host is not None:
                self._end_host()
            self._end_spare()
        if output is not None:  # what was printed until now is not lost
            output.close()
        # In a thread of its own: when the listener has left its loop already, this waits until the listener is closed.
        _thread(self._wake_the_listener, "pyfrc sim: wake")
        self._accepting.join(_PATIENCE)
        self._listener.close()
        self._temporary.cleanup()

    # -- the host -----------------------------------------------------------------------------------------------

    def _begin_host(self) -> None:
        self._host_connection, self._host_reader, self._for_host = None, None, []
        if self._output is not None:
            _thread(self._output.close, "pyfrc sim: end of output")
        if self._spare is not None and self._spare.process.poll() is not None:
            self._end_spare()
        started, self._spare = self._spare or self._start_host(), None
        self._host, self._output, self._host_name = started.process, started.output, started.name
        self._host_connection = started.connection
        _thread(self._wait_for, "pyfrc sim: end", started.process, self._number)

    def _start_host(self) -> _Spare:
        name, output = f"host {next(self._hosts)}", OutputPipe(self._on_output)
        hosting = Hosting(self._listener.address, self._key, self._forks, self._temporary.name, name, output.stamp)
        return _Spare(name, start_host(hosting, output.writing_end), output)

    def _end_spare(self) -> None:
        spare, self._spare = self._spare, None
        if spare is not None:
            kill_group(spare.process)
            spare.process.wait()
            spare.output.close()

    def _end_host(self) -> None:
        host, self._host = self._host, None
        assert host is not None
        if self._host_connection is not None:
            with suppress(OSError, subprocess.TimeoutExpired):
                self._host_connection.send(Quit())
                if self._forks:
                    host.wait(_HOST_PATIENCE)
            self._host_connection = None
        if not self._forks:  # it is the robot's process, and may complete the robot's data logs
            with suppress(OSError, subprocess.TimeoutExpired):
                if os.name == "posix":
                    host.terminate()
                elif self._robot is not None:
                    self._robot.send(Quit())
                if os.name == "posix" or self._robot is not None:
                    host.wait(_HOST_PATIENCE)
        kill_group(host)
        host.wait()

    def _send_to_host(self, message: object) -> None:
        if self._host_connection is None:
            self._for_host.append(message)
            return
        with suppress(OSError):
            self._host_connection.send(message)

    # -- threads --------------------------------------------------------------------------------------------------

    def _accept(self) -> None:
        while not self._closed:
            try:
                connection = self._listener.accept()
                who = introduced(connection)
            except (OSError, EOFError):  # closed, or not one of ours
                continue
            except Exception:  # a stranger without the key
                continue
            with self._lock:
                if who == self._host_name and self._host is not None:
                    self._host_connection = connection
                    for message in self._for_host:
                        self._send_to_host(message)
                    self._for_host.clear()
                    if self._forks:
                        self._host_reader = _thread(self._hear_host, "pyfrc sim: host", connection)
                elif self._spare is not None and who == self._spare.name:
                    self._spare.connection = connection
                    self.preload(self._preloaded)
                elif who == self._number and not self._closed:
                    if self._spare is None and not self._forks:
                        self._spare = self._start_host()
                    self._robot = Outbox(connection)
                    for message in self._for_robot:
                        self.send(message)
                    self._for_robot.clear()
                    if (channel := self._channels.get(who)) is not None:
                        channel.connected(connection)
                else:
                    if who in self._barriers:
                        self._barriers.pop(who).set()
                    connection.close()

    def _hear_host(self, connection: Connection) -> None:
        with suppress(OSError, EOFError):
            while True:
                message = connection.recv()
                if isinstance(message, Exited):
                    self._exited(message.number, message.status)

    def _wait_for(self, host: StartedProcess, number: int) -> None:
        """Report the robot's exit where it comes with the host's: always where nothing is forked."""
        status = host.wait()
        self._all_accepted()
        with self._lock:
            unexpected, reader = host is self._host, self._host_reader
            if self._forks:
                if not unexpected:
                    return
                number = self._number
        if reader is not None:
            reader.join()  # what the host has reported itself comes first
        if unexpected:
            kill_group(host)
        self._exited(number, status)

    def _exited(self, number: int, status: int) -> None:
        self._all_accepted()
        with self._lock:
            channel = self._channels.pop(number, None)
        if channel is not None:
            channel.ended(status)

    def _all_accepted(self) -> None:
        """Wait until every connection that was made before now has been accepted: they are, in their order."""
        name = os.urandom(8).hex()
        accepted = self._barriers[name] = threading.Event()
        # An error: the listener is closed.
        with suppress(Exception), Client(self._listener.address, authkey=self._key) as barrier:
            barrier.send(name)
            accepted.wait()

    def _received(self, number: int, message: Message) -> None:
        if isinstance(message, Failed):
            self._flush_output()
        self._on_message(number, message)

    def _gone(self, number: int, status: int) -> None:
        self._flush_output()
        if number == self._number:
            self._ended.set()
        self._on_exit(number, status, self._crash_report(number))

    def _flush_output(self) -> None:
        """What a robot has printed comes before its end."""
        with self._lock:
            output = self._output
        if output is not None:
            output.flush()

    def _wake_the_listener(self) -> None:
        with suppress(Exception):
            Client(self._listener.address, authkey=self._key).close()

    def _crash_log(self, number: int) -> Path:
        return Path(self._temporary.name, f"crash-{number}")

    def _crash_report(self, number: int) -> bytes:
        with suppress(OSError):
            return self._crash_log(number).read_bytes()
        return b""


def _address(directory: str) -> str | None:
    """Return where to listen; None for where multiprocessing chooses.

    A file in a directory of our own stays when this process is killed, for the host to tidy away.
    """
    if os.name != "posix":
        return None
    file = str(Path(directory, "listener"))
    if sys.platform == "linux" and len(os.fsencode(file)) > _LONGEST_NAME:
        return f"\0pyfrc-sim-{os.urandom(16).hex()}"  # no file: it is gone with the process
    return file


def introduced(connection: Connection) -> object:
    """Return who has connected; a function, for tests that need this to be late."""
    return connection.recv()


def _thread(target: Callable[..., object], name: str, *arguments: Any) -> threading.Thread:
    thread = threading.Thread(target=target, name=name, args=arguments, daemon=True)
    thread.start()
    return thread


def start_host(hosting: Hosting, output: int) -> spawn.StartedProcess:
    """Start a host.

    :param output: the descriptor of what the host prints into
    :return: its process; on POSIX the leader of a session of its own
    """
    return spawn.start(
        spawn.Start(
            partial(main, hosting),
            stdout=output,
            stderr=subprocess.STDOUT,
            environment=ENVIRONMENT,
            own_session=True,
            ends_with_owner=False,  # it ends with the simulation, which is not bound to a thread
        )
    )
