"""The real agent in a directory of this machine, over a socket pair that can be closed: many deploys without SSH."""

from __future__ import annotations

import os
import re
import select
import shutil
import socket
import stat
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from written_files import write_files

from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.layout import Layout
from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.agent.serve import Agent
from pyfrc_core.deploy.agent.start_monitor import ENDED, RUNNING
from pyfrc_core.deploy.agent.wire import LaptopPipe, Message, Wire, WireError
from pyfrc_core.deploy.agent_client import AgentClient, Deployed, DeployRequest
from pyfrc_core.deploy.agent_stream import agent_command, agent_package
from pyfrc_core.deploy.manifest import Manifest, build_manifest
from pyfrc_core.deploy.targets import ControllerKind
from pyfrc_core.deploy.targets.roborio import ROBORIO

#: Names with their kind, permissions and content, and which are hard links to one file.
Disk = tuple[frozenset[tuple[str, int, str | bytes]], frozenset[tuple[str, ...]]]

ROBOT_PY = "import wpilib\n\n\nclass Robot(wpilib.TimedRobot):\n    pass\n"


class Cut(OSError):
    """The connection was cut, as it was to be."""


class LocalChannel:
    """A channel to an agent on this machine.

    :param wait: waits until the agent and its children have ended
    :param cut_to_robot:   bytes after which the connection is cut, counted on the way to the robot
    :param cut_from_robot: on the way back
    """

    def __init__(
        self,
        ours: socket.socket,
        wait: Callable[[], object],
        cut_to_robot: int | None = None,
        cut_from_robot: int | None = None,
    ) -> None:
        self._socket = ours
        self._wait = wait
        self._limits = {"to": cut_to_robot, "from": cut_from_robot}
        self.bytes_to_robot = self.bytes_from_robot = 0
        self.is_open = True
        #: Set: `recv_exit_status` waits by itself.
        self.status_event = threading.Event()
        self.status_event.set()

    def sendall(self, data: bytes) -> None:
        """Send, up to the cut."""
        limit = self._limits["to"]
        if limit is not None and self.bytes_to_robot + len(data) > limit:
            self._socket.sendall(data[: limit - self.bytes_to_robot])
            self.bytes_to_robot = limit
            self.close()
            raise Cut("cut")
        self._socket.sendall(data)
        self.bytes_to_robot += len(data)

    def recv(self, count: int) -> bytes:
        """Receive, up to the cut."""
        limit = self._limits["from"]
        if limit is not None and self.bytes_from_robot >= limit:
            self.close()
            raise Cut("cut")
        try:
            piece = self._socket.recv(count if limit is None else min(count, limit - self.bytes_from_robot))
        except (
            ConnectionResetError
        ):  # the agent has ended with something unread: over SSH that is an end like any other
            return b""
        self.bytes_from_robot += len(piece)
        return piece

    def recv_ready(self) -> bool:
        """Whether something has come."""
        return bool(select.select([self._socket], [], [], 0)[0])

    def recv_stderr(self, count: int) -> bytes:
        """What the agent has printed as errors: nothing."""
        return b""

    def recv_exit_status(self) -> int:
        """What paramiko returns after a lost connection."""
        return -1

    def settimeout(self, seconds: float | None) -> None:
        """As of a socket."""
        self._socket.settimeout(seconds)

    def close(self) -> None:
        """Hang up, and wait until the agent and its children have ended."""
        if self.is_open:
            self.is_open = False
            hang_up(self._socket)
            self._wait()


def hang_up(connection: socket.socket) -> None:
    """Close a connection, also where a process that was forked meanwhile has it."""
    with suppress(OSError):  # the other end may have closed it
        connection.shutdown(socket.SHUT_RDWR)
    connection.close()


class LocalAgent(Agent):
    """An agent in a thread of this process.

    :param all_signs: it gives a sign of life for everything that it does
    :param runs:      what each watch of a program sees: it runs, or it ends; None: what is so
    """

    def __init__(self, wire: Wire, hello: Message, all_signs: bool = False, runs: bool | None = None) -> None:
        host = RealRobot(RobotPaths(Layout(**hello["layout"]), hello["root"]))
        host.processes = set  # type: ignore[method-assign]  # listing all of this machine's takes long
        super().__init__(wire, host, hello)
        if all_signs:
            self._activity._pause = 0.0
        if runs is not None:
            seen = {"verdict": RUNNING if runs else ENDED, "heard": True, "seen": True}
            watched = {**seen, "seconds": 1.0, "age": 1.0, "lived": 1.0}
            self._program.watch = lambda *_: watched  # type: ignore[method-assign]

    def facts(self, request: Message) -> Message:
        """As on a robot, whose Python has few packages."""
        facts = super().facts(request)
        return {**facts, "packages": {"wpilib": facts["packages"]["wpilib"]}}

    @classmethod
    def run(cls, connection: socket.socket, **options: Any) -> None:
        """Run an agent with its laptop at the other end of a connection."""
        with open(connection.fileno(), "rb", 0, closefd=False) as source:
            wire = Wire(source, LaptopPipe(connection.fileno()))
            try:
                agent = cls(wire, wire.receive(), **options)
                serve_to_the_end(agent)
            except (WireError, ConnectionError):
                pass  # the laptop has disconnected
            finally:
                hang_up(connection)


def serve_to_the_end(agent: Agent) -> None:
    """Serve, and release the lock, which ends with the process of an agent on a robot."""
    try:
        agent.serve()
    finally:
        if agent._lock is not None:
            agent._lock.close()


class LocalRobot:
    """A robot's disk in a directory, and agents that work on it."""

    address = "local"

    def __init__(self, root: Path, controller: ControllerKind = ROBORIO) -> None:
        self.root = root
        self.controller = controller
        self.paths = RobotPaths(controller.layout, str(root))
        self.home = self.paths.home
        #: What starts agents; None: they are threads of this process.
        self.agents: Processes | None = None
        self._options: dict[str, int | bool | None] = {}

    @classmethod
    def new(cls, root: Path, controller: ControllerKind = ROBORIO) -> LocalRobot:
        """A robot on which nothing was ever deployed."""
        robot, layout = cls(root, controller), controller.layout
        stop = robot.paths.of(layout.restart[0])
        for directory in (robot.home, root / "tmp", stop.parent):
            directory.mkdir(parents=True)
        for file in (*layout.texts.values(), *layout.profiles):
            robot.paths.of(file).parent.mkdir(parents=True, exist_ok=True)
            robot.paths.of(file).write_text("")
        if controller.has_image_file:
            robot.paths.of(layout.texts["image"]).write_text('IMAGEVERSION = "FRC_roboRIO_2026_v1.2"\n')
        stop.write_text("#!/bin/sh\n")
        stop.chmod(0o755)
        return robot

    def copy(self, root: Path) -> LocalRobot:
        """Another robot with the same on its disk, in the place of what is there."""
        shutil.rmtree(root, ignore_errors=True)
        shutil.copytree(self.root, root, symlinks=True)
        return LocalRobot(root, self.controller)

    def disk(self) -> Disk:
        """What is on its disk; equal where the agent finds the same, whenever it was written."""
        names: dict[int, list[str]] = {}
        entries = []
        root = str(self.root)
        for directory, directories, files in os.walk(root):
            for name in (*directories, *files):
                path = os.path.join(directory, name)  # noqa: PTH118 - hundreds of disks of dozens of files
                about = os.lstat(path)
                content: str | bytes = b""
                if stat.S_ISLNK(about.st_mode):
                    content = os.readlink(path)  # noqa: PTH115
                elif stat.S_ISREG(about.st_mode):
                    names.setdefault(about.st_ino, []).append(path[len(root) :])
                    with open(path, "rb") as file:  # noqa: PTH123
                        content = file.read()
                entries.append((path[len(root) :], about.st_mode, content))
        links = (tuple(sorted(each)) for each in names.values() if len(each) > 1)
        return frozenset(entries), frozenset(links)

    def start(self, *, modules: Sequence[str] = (), **options: int | bool | None) -> AgentClient:
        """An agent on it, which looks for modules; for the options see `LocalChannel` and `LocalAgent`."""
        self._options = options
        return AgentClient.start(self, hello={"root": str(self.root), "modules": list(modules)})

    def open(self, command: str) -> LocalChannel:
        """What a connection does: run the agent."""
        assert command == agent_command(self.controller.python)
        start = channel_to_thread if self.agents is None else self.agents.channel
        self.channel = start(**self._options)
        return self.channel

    def deploy(
        self,
        project: Manifest,
        *,
        main: str = "robot.py",
        debug: bool = False,
        **options: int | bool | None,
    ) -> Deployed:
        """Deploy and hang up."""
        robot = self.start(**options)
        try:
            return robot.deploy(project, DeployRequest(main, {"deploy-user": "somebody"}, debug))
        finally:
            robot.close()

    def startable(self) -> dict[str, bytes] | None:
        """The files of the program that would be started now, by their names; none: there is no start command."""
        command = self.paths.start_command()
        if not command:
            return None
        match = re.search(rf"--main ({self.controller.layout.home}/\S+) (?:-v )?run\n?$", command)
        assert match is not None, f"this is no start command: {command!r}"
        main = self.root / match[1].lstrip("/")
        assert main.is_file(), f"the start command names a file that is not there: {match[1]}"
        directory = main.parent  # unresolved: seen from outside a look-alike, its root is no plain path
        return {
            file.relative_to(directory).as_posix(): file.read_bytes()
            for file in directory.rglob("*")
            if file.is_file() and "__pycache__" not in file.parts and file.name != "deploy.json"
        }


def channel_to_thread(
    *, cut_to_robot: int | None = None, cut_from_robot: int | None = None, **options: Any
) -> LocalChannel:
    """A channel to a new agent in a thread."""
    ours, theirs = socket.socketpair()
    thread = threading.Thread(target=LocalAgent.run, args=[theirs], kwargs=options, daemon=True)
    thread.start()
    channel = LocalChannel(ours, thread.join, cut_to_robot, cut_from_robot)
    _skip_bootstrap(channel)
    return channel


def _skip_bootstrap(channel: LocalChannel) -> None:
    """Such an agent has its modules already: what its bootstrap would read is left out of what is sent to it."""
    left = len(agent_package())
    send = channel.sendall

    def sendall(data: bytes) -> None:
        nonlocal left
        skipped = min(left, len(data))
        left -= skipped
        if data[skipped:]:
            send(data[skipped:])

    channel.sendall = sendall  # type: ignore[method-assign]


class ProcessChannel(LocalChannel):
    """A channel to an agent in a process of its own.

    :param alive: a pipe that ends with the agent and its children
    """

    def __init__(self, ours: socket.socket, process: subprocess.Popen[bytes], alive: int, cut: int | None) -> None:
        super().__init__(ours, self._wait_for_end, cut)
        self._process = process
        self._alive = alive

    def recv_stderr(self, count: int) -> bytes:
        """What the agent has printed as errors."""
        assert self._process.stderr is not None
        return self._process.stderr.read()

    def recv_exit_status(self) -> int:
        """The agent's."""
        return self._process.wait() if self.is_open else super().recv_exit_status()

    def peak_memory(self) -> int:
        """The most that the agent, which runs, has had in memory; bytes."""
        status = Path(f"/proc/{self._process.pid}/status").read_text(encoding="utf-8")
        return 1024 * int(status.partition("VmHWM:")[2].split()[0])

    def _wait_for_end(self) -> None:
        while os.read(self._alive, 100):
            pass
        os.close(self._alive)
        self._process.wait()
        assert self._process.stderr is not None
        self._process.stderr.close()


class Processes:
    """Starts agents as a robot does: a Python that is sent everything.

    :param python: the Python that serves as the robot's
    :param shell:  what is run in its place
    """

    def __init__(self, python: str = sys.executable, shell: str | None = None) -> None:
        program = agent_command("python3").partition(" -c '")[2].removesuffix("'")
        self._command = [python, "-X", "utf8", "-u", "-c", program] if shell is None else ["sh", "-c", shell]

    def channel(self, *, cut_to_robot: int | None = None) -> ProcessChannel:
        """A new agent."""
        ours, theirs = socket.socketpair()
        alive, end = os.pipe()
        process = subprocess.Popen(
            self._command, stdin=theirs, stdout=theirs, stderr=subprocess.PIPE, pass_fds=[end], start_new_session=True
        )
        theirs.close()
        os.close(end)
        return ProcessChannel(ours, process, alive, cut_to_robot)


@contextmanager
def directory_in_memory() -> Iterator[Path]:
    """A directory in memory, where there is such a thing: hundreds of deploys would wait for the disk otherwise."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if os.access(memory, os.W_OK) else None) as name:
        yield Path(name)


def project_of(directory: Path, files: Mapping[str, str | bytes]) -> Manifest:
    """A project of these files, ready to be uploaded."""
    return build_manifest(write_files(directory, files), large=True)
