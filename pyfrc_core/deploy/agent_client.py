"""Client for the deploy agent on the robot."""

from __future__ import annotations

import getpass
import socket
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, replace
from functools import partial
from typing import Any, Protocol, TypeVar

from ..file_hash import open_file
from . import recovery_hints
from .agent import start_monitor, wire
from .agent_stream import AgentChannel, AgentStream, TimeLimits, agent_command, agent_package
from .discovery import Address
from .errors import ConnectionFailedError, DeployError, OtherComputerError
from .facts import Deployed, DeployRequest, Plan, RobotFacts, RobotLog, RolledBack, StartState, Watched
from .manifest import Entry, Manifest
from .recovery_hints import RecoveryHint
from .responses import Raw, ResponseError, parse, value_of
from .targets import ControllerKind

__all__ = ["AgentClient", "DeployRequest", "Deployed", "Plan", "RobotFacts", "RolledBack", "StartState", "Watched"]

#: Placeholder for a start command written by this deploy.
_ANY = "any"
#: Characters of a program's output that a watch keeps.
_OUTPUT_KEPT = 1 << 16

OnProgress = Callable[[str, int, int], None]
T = TypeVar("T")


class CommandRunner(Protocol):
    """The part of `Connection` that `AgentClient` needs."""

    address: Address
    controller: ControllerKind

    def open(self, command: str) -> AgentChannel: ...


class AgentClient:
    """Sends requests to the agent on a robot. `close` ends the agent.

    Each method raises `ConnectionFailedError` if the connection is lost, `RefusedError` if the robot refuses the
    request, and another `DeployError` if the request fails.
    """

    def __init__(self, stream: AgentStream, controller: ControllerKind) -> None:
        self._stream = stream
        self._controller = controller
        #: Whether the robot restarts the program without another request.
        self._is_restarting = False
        #: Whether the old program survived the stop command at the last restart, and was ended by a signal.
        self.program_survived = False
        self._current: int | None = None
        self._previous: int | None = None
        #: The robot's start command, if any; `_ANY` after this client has written it.
        self._command: str | None = None
        #: Whether the robot has reported its progress. Until then, sent data may still be in network buffers.
        self._robot_reports_progress = False
        #: Explains the robot's state if the current change is interrupted.
        self.recovery_hint: RecoveryHint | None = None
        #: The robot's facts when the agent was started.
        self.facts: RobotFacts

    @classmethod
    def start(
        cls,
        connection: CommandRunner,
        *,
        hello: Mapping[str, Any] | None = None,
        limits: TimeLimits | None = None,
        python: str | None = None,
    ) -> AgentClient:
        """Start the agent on the robot, and read the robot's facts.

        :param python: the path of the Python in which it runs, or the beginning of a shell command; default: the path
            of the controller's
        :param hello: fields for the first message: ``modules`` to look for in the robot's Python; in tests, ``root``,
            the directory with the robot's files
        """
        controller = connection.controller
        channel = connection.open(agent_command(python or controller.python))
        stream = AgentStream(channel, str(connection.address), controller.python, limits or TimeLimits())
        client = cls(stream, controller)
        layout = controller.layout._asdict()
        first = wire.message_frame({"who": _user_and_host(), "layout": layout, **(hello or {})})
        try:
            stream.send(agent_package() + first, first=True)
            client.facts = stream.read_response(client._facts, silence=stream.limits.start)
        except BaseException:
            client.close()
            raise
        client._current, client._command = client.facts.current, client.facts.command
        return client

    @property
    def stop_command(self) -> str:
        """Return the name of the command that stops the program."""
        return self._controller.layout.stopper

    def close(self) -> None:
        """Close the connection to the agent, which then ends."""
        self._stream.close()

    def info(self) -> RobotFacts:
        """Return the robot's current facts."""
        return self._request(self._facts, "info")

    def _facts(self, message: object) -> RobotFacts:
        return RobotFacts.of(message, self._controller)

    def plan(self, manifest: Manifest, on_progress: OnProgress | None = None) -> Plan:
        """Return what a deploy of these files would do. Nothing is written on the robot."""
        with self._reporting(on_progress):
            return self._request(partial(parse, Plan), "plan", files=_as_lists(manifest))

    def check(self, on_progress: OnProgress | None = None) -> tuple[str, ...]:
        """Compare the robot's code with what was deployed and installed. Return the paths of files that differ."""
        with self._reporting(on_progress):
            return self._request(lambda done: value_of(done, "different", tuple[str, ...]), "check")

    def install(
        self,
        environment: str,
        python: str | None,
        wheels: Manifest,
        unpacked: Sequence[int],
        on_progress: OnProgress | None = None,
    ) -> int:
        """Make an environment on the robot, beside the current one. Return how many wheels were sent.

        Damaged files, also of other environments, are replaced.

        :param environment: its name
        :param python: the name of its Python, which is on the robot; None: the system's
        :param wheels: its packages
        :param unpacked: the bytes that each takes on the disk
        """
        listed = [
            [each.path, each.size, each.sha256, taken] for each, taken in zip(wheels.entries, unpacked, strict=True)
        ]
        with self._reporting(on_progress):
            self._send("install", environment=environment, python=python, wheels=listed)
            needed = self._stream.read_message(lambda message: _needed(message, wheels))
            if needed:
                self._send_contents(needed, on_progress, None)
            self._stream.read_response(lambda done: None)
        return len(needed)

    def deploy(self, manifest: Manifest, request: DeployRequest, on_progress: OnProgress | None = None) -> Deployed:
        """Make these files the robot's current release, or leave the robot unchanged.

        The program is restarted only if the request says so; `restart` must then follow.

        :param on_progress: called with the robot's phase (``receive``, ``compile``, ``switch``, ...), the number of
            completed steps, and the total (0 if unknown). The steps of ``receive`` are bytes. Until the robot's first
            report, which comes after one second, the phase ``send`` counts the sent bytes.
        """
        before, has_begun = self.recovery_hint, False
        # The robot switches as soon as it has all contents, and its report of this may be lost or not read. Without the
        # list of the contents that it needs, it may have all of them.
        unknown = recovery_hints.MAYBE_SWITCHED

        def on_message(message: object) -> None:
            nonlocal has_begun
            phase = value_of(message, "phase", str)
            if phase == "switch":
                has_begun = True
                self.recovery_hint = recovery_hints.SWITCHING
            if on_progress is not None:
                on_progress(phase, 0, 0)

        with self._reporting(on_progress), self._tracking_changes():
            try:
                self.recovery_hint = unknown
                self._send("deploy", **asdict(request), files=_as_lists(manifest))
                needed = self._stream.read_message(lambda message: _needed(message, manifest))
                if needed:
                    self.recovery_hint = before  # it waits for the last of them
                    self._send_contents(needed, on_progress, unknown)
                deployed = self._stream.read_response(partial(parse, Deployed), on_message)
            except ConnectionFailedError:
                raise
            except DeployError:
                if not has_begun:  # an error is reported in place of the switch
                    self.recovery_hint = before
                raise
        self._is_restarting = request.restart
        self._current, self._previous, self._command = deployed.release, deployed.previous, _ANY
        self.recovery_hint = recovery_hints.deployed(deployed.release, deployed.previous)
        return deployed

    def restart(self) -> bool:
        """Restart the program, or wait for the restart that a deploy has requested.

        :return: whether the old program survived the stop command, and was ended by a signal
        """
        if not self._is_restarting:
            self._send("restart")
        self._is_restarting = False
        self.program_survived = self._stream.read_response(lambda done: value_of(done, "survived", bool))
        self.recovery_hint = recovery_hints.started(self._current, self._previous)
        return self.program_survived

    def watch(
        self,
        seconds: float,
        on_output: Callable[[str], None] | None = None,
        on_state: Callable[[StartState], None] | None = None,
        unheard: float | None = None,
    ) -> Watched:
        """Watch the program after its restart, until it runs, it has ended, or the time limit is reached.

        :param seconds:   the time limit
        :param on_output: called with the program's output
        :param on_state:  called about once a second with the program's state
        :param unheard:   seconds after which a program with a silent console is judged by its process alone
        """
        output = ""

        def on_message(message: dict[str, Any]) -> None:
            nonlocal output
            if "watching" in message:
                state = value_of(message, "watching", StartState)
                self.recovery_hint = recovery_hints.started(self._current, self._previous, state)
                if on_state is not None:
                    on_state(state)
                return
            printed = value_of(message, "output", Raw)
            output = (output + printed)[-_OUTPUT_KEPT:]
            if on_output is not None:
                on_output(printed)

        self._send("watch", seconds=seconds, unheard=seconds if unheard is None else unheard)
        watched = self._stream.read_response(
            _watched,
            on_message,
            silence=self._stream.limits.start,
            within=seconds + 2 * self._stream.limits.start,
        )
        self.recovery_hint = None
        return replace(watched, output=output)

    def rollback(
        self, release: int | None = None, on_progress: OnProgress | None = None, *, only_from_deployed: bool = False
    ) -> RolledBack:
        """Make an earlier release current again. The program is not restarted.

        :param release: its number; default: the release that a rollback selects
        :param only_from_deployed: refuse if the release that this client has deployed is no longer current
        """
        request = {"release": release, "only_from": self._current if only_from_deployed else None}
        with self._reporting(on_progress):
            back = self._change(partial(parse, RolledBack), recovery_hints.rolling_back(release), "rollback", **request)
        # None: a rollback from there would return to the release that was rolled back.
        self._current, self._previous, self._command = back.release.number, None, _ANY
        self.recovery_hint = recovery_hints.rolled_back(back.release.number)
        return back

    def logs(self) -> tuple[tuple[RobotLog, ...], int]:
        """Return the logs on the robot, the newest first, and how many older ones are not named."""
        return self._request(
            lambda done: (value_of(done, "logs", tuple[RobotLog, ...]), value_of(done, "older", int)), "logs"
        )

    def read_log(self, path: str, offset: int, count: int) -> bytes:
        """Return a piece of a log, from `offset` on; fewer than `count` bytes at its end."""
        self._send("read-log", path=path, offset=offset, count=count)
        piece = self._stream.read_contents(count)
        self._stream.read_response(lambda done: None)
        return piece

    def hash_log(self, path: str, size: int) -> tuple[str, int]:
        """Return the SHA-256 of a log's first `size` bytes, in hexadecimal, and how many it has now."""
        return self._request(
            lambda done: (value_of(done, "sha256", str), value_of(done, "size", int)), "hash-log", path=path, size=size
        )

    def remove_log(self, path: str, size: int) -> None:
        """Remove a log that has this size, and that no program writes."""
        self._request(lambda done: None, "remove-log", path=path, size=size)

    def undeploy(self, on_progress: OnProgress | None = None) -> bool:
        """Stop the program and remove it with all releases. Return whether there was one."""
        with self._reporting(on_progress):
            removed = self._change(lambda done: value_of(done, "removed", bool), recovery_hints.UNDEPLOYING, "undeploy")
        self.recovery_hint = None
        return removed

    def _change(self, read: Callable[[object], T], hint: RecoveryHint, op: str, **request: Any) -> T:
        before, self.recovery_hint = self.recovery_hint, hint
        try:
            with self._tracking_changes():
                return self._request(read, op, **request)
        except OtherComputerError:
            self.recovery_hint = before  # if the releases have changed, another computer has changed them
            raise

    @contextmanager
    def _tracking_changes(self) -> Iterator[None]:
        """After an error during a change, ask the robot whether anything was changed, and update the hint."""
        try:
            yield
        except ConnectionFailedError:
            raise
        except DeployError:
            if self.recovery_hint is not None:
                with suppress(DeployError):
                    now = self.info()
                    command = _ANY if now.command and self._command == _ANY else now.command
                    if (now.current, command) == (self._current, self._command):
                        self.recovery_hint = None
                    elif now.current != self._current and now.current is not None:
                        self.recovery_hint = recovery_hints.deployed(now.current, self._current)
            raise

    def _request(self, read: Callable[[object], T], op: str, **request: Any) -> T:
        self._send(op, **request)
        return self._stream.read_response(read)

    def _send(self, op: str, **request: Any) -> None:
        self._stream.send_request({"op": op, **request})

    def _send_contents(self, entries: list[Entry], on_progress: OnProgress | None, then: RecoveryHint | None) -> None:
        """Send the contents of files.

        :param then: the hint from the last frame on
        """
        compressor = zlib.compressobj(6)
        done, total = 0, sum(entry.size for entry in entries)
        waiting = b""
        for chunk in _chunks(entries):
            done += len(chunk)
            waiting += compressor.compress(chunk)
            if len(waiting) >= wire.CHUNK_BYTES:
                if self._stream.has_message():
                    return  # the robot refuses the rest; its response has the reason
                self._stream.send(wire.frame(wire.CONTENT, waiting))
                waiting = b""
                if on_progress is not None and not self._robot_reports_progress:
                    on_progress("send", done, total)
        self.recovery_hint = then
        self._stream.send(wire.frame(wire.CONTENT, waiting + compressor.flush()))

    @contextmanager
    def _reporting(self, on_progress: OnProgress | None) -> Iterator[None]:
        """Pass the progress in keep-alive messages to `on_progress`."""

        def show(progress: object) -> None:
            # The content is only displayed, so a message with invalid content still counts as a keep-alive message.
            with suppress(ResponseError):
                step = value_of(progress, "phase", str), value_of(progress, "count", int), value_of(progress, "of", int)
                self._robot_reports_progress = True
                if on_progress is not None:
                    on_progress(*step)

        self._robot_reports_progress = False
        self._stream.on_keep_alive = show
        try:
            yield
        finally:
            self._stream.on_keep_alive = None


def _watched(done: object) -> Watched:
    watched = parse(Watched, done, output="", state=parse(StartState, done))
    if watched.verdict not in start_monitor.VERDICTS:
        raise ResponseError(f"there is no verdict {watched.verdict!r}")
    return watched


def _needed(message: object, manifest: Manifest) -> list[Entry]:
    """Return the files whose contents the robot requests.

    :raises ResponseError: if it requests a file that was not offered, or one file twice
    """
    by_path = {entry.path: entry for entry in manifest.entries}
    paths = value_of(message, "need", tuple[Raw, ...])
    if not by_path.keys() >= set(paths) or len(set(paths)) < len(paths):
        raise ResponseError("'need' has files that were not offered, or one of them twice")
    return [by_path[path] for path in paths]


def _as_lists(manifest: Manifest) -> list[list[Any]]:
    return [[each.path, each.size, each.sha256, each.executable] for each in manifest.entries]


def _chunks(entries: list[Entry]) -> Iterator[bytes]:
    """Yield the files' contents, each with exactly its size in the manifest.

    The robot detects a file that has changed by its hash.
    """
    for entry in entries:
        left = entry.size
        try:
            with open_file(entry.file) as stream:
                while left and (chunk := stream.read(min(left, wire.CHUNK_BYTES))):
                    yield chunk
                    left -= len(chunk)
        except OSError:
            pass
        while left:
            yield bytes(min(left, wire.CHUNK_BYTES))
            left -= min(left, wire.CHUNK_BYTES)


def _user_and_host() -> str:
    try:
        return f"{getpass.getuser()}@{socket.gethostname()}"
    except (OSError, KeyError, ImportError):
        return socket.gethostname()
