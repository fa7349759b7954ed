"""The agent's main loop: it sends the robot's facts, then responds to requests until the laptop disconnects."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

from ...wheel_files import WheelError
from .activity import Activity
from .content_index import WantedFile
from .disk import different_files, disk_problem, files_below, free_bytes, remove, sync, text_of
from .environment_files import Wheel
from .host import Host, RealRobot, age_of
from .imports import look_up
from .integrity import different_code
from .layout import Layout
from .logs import RobotLogs
from .program import Program
from .release_record import after_watch, now
from .releases import Releases
from .robot_paths import Lock, Refusal, RobotPaths
from .start_monitor import ENDED, RUNNING, UNHEARD
from .system import become, is_root, user
from .transaction import RESERVE, ContentReader, Deploy, plan
from .virtual import VirtualRobotClient
from .wire import EndedError, LaptopPipe, Message, Wire, WireError

_NO_SPACE = (errno.ENOSPC, errno.EDQUOT)
#: Files that a check names; any laptop can read this many.
_MAX_NAMED = 1000


def main(source: BinaryIO) -> None:
    """Run the agent. Requests come from `source`; responses go to standard output."""
    wire = Wire(source, LaptopPipe(os.dup(1)))
    hello = wire.receive()
    layout = Layout(**hello["layout"])
    host: Host | None = VirtualRobotClient.from_environment(layout)
    if host is None:
        root = hello.get("root")
        if root is None and is_root():
            become(layout.user)
        host = RealRobot(RobotPaths(layout, root or "/"))
    try:
        Agent(wire, host, hello).serve()
    except (WireError, ConnectionError):
        sys.exit(1)  # the laptop has disconnected


class Agent:
    """Handles the requests of one laptop.

    :param hello: the laptop's first message
    """

    def __init__(self, wire: Wire, host: Host, hello: Message) -> None:
        self._wire = wire
        self._host = host
        self._paths = host.paths
        self._activity = Activity(wire.send)
        self._releases = Releases(host.paths, self._activity)
        self._logs = RobotLogs(host.paths, self._activity)
        self._program = Program(host)
        self._hello = hello
        self._who = str(hello.get("who") or "another computer")
        #: The deploy lock, held from a change of the program to the end of the watch.
        self._lock: ExitStack | None = None
        #: The release that was started and not watched yet.
        self._started: int | None = None
        self._requests: dict[str, Callable[[Message], Message]] = {
            "plan": lambda request: plan(self._releases, request["files"]),
            "check": lambda request: {"different": different_code(self._releases)[:_MAX_NAMED]},
            "install": self._install,
            "deploy": self._deploy,
            "restart": lambda request: self._restart(),
            "watch": self._watch,
            "rollback": self._roll_back,
            "info": self.facts,
            "logs": lambda request: self._logs.named(),
            "read-log": self._read_log,
            "hash-log": self._logs.hashed,
            "remove-log": self._logs.remove,
            "undeploy": lambda request: self._undeploy(),
        }

    def serve(self) -> None:
        """Respond to requests until the laptop disconnects."""
        with closing(self._program):
            self._respond(self.facts, self._hello)
            while True:
                # Without the lock, the laptop may be waiting for its user, or still run the tests.
                self._wire.limits_silence = self._lock is not None
                try:
                    request = self._wire.receive()
                except EndedError:
                    return
                done = self._respond(lambda request: self._requests[request["op"]](request), request)
                if done and request.get("restart"):  # without another round trip
                    self._respond(lambda request: self._restart(prune=True), request)

    def _respond(self, handle: Callable[[Message], Message], request: Message) -> bool:
        """Send the result of a request, or its error. Return whether it was carried out."""
        self._activity.reset()
        try:
            self._wire.send(done=handle(request))
            return True
        except WireError:
            raise  # the laptop has disconnected, or violates the protocol
        except Refusal as refusal:
            self._send_error(refusal.kind, str(refusal), refusal.remedy, **refusal.details)
        except WheelError as error:
            self._send_error("wheel", str(error), "")
        except OSError as error:
            if isinstance(error, ConnectionError):
                raise
            if error.errno in _NO_SPACE:
                free = free_bytes(self._paths.home)
                self._send_error(
                    "space",
                    f"the robot's disk is full: {free:,} bytes are free",
                    "Remove what the project does not need, or old logs from the robot.",
                    free=free,
                )
            else:
                self._send_error("disk", *disk_problem(error, self._paths.layout.by_administrator))
        except Exception:
            import traceback

            self._send_error("bug", "the agent on the robot has failed", "", traceback=traceback.format_exc())
        return False

    def _send_error(self, kind: str, message: str, remedy: str, **details: Any) -> None:
        self._wire.send(error=kind, message=message, remedy=remedy, **details)

    def facts(self, request: Message) -> Message:
        """Return the robot's facts: versions, releases, the state of its program."""
        releases, python, layout = self._releases, look_up(request.get("modules") or ()), self._paths.layout
        program = self._host.processes()
        self._review(program)
        command = text_of(self._paths.home / layout.command)
        return {
            **python,
            "wpilib": python["packages"].get("wpilib"),
            "python": ".".join(map(str, sys.version_info[:3])),
            "virtual": self._host.is_virtual,
            "texts": {name: text_of(self._paths.of(file)) for name, file in layout.texts.items()},
            "can_restart": self._host.can_restart(),
            "free": free_bytes(self._paths.home) if self._paths.home.is_dir() else 0,
            "user": user(),
            "home": self._paths.home.is_dir(),
            "current": releases.current(),
            "releases": [self._summary(number) for number in releases.numbers()],
            "other_code": releases.is_other_tools() and any(True for _ in files_below(self._paths.code)),
            "deploy_json": text_of(self._paths.code / "deploy.json"),
            "command": None if command is None else command.strip(),
            "debug": self._paths.is_debug(),
            "running": bool(program),
            "environment": releases.environments.of_this_process(),
            "program_age": age_of(program),
            "remains": bool(layout.installing and list(self._paths.of(layout.installing).glob("[0-9]*.*"))),
        }

    def _read_log(self, request: Message) -> Message:
        self._wire.send_contents(self._logs.piece(request))
        return {}

    def _review(self, processes: set[int]) -> None:
        """Compare the program's processes with the one that a watch has seen run, and update the release's record."""
        current = self._releases.current()
        change = partial(now, boot=self._host.boot(), processes=processes, age=age_of(processes))
        if current is not None and change(record := self._releases.record(current)) != record:
            # Not while another computer deploys: its watch writes the record then. A full disk prevents nothing.
            with suppress(OSError, Refusal), Lock(self._paths, self._who, wait=0.0):
                self._releases.update_record(current, change)

    def _summary(self, number: int) -> Message:
        record = self._releases.record(number)
        known = {key: record.get(key) for key in ("main", "debug", "deploy", "from")}
        known.update({key: bool(record.get(key)) for key in ("taken", "ran", "ended")})
        return {"release": number, "files": len(record.get("files", ())), "damaged": not record, **known}

    @contextmanager
    def _transaction(self, keep: bool = False) -> Iterator[None]:
        """Hold the deploy lock.

        :param keep: also after the block, for the restart that follows, unless the block raises an exception
        """
        self._wire.limits_silence = True
        if not self._paths.home.is_dir():
            what = f"there is no {self._paths.home} here: this is not a {self._paths.layout.name}"
            raise Refusal("controller", what)
        held, self._lock = self._lock, None
        with held or ExitStack() as lock:
            if held is None:
                lock.enter_context(Lock(self._paths, self._who))
            yield
            if keep:
                self._lock = lock.pop_all()

    def _install(self, request: Message) -> Message:
        """Make an environment beside the current one. Nothing starts with it before a deploy selects it."""

        def receive(missing: list[Wheel], files: list[Path]) -> None:
            total = sum(each.size for each in missing)
            self._wire.send(need=[each.file for each in missing], bytes=total)
            self._activity.begin("receive", total)
            if missing:
                contents = ContentReader(self._wire, self._activity)
                for wheel, file in zip(missing, files):  # noqa: B905 - the agent runs on Python 3.9, too
                    contents.write(WantedFile(wheel.file, wheel.size, wheel.sha256, False), file)
                contents.end()

        with self._transaction():
            self._recover()
            self._releases.environments.install(request, receive)
        return {}

    def _deploy(self, request: Message) -> Message:
        with self._transaction(keep=True):
            self._recover()
            try:
                done = Deploy(self._releases, self._wire, request).run()
                return {**done, "fallback": self._releases.fallback(done["release"])}
            except BaseException:
                with suppress(ConnectionError):  # the next deploy removes the rest
                    self._releases.remove(self._paths.incoming, if_possible=True)
                raise

    def _recover(self) -> None:
        """Clean up after an interrupted deploy. On a full disk, old releases are removed first."""
        try:
            self._releases.recover()
        except OSError as error:
            if error.errno not in _NO_SPACE:
                raise
            self._releases.prune(kept=1)
            self._releases.recover()

    def _restart(self, prune: bool = False) -> Message:
        """Restart the program.

        :param prune: remove old releases, which a deploy has left until the new program is starting
        """
        with self._transaction(keep=True):
            self._activity.begin("stop")
            self._started = current = self._releases.current()
            name = None if current is None else self._releases.record(current).get("main")
            main = None if name is None else self._paths.code / name
            if current is not None:
                with suppress(OSError):  # the process that ends now was not seen to crash
                    self._releases.update_record(current, lambda record: {**record, "process": None})
            survived = self._activity.wait_for(self._program.restart, main)
            with suppress(OSError):  # the next deploy does the rest
                if current is not None:
                    self._releases.carry_late_writes(current)
                if prune:
                    self._releases.prune()
                self._releases.write_again()
        return {"survived": survived}

    def _watch(self, request: Message) -> Message:
        # Locked: a restart by another computer would look like the end of this program.
        with self._lock or ExitStack():
            self._lock = None
            seconds = float(request["seconds"])
            watched = self._program.watch(self._wire, seconds, float(request.get("unheard", seconds)))
            started, self._started = self._started, None
            if started is not None:
                verdict, process = watched["verdict"], self._program.process
                runs, boot, age = verdict in (RUNNING, UNHEARD), self._host.boot(), watched["age"]
                with suppress(OSError):  # a full disk must not change the verdict
                    self._releases.update_record(
                        started, lambda record: after_watch(record, runs, verdict == ENDED, process, age, boot)
                    )
            return watched

    def _roll_back(self, request: Message) -> Message:
        with self._transaction(keep=True):
            self._recover()
            self._refuse_unless_current(request.get("only_from"), request.get("release"))
            return self._roll_back_to(request.get("release"))

    def _refuse_unless_current(self, wanted: int | None, release: int | None) -> None:
        """Check that a release is still current. While the laptop asked its user, another one may have deployed.

        :param wanted: the release; None: any
        :param release: the one to go back to
        :raises Refusal: if another one is current
        """
        current = self._releases.current()
        if wanted is not None and current != wanted:
            now = "the program of another tool" if current is None else f"release {current}"
            raise Refusal(
                "replaced",
                f"not gone back, since another computer has changed the program meanwhile: the robot has {now}, "
                f"no longer release {wanted}",
                f"To see who deployed it: pyfrc deploy-info. To go back anyway: pyfrc deploy --rollback {release}",
            )

    def _roll_back_to(self, asked: int | None) -> Message:
        releases, numbers, current = self._releases, self._releases.numbers(), self._releases.current()
        number = asked
        if number is None:
            number = releases.fallback(current)
        if number is None or number not in numbers:
            what = "there is no earlier release" if asked is None else f"there is no release {asked}"
            there = f"Its releases: {', '.join(map(str, numbers))}; current: {current or 'none of them'}."
            if not numbers:
                there = "It has no releases yet: each pyfrc deploy adds one."
            raise Refusal("release", f"{what} on the robot to go back to", there)
        directory, record = releases.directory(number).resolve(), releases.record(number)
        if "commands" not in record:
            raise Refusal("release", f"the record of release {number} cannot be read", "Choose another.")
        if not any(record["commands"].values()):
            raise Refusal("release", f"release {number} was left by another tool, and had no start command")
        files = record.get("files", {})
        missing = sorted(path for path in files if not (directory / path).is_file())
        if missing:
            raise Refusal(
                "release", f"release {number} is no longer complete: {missing[0]} is missing", "Choose another."
            )
        if free_bytes(self._paths.home) < RESERVE:
            releases.prune(kept=1, needed=number)
        code, taken = releases.code(), None
        if releases.is_other_tools():
            taken = releases.next_number()
            releases.adopt_directory(taken)
        if code is not None and code != directory:
            carried = releases.carry_over(code, directory, None)
            record["carried"] = {"from": current if taken is None else taken, "files": carried.files}
            with suppress(OSError):  # on a full disk, late writes stay in the other release
                releases.write_record(number, record)
        self._activity.begin("check", len(files))
        changed = sorted(different_files(directory, files, self._activity, {}))
        releases.switch(number, record["commands"], taken)
        releases.set_debug(bool(record.get("debug")))
        return {"release": number, "previous": current, "changed": changed, "about": self._summary(number)}

    def _undeploy(self) -> Message:
        """Remove the start commands, so that a power cut cannot restart the program; then stop it, then remove it."""
        with self._transaction():
            if self._releases.is_other_tools():
                self._releases.require_movable_code()
            for name in self._paths.layout.command_files:
                remove(self._paths.home / name)
            self._releases.set_debug(False)
            sync(self._paths.home, self._activity)
            self._activity.begin("stop")
            self._activity.wait_for(partial(self._host.stop, start=False))
            there = self._paths.code.exists() or self._paths.code.is_symlink()
            self._releases.remove_all()
            # Last, and while it is held: computers that wait for it then create a new file.
            with suppress(OSError):  # Windows cannot remove an open file
                remove(self._paths.lock)
                self._paths.own.rmdir()
            sync(self._paths.home, self._activity)
        return {"removed": there}
