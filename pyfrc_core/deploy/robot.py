"""The laptop's side of the conversation with the agent on the robot."""

from __future__ import annotations

import getpass
import json
import re
import socket
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from . import standing
from .agent import watching, wire
from .agent_stream import PYTHON, AgentStream, Channel, TimeLimits
from .answers import AnswerError, Fields
from .errors import ConnectionFailedError, DeployError, LockedError
from .facts import Deployed, DeployRequest, Plan, RobotFacts, RolledBack, StartState, Watched

if TYPE_CHECKING:
    from .discovery import Address
    from .manifest import Entry, Manifest
    from .standing import Standing

__all__ = ["DeployRequest", "Deployed", "Plan", "Robot", "RobotFacts", "RolledBack", "StartState", "Watched"]

#: Stands for the start command that we have written.
_ANY = "any"
#: Characters of a program's output that are kept while it is watched.
_OUTPUT_KEPT = 1 << 16

OnProgress = Callable[[str, int, int], None]
T = TypeVar("T")

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
COMMAND = f"{PYTHON} -X utf8 -u -c '{_BOOTSTRAP}'"
#: In the order in which they need each other; the last one's `main` is run.
_MODULES = (
    "__init__",
    "system",
    "virtual",
    "wire",
    "disk",
    "imports",
    "places",
    "inventory",
    "activity",
    "releases",
    "compiling",
    "content_index",
    "deploying",
    "console",
    "watching",
    "program",
    "serve",
)
_DOCSTRING = re.compile(r'^( *)""".*?"""$', re.MULTILINE | re.DOTALL)
_COMMENT = re.compile(r"(?:^ *|  )#[: ].*", re.MULTILINE)


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
    modules = [[name, _without_prose((directory / f"{each}.py").read_text("utf-8"))] for each, name in names.items()]
    packed = zlib.compress(json.dumps(modules).encode(), 9)
    return b"%08d" % len(packed) + packed


def _without_prose(source: str) -> str:
    """Return a module's source with its docstrings and comments empty: less to send over a slow link.

    Each line keeps its number, for tracebacks. It is done by patterns because `ast.unparse` takes a tenth of a second
    for the agent. They suit the agent's modules: in these, only a docstring begins a line with three quotes.
    """
    source = _DOCSTRING.sub(lambda found: f'{found[1]}""' + "\n" * found[0].count("\n"), source)
    return _COMMENT.sub("", source)


class Robot:
    """The agent on a robot, ready to be asked; `close` ends it.

    Each method raises `ConnectionFailedError` when the link is lost, `RefusedError` when the robot cannot do what it is
    asked for, and another `DeployError` when it fails.
    """

    def __init__(self, stream: AgentStream) -> None:
        self._stream = stream
        self._planned: Manifest | None = None
        #: Whether the old program survived the kill script at the last restart; it was ended by signals then.
        self.program_survived = False
        self._current: int | None = None
        self._previous: int | None = None
        #: The robot's start command, if there is one; `_ANY` after a change of ours.
        self._command: str | None = None
        #: Whether the robot has said how far it is: what was sent may still be in the link's buffers.
        self._has_signs = False
        #: What is so while the robot's program is being changed.
        self.standing: Standing | None = None
        #: What there was on the robot when the conversation began.
        self.facts: RobotFacts

    @classmethod
    def start(
        cls, connection: Connected, *, hello: Mapping[str, Any] | None = None, limits: TimeLimits | None = None
    ) -> Robot:
        """Send the agent to the robot and hear what it finds there.

        :param hello: further things to send first: ``modules`` that the robot's Python is asked for; in tests, the
            ``root`` directory with the robot's files
        """
        robot = cls(AgentStream(connection.open(COMMAND), str(connection.address), limits or TimeLimits()))
        try:
            robot._stream.start(agent_package() + wire.said_frame({"who": _who(), **(hello or {})}))
            robot.facts = robot._stream.answer(RobotFacts.of, silence=robot._stream.limits.start)
            robot._current, robot._command = robot.facts.current, robot.facts.command
        except BaseException:
            robot.close()
            raise
        return robot

    def close(self) -> None:
        """End the conversation, and the agent."""
        self._stream.close()

    def info(self) -> RobotFacts:
        """What there is on the robot now."""
        return self._ask(RobotFacts.of, "info")

    def plan(self, manifest: Manifest, on_progress: OnProgress | None = None) -> Plan:
        """What a deploy of these files would do; nothing is written on the robot."""
        with self._shown(on_progress):
            plan = self._ask(Plan.of, "plan", files=_as_lists(manifest))
        self._planned = manifest
        return plan

    def deploy(self, manifest: Manifest, request: DeployRequest, on_progress: OnProgress | None = None) -> Deployed:
        """Make these files the robot's current release, or leave it as it was. The program is not restarted.

        :param on_progress: called with the phase that the robot is in (``receive``, ``compile``, ``switch``, ...), how
            many of its steps are done, and how many it has; 0: not known. The steps of ``receive`` are bytes. Until the
            robot says so for the first time, after a second, ``send`` has the bytes that have left.
        """
        # The agent has kept the manifest that was planned with.
        files = {} if manifest is self._planned else {"files": _as_lists(manifest)}

        def heard(said: Fields) -> None:
            phase = said.line("phase")
            if phase == "switch":
                self.standing = standing.OVERWRITES if request.in_place else standing.TAKES_OVER
            if on_progress is not None:
                on_progress(phase, 0, 0)

        with self._shown(on_progress):
            self._say("deploy", **asdict(request), **files)
            needed = self._stream.next(lambda fields: _needed(fields, manifest))
            if needed:
                self._send_contents(needed, on_progress)
            try:
                with self._knowing_what_was_changed():
                    deployed = self._stream.answer(lambda fields: _deployed(fields, request), heard)
            except ConnectionFailedError:
                if self.standing is None:  # the report that the switch begins may be lost with the link
                    self.standing = standing.OVERWRITES if request.in_place else standing.MAY_TAKE_OVER
                raise
        self._current, self._previous, self._command = deployed.release, deployed.previous, _ANY
        if request.in_place or deployed.release is None:
            self.standing = None
        else:
            self.standing = standing.deployed(deployed.release, deployed.previous)
        return deployed

    def restart(self) -> bool:
        """Stop the program and start what is current; the robot listens to its console from before on.

        :return: `program_survived`
        """
        self.program_survived = self._ask(lambda fields: fields.flag("survived"), "restart")
        self.standing = standing.started(self._current, self._previous)
        return self.program_survived

    def watch(
        self,
        seconds: float,
        on_output: Callable[[str], None] | None = None,
        on_state: Callable[[StartState], None] | None = None,
        unheard: float | None = None,
    ) -> Watched:
        """Watch the program that was just started: until it runs, has ended, or `seconds` are over.

        :param on_output: called with what the program prints
        :param on_state:  called about every second with what is seen of it
        :param unheard:   seconds after which a program whose console is silent is judged by its process alone
        """
        output = ""

        def heard(said: Fields) -> None:
            nonlocal output
            if "watching" in said:
                state = StartState.of(said.object("watching"))
                self.standing = standing.started(self._current, self._previous, state)
                if on_state is not None:
                    on_state(state)
                return
            printed = said.text("output")
            output = (output + printed)[-_OUTPUT_KEPT:]
            if on_output is not None:
                on_output(printed)

        self._say("watch", seconds=seconds, unheard=seconds if unheard is None else unheard)
        verdict, state = self._stream.answer(
            lambda fields: (fields.one_of("verdict", watching.VERDICTS), StartState.of(fields)),
            heard,
            silence=self._stream.limits.start,
            within=seconds + 2 * self._stream.limits.start,
        )
        self.standing = None
        return Watched(verdict, output, state)

    def rollback(self, release: int | None = None, on_progress: OnProgress | None = None) -> RolledBack:
        """Make an earlier release current again: the one with this number, or that before. It is not restarted."""
        with self._shown(on_progress):
            back = self._change(RolledBack.of, standing.GOES_BACK, "rollback", release=release)
        # None: to go back from there would lead to what was gone back from.
        self._current, self._previous, self._command = back.release.number, None, _ANY
        self.standing = standing.went_back(back.release.number)
        return back

    def undeploy(self, on_progress: OnProgress | None = None) -> bool:
        """Stop the program and remove it, with all releases; whether there was one."""
        with self._shown(on_progress):
            removed = self._change(lambda fields: fields.flag("removed"), standing.GOES_AWAY, "undeploy")
        self.standing = None
        return removed

    def _change(self, parse: Callable[[Fields], T], meanwhile: Standing, op: str, **request: Any) -> T:
        before, self.standing = self.standing, meanwhile
        try:
            with self._knowing_what_was_changed():
                return self._ask(parse, op, **request)
        except LockedError:
            self.standing = before  # the releases may have changed, but another computer did that
            raise

    @contextmanager
    def _knowing_what_was_changed(self) -> Iterator[None]:
        """When the robot refuses or fails in the middle of a change, ask it whether anything was changed."""
        try:
            yield
        except ConnectionFailedError:
            raise
        except DeployError:
            if self.standing not in (None, standing.OVERWRITES):
                with suppress(DeployError):
                    now = self.info()
                    command = _ANY if now.command and self._command == _ANY else now.command
                    if (now.current, command) == (self._current, self._command):
                        self.standing = None
                    elif now.current != self._current and now.current is not None:
                        self.standing = standing.deployed(now.current, self._current)
            raise

    def _ask(self, parse: Callable[[Fields], T], op: str, **request: Any) -> T:
        self._say(op, **request)
        return self._stream.answer(parse)

    def _say(self, op: str, **request: Any) -> None:
        self._stream.ask({"op": op, **request})

    def _send_contents(self, entries: list[Entry], on_progress: OnProgress | None) -> None:
        packing = zlib.compressobj(6)
        done, total = 0, sum(entry.size for entry in entries)
        waiting = b""
        for piece in _pieces(entries):
            done += len(piece)
            waiting += packing.compress(piece)
            if len(waiting) >= wire.PIECE:
                if self._stream.has_news():
                    return  # the robot does not want more: its answer says why
                self._stream.send(wire.frame(wire.CONTENT, waiting))
                waiting = b""
                if on_progress is not None and not self._has_signs:
                    on_progress("send", done, total)
        self._stream.send(wire.frame(wire.CONTENT, waiting + packing.flush()))

    @contextmanager
    def _shown(self, on_progress: OnProgress | None) -> Iterator[None]:
        """Pass the robot's signs of life on meanwhile."""

        def show(sign: Any) -> None:
            # What a sign of life says is for show: one that says nothing is a sign all the same.
            with suppress(AnswerError):
                fields = Fields(sign)
                if on_progress is not None:
                    on_progress(fields.line("phase"), fields.count("count"), fields.count("of"))

        self._has_signs = False
        self._stream.on_alive = show
        try:
            yield
        finally:
            self._stream.on_alive = None


def _deployed(fields: Fields, request: DeployRequest) -> Deployed:
    deployed = Deployed.of(fields)
    if deployed.release is None and not request.in_place:
        raise AnswerError("'release' is null")
    return deployed


def _needed(fields: Fields, manifest: Manifest) -> list[Entry]:
    """The files whose contents the robot asks for: some of those that were offered, each once."""
    by_path = {entry.path: entry for entry in manifest.entries}
    paths = fields.texts("need")
    if not by_path.keys() >= set(paths) or len(set(paths)) < len(paths):
        raise AnswerError("'need' has files that were not offered, or one of them twice")
    return [by_path[path] for path in paths]


def _as_lists(manifest: Manifest) -> list[list[Any]]:
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
