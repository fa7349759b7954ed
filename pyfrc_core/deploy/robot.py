"""The laptop's side of the conversation with the agent on the robot."""

from __future__ import annotations

import getpass
import json
import socket
import zlib
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from . import standing
from .agent import wire
from .errors import ConnectionFailedError, DeployError, RefusedError
from .facts import Deployed, DeployRequest, Plan, Release, RobotFacts, RolledBack, Watched

if TYPE_CHECKING:
    from .discovery import Address
    from .manifest import Entry, Manifest
    from .standing import Standing

__all__ = ["DeployRequest", "Deployed", "Plan", "Release", "Robot", "RobotFacts", "RolledBack", "Watched"]

OnProgress = Callable[[str, int, int], None]

_PYTHON = "/usr/local/bin/python3"
# All that ever stands in a command line; it reads how many bytes follow, and those: the agent's modules.
_BOOTSTRAP = """
import json,sys,types,zlib
r=open(0,"rb",0)
def g(n):
 b=b""
 while len(b)<n:
  c=r.read(n-len(b))
  if not c:sys.exit("the agent has not arrived")
  b+=c
 return b
for n,s in json.loads(zlib.decompress(g(int(g(8))))):
 m=sys.modules[n]=types.ModuleType(n)
 m.__package__="pyfrc_core.deploy.agent"
 exec(compile(s,n,"exec"),m.__dict__)
m.main(r)
"""
COMMAND = f"{_PYTHON} -X utf8 -u -c '{_BOOTSTRAP}'"
#: In the order in which they need each other; the last one's `main` is run.
_MODULES = ("__init__", "wire", "disk", "places", "releases", "compiling", "deploying", "program", "serve")

#: Seconds without a word from the robot after which the link counts as lost.
_ANSWER_SECONDS = 20.0
#: The same while it works: it compiles, and waits for its disk.
_WORK_SECONDS = 60.0

_WHOLE = "The robot has its old program or the new one, whole. Check the link and run the command again."


class Channel(Protocol):
    """What is needed of `paramiko.Channel`."""

    def sendall(self, data: bytes, /) -> None: ...
    def recv(self, count: int, /) -> bytes: ...
    def recv_ready(self) -> bool: ...
    def recv_stderr(self, count: int, /) -> bytes: ...
    def recv_exit_status(self) -> int: ...
    def settimeout(self, seconds: float | None, /) -> None: ...
    def close(self) -> None: ...


class Connected(Protocol):
    """What is needed of `Connection`."""

    address: Address

    def open(self, command: str) -> Channel: ...


@cache
def agent_package() -> bytes:
    """The agent as the bootstrap reads it."""
    package = wire.__name__.rpartition(".")[0]
    directory = Path(wire.__file__).parent
    names = {each: package if each == "__init__" else f"{package}.{each}" for each in _MODULES}
    modules = [[name, (directory / f"{each}.py").read_text(encoding="utf-8")] for each, name in names.items()]
    packed = zlib.compress(json.dumps(modules).encode(), 9)
    return b"%08d" % len(packed) + packed


class Robot:
    """The agent on a robot, ready to be asked; `close` ends it.

    Each method raises `ConnectionFailedError` when the link is lost, `RefusedError` when the robot cannot do what it is
    asked for, and another `DeployError` when it fails.
    """

    def __init__(self, channel: Channel, where: str) -> None:
        self._channel = channel
        self._where = where
        self._planned: Manifest | None = None
        self._current: int | None = None
        self._previous: int | None = None
        #: What is so while the robot's program is being changed.
        self.standing: Standing | None = None
        #: What there was on the robot when the conversation began.
        self.facts: RobotFacts

    @classmethod
    def start(cls, connection: Connected, *, hello: dict[str, str] | None = None) -> Robot:
        """Send the agent to the robot and hear what it finds there.

        :param hello: where the agent is to look for the robot's files, in tests
        """
        robot = cls(connection.open(COMMAND), str(connection.address))
        try:
            try:
                robot._channel.sendall(agent_package() + wire.said_frame({"who": _who(), **(hello or {})}))
            except (OSError, EOFError) as error:
                raise robot._broken(error) from error  # where there is no Python, the command may have ended before
            robot.facts = RobotFacts.of(robot._answer(_ANSWER_SECONDS))
        except BaseException:
            robot.close()
            raise
        return robot

    def close(self) -> None:
        """End the conversation, and the agent."""
        with suppress(OSError, EOFError):  # the link may be gone
            self._channel.close()

    def info(self) -> RobotFacts:
        """What there is on the robot now."""
        return RobotFacts.of(self._ask("info"))

    def plan(self, manifest: Manifest) -> Plan:
        """What a deploy of these files would do; nothing is written on the robot."""
        told = self._ask("plan", files=_told(manifest))
        self._planned = manifest
        added, changed, removed = (tuple(told[key]) for key in ("added", "changed", "removed"))
        return Plan(added, changed, removed, told["files"], told["bytes"])

    def deploy(self, manifest: Manifest, request: DeployRequest, on_progress: OnProgress | None = None) -> Deployed:
        """Make these files the robot's current release, or leave it as it was. The program is not restarted.

        :param on_progress: called with the phase (``send``, ``compile``, ``switch``), and for ``send`` how many
            bytes are done, of how many
        """
        on_progress = on_progress or (lambda phase, done, total: None)
        # The agent has kept the manifest that was planned with.
        files = {} if manifest is self._planned else {"files": _told(manifest)}
        self._say("deploy", **asdict(request), **files)
        need = self._hear(_WORK_SECONDS)
        if need["need"]:
            wanted = set(need["need"])
            by_path = {entry.path: entry for entry in manifest.entries if entry.path in wanted}
            self._send_contents([by_path[path] for path in need["need"]], need["bytes"], on_progress)

        def heard(said: dict[str, Any]) -> None:
            if said["phase"] == "switch" and not request.in_place:
                self.standing = standing.TAKES_OVER
            on_progress(said["phase"], 0, 0)

        told = self._answer(_WORK_SECONDS, heard)
        self._current, self._previous = told["release"], told["previous"]
        self.standing = None if request.in_place else standing.deployed(told["release"], told["previous"])
        return Deployed(
            release=told["release"],
            previous=told["previous"],
            taken=told["taken"],
            unchanged=told["unchanged"],
            files_sent=told["files"],
            bytes_sent=told["bytes"],
        )

    def restart(self) -> None:
        """Stop the program and start what is current; the robot listens to its console from before on."""
        self._ask("restart")
        self.standing = standing.started(self._current, self._previous)

    def watch(self, seconds: float, on_output: Callable[[str], None] | None = None) -> Watched:
        """See how the program that was just started does: until it has started, has ended, or `seconds` are over.

        :param on_output: called with what the program prints
        """
        output: list[str] = []

        def heard(said: dict[str, Any]) -> None:
            output.append(said["output"])
            if on_output is not None:
                on_output(said["output"])

        self._say("watch", seconds=seconds)
        told = self._answer(seconds + _ANSWER_SECONDS, heard)
        self.standing = None
        return Watched(told["alive"], told["started"], "".join(output))

    def rollback(self, release: int | None = None) -> RolledBack:
        """Make an earlier release current again: the one with this number, or that before. It is not restarted."""
        told = self._change(standing.GOES_BACK, "rollback", release=release)
        self._current, self._previous = told["release"], told["previous"]
        self.standing = standing.went_back(told["release"])
        return RolledBack(Release.of(told["about"]), told["previous"], tuple(told["changed"]))

    def undeploy(self) -> bool:
        """Stop the program and remove it, with all releases; whether there was one."""
        removed = bool(self._change(standing.GOES_AWAY, "undeploy")["removed"])
        self.standing = None
        return removed

    def _change(self, meanwhile: Standing, op: str, **request: Any) -> dict[str, Any]:
        self.standing = meanwhile
        try:
            return self._ask(op, **request)
        except RefusedError:
            self.standing = None
            raise

    def _ask(self, op: str, **request: Any) -> dict[str, Any]:
        self._say(op, **request)
        return self._answer(_WORK_SECONDS)

    def _say(self, op: str, **request: Any) -> None:
        self._send(wire.said_frame({"op": op, **request}))

    def _send(self, data: bytes) -> None:
        try:
            self._channel.sendall(data)
        except (OSError, EOFError) as error:
            raise self._lost(error) from error

    def _send_contents(self, entries: list[Entry], total: int, on_progress: OnProgress) -> None:
        packing = zlib.compressobj(6)
        done = 0
        waiting = b""
        for piece in _pieces(entries):
            done += len(piece)
            waiting += packing.compress(piece)
            if len(waiting) >= wire.PIECE:
                if self._channel.recv_ready():
                    return  # the robot does not want more: its answer says why
                self._send(wire.frame(wire.CONTENT, waiting))
                waiting = b""
                on_progress("send", done, total)
        self._send(wire.frame(wire.CONTENT, waiting + packing.flush()))
        on_progress("send", total, total)

    def _answer(self, seconds: float, on_news: Callable[[dict[str, Any]], None] | None = None) -> dict[str, Any]:
        while True:
            said = self._hear(seconds)
            if "done" in said:
                done: dict[str, Any] = said["done"]
                return done
            if on_news is not None:
                on_news(said)

    def _hear(self, seconds: float) -> dict[str, Any]:
        self._channel.settimeout(seconds)
        try:
            said = wire.said_in(*wire.read_frame(self._read))
        except wire.EndedError as error:
            raise self._broken(error) from error
        except wire.WireError as error:
            raise DeployError(
                f"what the robot sends is not from our agent: {error}",
                where=self._where,
                remedy="Perhaps a login script on it prints something. " + _WHOLE,
            ) from error
        if "error" in said:
            raise self._error(said)
        return said

    def _read(self, count: int) -> bytes:
        pieces = []
        while count:
            try:
                piece = self._channel.recv(count)
            except (OSError, EOFError) as error:
                raise self._lost(error) from error
            if not piece:
                break
            pieces.append(piece)
            count -= len(piece)
        return b"".join(pieces)

    def _lost(self, error: BaseException) -> ConnectionFailedError:
        what = "no answer" if isinstance(error, TimeoutError) else str(error) or "the robot closed it"
        return ConnectionFailedError(f"the link to the robot was lost: {what}", where=self._where, remedy=_WHOLE)

    def _broken(self, error: BaseException) -> DeployError:
        """The stream has ended: what the robot's shell or Python has said tells why."""
        try:
            self._channel.settimeout(_ANSWER_SECONDS)
            status = self._channel.recv_exit_status()
            said = self._channel.recv_stderr(65536).decode(errors="replace").strip()
        except (OSError, EOFError):
            status, said = -1, ""
        if status in (126, 127):
            return RefusedError(
                f"there is no Python on the robot ({_PYTHON})",
                where=self._where,
                remedy="Install it with the package robotpy: python -m robotpy installer download-python on the "
                "internet, then, at the robot: python -m robotpy installer install-python",
            )
        if status <= 0:
            return self._lost(error)
        last = said.splitlines()[-1] if said else f"exit code {status}"
        return DeployError(f"the agent on the robot has ended: {last}", where=self._where, remedy=_WHOLE)

    def _error(self, said: dict[str, Any]) -> DeployError:
        kind, message, remedy = said["error"], said["message"], said["remedy"] or None
        if kind in ("bug", "protocol"):
            last = said.get("traceback", "").strip().splitlines()[-1:]
            return DeployError(": ".join([message, *last]), where=self._where, remedy=_WHOLE)
        return RefusedError(message, where=self._where, remedy=remedy)


def _told(manifest: Manifest) -> list[list[Any]]:
    return [[each.path, each.size, each.sha256, each.executable] for each in manifest.entries]


def _pieces(entries: list[Entry]) -> Iterator[bytes]:
    """The files' contents, each of exactly its size in the manifest; one that was changed shows by its hash."""
    for entry in entries:
        left = entry.size
        try:
            with entry.file.open("rb") as stream:
                while left and (piece := stream.read(min(left, wire.PIECE))):
                    yield piece
                    left -= len(piece)
        except OSError:
            pass
        while left:
            yield bytes(min(left, wire.PIECE))
            left -= min(left, wire.PIECE)


def _who() -> str:
    try:
        return f"{getpass.getuser()}@{socket.gethostname()}"
    except (OSError, KeyError, ImportError):
        return socket.gethostname()
