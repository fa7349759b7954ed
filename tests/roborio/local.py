"""The real agent in a directory of this machine, over a socket pair that can be closed: many deploys without SSH."""

from __future__ import annotations

import json
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
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib.metadata import distribution
from pathlib import Path
from types import TracebackType

from written_files import write_files

from pyfrc_core.deploy.agent.robot_paths import RobotPaths
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

    :param cut_to_robot:   bytes after which the connection is cut, counted on the way to the robot
    :param cut_from_robot: on the way back
    """

    def __init__(
        self,
        ours: socket.socket,
        alive: int,
        process: subprocess.Popen[bytes] | None,
        cut_to_robot: int | None = None,
        cut_from_robot: int | None = None,
    ) -> None:
        self._socket = ours
        self._alive = alive
        self._process = process
        self._limits = {"to": cut_to_robot, "from": cut_from_robot}
        self.bytes_to_robot = self.bytes_from_robot = 0
        #: Set: `recv_exit_status` waits by itself.
        self.status_event = threading.Event()
        self.status_event.set()
        #: How many calls the agent has made, once it has ended by itself.
        self.steps: int | None = None

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
        """What the agent has printed as errors."""
        return self._process.stderr.read() if self._process is not None and self._process.stderr is not None else b""

    def recv_exit_status(self) -> int:
        """The agent's, where it is a process of ours."""
        if self._process is None or self._alive < 0:
            return -1  # as paramiko returns after a lost connection
        return self._process.wait()

    def peak_memory(self) -> int:
        """The most that the agent, which is a process of ours and runs, has had in memory; bytes."""
        assert self._process is not None
        status = Path(f"/proc/{self._process.pid}/status").read_text(encoding="utf-8")
        return 1024 * int(status.partition("VmHWM:")[2].split()[0])

    def settimeout(self, seconds: float | None) -> None:
        """As of a socket."""
        self._socket.settimeout(seconds)

    def close(self) -> None:
        """Hang up, and wait until the agent and its children have ended."""
        if self._alive < 0:
            return
        self._socket.close()
        count = b""
        while piece := os.read(self._alive, 100):
            count += piece
        os.close(self._alive)
        self._alive = -1
        self.steps = int(count) if count else None
        if self._process is not None:
            self._process.wait()
            if self._process.stderr is not None:
                self._process.stderr.close()


class LocalRobot:
    """A robot's disk in a directory, and agents that work on it."""

    address = "local"

    def __init__(self, root: Path, controller: ControllerKind = ROBORIO) -> None:
        self.root = root
        self.controller = controller
        self.paths = RobotPaths(controller.layout, str(root))
        self.home = self.paths.home
        self._agents: Agents | None = None
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

    def start(self, agents: Agents, **options: int | bool | None) -> AgentClient:
        """An agent on it; for the options see `Agents.channel`."""
        self._agents, self._options = agents, options
        return AgentClient.start(self, hello={"root": str(self.root)})

    def open(self, command: str) -> LocalChannel:
        """What a connection does: run the agent."""
        assert command == agent_command(self.controller.python)
        assert self._agents is not None
        self.channel = self._agents.channel(self.root, **self._options)
        return self.channel

    def deploy(
        self,
        agents: Agents,
        project: Manifest,
        *,
        main: str = "robot.py",
        debug: bool = False,
        **options: int | bool | None,
    ) -> Deployed:
        """Deploy and hang up."""
        robot = self.start(agents, **options)
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


class Agents:
    """Starts agents: forks of one process that waits for the next."""

    def __init__(self) -> None:
        self._control, theirs = socket.socketpair()
        self._packages = tempfile.TemporaryDirectory()
        _link_wpilib(Path(self._packages.name))
        # Without site-packages: a robot's Python has few packages, and each agent reports them.
        path = os.pathsep.join([str(Path(__file__).parents[2]), self._packages.name])
        self._process = subprocess.Popen(
            [sys.executable, "-S", str(Path(__file__).with_name("zygote.py")), str(theirs.fileno())],
            pass_fds=[theirs.fileno()],
            env={**os.environ, "PYTHONPATH": path},
        )
        theirs.close()

    def __enter__(self) -> Agents:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._control.close()
        self._process.wait()
        self._packages.cleanup()

    def channel(
        self,
        root: Path,
        *,
        cut_to_robot: int | None = None,
        cut_from_robot: int | None = None,
        calls: bool = False,
        all_signs: bool = False,
        runs: bool | None = None,
    ) -> LocalChannel:
        """A new agent.

        :param calls:     its calls are counted
        :param all_signs: it gives a sign of life for everything that it does
        :param runs:      what each watch of a program sees: it runs, or it ends; None: what is so
        """
        ours, theirs = socket.socketpair()
        alive, end = os.pipe()
        options = {"calls": calls, "all_signs": all_signs, "runs": runs}
        message = json.dumps({"root": str(root), **options}).encode()
        socket.send_fds(self._control, [message], [theirs.fileno(), end])
        theirs.close()
        os.close(end)
        channel = LocalChannel(ours, alive, None, cut_to_robot, cut_from_robot)
        _skip_bootstrap(channel)
        return channel


def _link_wpilib(directory: Path) -> None:
    """Make a directory with links to the `wpilib` that is installed here, and nothing else."""
    wpilib = distribution("wpilib")
    for name in {file.parts[0] for file in wpilib.files or ()}:
        (directory / name).symlink_to(Path(str(wpilib.locate_file(name))))


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


class Processes:
    """Starts agents as a robot does: a Python that is sent everything.

    :param python: the Python that serves as the robot's
    :param shell:  what is run in its place
    """

    def __init__(self, python: str = sys.executable, shell: str | None = None) -> None:
        program = agent_command("python3").partition(" -c '")[2].removesuffix("'")
        self._command = [python, "-X", "utf8", "-u", "-c", program] if shell is None else ["sh", "-c", shell]

    def channel(
        self, root: Path, *, cut_to_robot: int | None = None, cut_from_robot: int | None = None
    ) -> LocalChannel:
        """A new agent."""
        ours, theirs = socket.socketpair()
        alive, end = os.pipe()
        process = subprocess.Popen(
            self._command, stdin=theirs, stdout=theirs, stderr=subprocess.PIPE, pass_fds=[end], start_new_session=True
        )
        theirs.close()
        os.close(end)
        return LocalChannel(ours, alive, process, cut_to_robot, cut_from_robot)


@contextmanager
def directory_in_memory() -> Iterator[Path]:
    """A directory in memory, where there is such a thing: hundreds of deploys would wait for the disk otherwise."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if os.access(memory, os.W_OK) else None) as name:
        yield Path(name)


def project_of(directory: Path, files: Mapping[str, str | bytes]) -> Manifest:
    """A project of these files, ready to be uploaded."""
    return build_manifest(write_files(directory, files), large=True)
