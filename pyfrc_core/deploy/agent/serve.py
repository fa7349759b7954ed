"""The agent's conversation: facts first, then one answer to each request, until the laptop hangs up."""

from __future__ import annotations

import errno
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

from .activity import Activity
from .content_index import sha256_of
from .deploying import Deploy, plan
from .disk import files_below, free_bytes, remove, text_of
from .imports import look_up
from .inventory import IMAGE_FILE, find_other_languages, image_in
from .places import COMMAND, DEBUG_COMMAND, Lock, Places, Refusal
from .program import KILL_SCRIPT, Program, age_of, processes, stop
from .releases import Releases
from .system import become, is_root, user
from .virtual import virtual_robot
from .watching import ENDED, RUNNING, UNHEARD
from .wire import EndedError, Said, Wire, WireError

_USER = "lvuser"


def main(source: BinaryIO) -> None:
    """Talk to the laptop, over `source` and standard output."""
    wire = Wire(source, os.fdopen(os.dup(1), "wb"))
    hello = wire.hear()
    virtual = virtual_robot()
    root = hello.get("root") if virtual is None else virtual.root
    if root is None and is_root():
        become(_USER)
    try:
        Agent(wire, Places(root or "/"), hello).serve()
    except (WireError, ConnectionError):
        sys.exit(1)  # the laptop is gone


class Agent:
    """What the laptop can ask for."""

    def __init__(self, wire: Wire, places: Places, hello: Said) -> None:
        self._wire = wire
        self._places = places
        self._activity = Activity(wire.say)
        self._releases = Releases(places, self._activity)
        self._program = Program(places)
        self._hello = hello
        self._who = str(hello.get("who") or "somebody")
        #: Held from a change of the program until it has been started again and watched.
        self._lock: ExitStack | None = None
        #: The release that was started and has not been watched yet.
        self._started: int | None = None
        #: The manifest that was last planned with: a deploy that brings none is of these files.
        self._files: list[Any] = []
        self._requests: dict[str, Callable[[Said], Said]] = {
            "plan": self._plan,
            "deploy": self._deploy,
            "restart": lambda request: self._restart(),
            "watch": self._watch,
            "rollback": self._roll_back,
            "info": self.facts,
            "undeploy": lambda request: self._undeploy(),
        }

    def serve(self) -> None:
        """Answer until the laptop hangs up."""
        self._answer(self.facts, self._hello)
        while True:
            # Where no lock is held, the laptop may have to ask its user something.
            self._wire.impatient = self._lock is not None
            try:
                request = self._wire.hear()
            except EndedError:
                return
            self._answer(lambda request: self._requests[request["op"]](request), request)

    def _answer(self, do: Callable[[Said], Said], request: Said) -> None:
        self._activity.reset()
        try:
            self._wire.say(done=do(request))
        except WireError:
            raise  # the laptop is gone, or does not speak as we do: there is nobody to tell
        except Refusal as refusal:
            self._say_error(refusal.kind, str(refusal), refusal.remedy, **refusal.details)
        except OSError as error:
            if isinstance(error, ConnectionError):
                raise
            if error.errno in (errno.ENOSPC, errno.EDQUOT):
                free = free_bytes(self._places.home)
                self._say_error(
                    "space",
                    f"the robot's disk is full: {free:,} bytes are free",
                    "Remove what the project does not need, or old logs from the robot.",
                    free=free,
                )
            else:
                self._say_error(
                    "disk", f"{error.filename or 'the robot'}: {error.strerror}", "Look at its owner and mode."
                )
        except Exception:
            self._say_error("bug", "the agent on the robot has failed", "", traceback=traceback.format_exc())

    def _say_error(self, kind: str, message: str, remedy: str, **details: Any) -> None:
        self._wire.say(error=kind, message=message, remedy=remedy, **details)

    def facts(self, request: Said) -> Said:
        """What there is on the robot."""
        ini = text_of(self._places.of("/etc/natinst/share/ni-rt.ini"))
        releases, python = self._releases, look_up(request.get("modules") or ())
        program = processes()
        return {
            **python,
            "wpilib": python["packages"].get("wpilib"),
            "python": ".".join(map(str, sys.version_info[:3])),
            "image": image_in(text_of(self._places.of(IMAGE_FILE)) or ""),
            "startup_dlls": any(line.startswith("StartupDLLs") for line in (ini or "").splitlines()),
            "kill_script": virtual_robot() is not None or self._places.of(KILL_SCRIPT).exists(),
            "free": free_bytes(self._places.home) if self._places.home.is_dir() else 0,
            "user": user(),
            "home": self._places.home.is_dir(),
            "current": releases.current(),
            "releases": [self._about(number) for number in releases.numbers()],
            "other_code": releases.is_other_tools() and any(True for _ in files_below(self._places.code)),
            "deploy_json": text_of(self._places.code / "deploy.json"),
            "command": text_of(self._places.home / COMMAND),
            "debug": self._places.debug_flag.exists(),
            "running": bool(program),
            "program_age": age_of(program),
            "other_languages": find_other_languages(self._places),
        }

    def _about(self, number: int) -> Said:
        record = self._releases.record(number)
        known = {key: record.get(key) for key in ("main", "debug", "deploy", "from")}
        known.update({key: bool(record.get(key)) for key in ("taken", "ran", "ended")})
        return {"release": number, "files": len(record.get("files", ())), **known}

    @contextmanager
    def _transaction(self, keep: bool = False) -> Iterator[None]:
        """The lock is held meanwhile.

        :param keep: and when all went well, after it, for the restart that follows
        """
        self._wire.impatient = True
        if not self._places.home.is_dir():
            raise Refusal("roborio", f"there is no {self._places.home} here: this is no roboRIO")
        held, self._lock = self._lock, None
        with held or ExitStack() as lock:
            if held is None:
                lock.enter_context(Lock(self._places, self._who))
            yield
            if keep:
                self._lock = lock.pop_all()

    def _plan(self, request: Said) -> Said:
        self._files = request["files"]
        return plan(self._releases, self._files)

    def _deploy(self, request: Said) -> Said:
        request.setdefault("files", self._files)
        with self._transaction(keep=not request.get("in_place")):
            self._releases.recover()
            try:
                done = Deploy(self._releases, self._wire, request).run()
                return {**done, "fallback": self._releases.fallback(done["release"])}
            except BaseException:
                with suppress(ConnectionError):  # what is left the next deploy clears up
                    self._releases.remove(self._places.incoming, if_possible=True)
                raise

    def _restart(self) -> Said:
        with self._transaction(keep=True):
            self._activity.begin("stop")
            self._started = current = self._releases.current()
            name = None if current is None else self._releases.record(current).get("main")
            main = None if name is None else self._places.code / name
            survived = self._activity.wait_for(lambda: self._program.restart(main))
            if current is not None:
                self._releases.settle(current)
        return {"survived": survived}

    def _watch(self, request: Said) -> Said:
        # Locked: somebody else's restart in the middle of it would be taken for this program's end.
        with self._lock or ExitStack():
            self._lock = None
            seconds = float(request["seconds"])
            watched = self._program.watch(self._wire, seconds, float(request.get("unheard", seconds)))
            started, self._started = self._started, None
            if started is not None:
                ran = watched["verdict"] in (RUNNING, UNHEARD) or self._releases.ran(started)
                with suppress(OSError):  # a full disk does not change the verdict
                    self._releases.record_start(started, ran, watched["verdict"] == ENDED)
            return watched

    def _roll_back(self, request: Said) -> Said:
        with self._transaction(keep=True):
            self._releases.recover()
            return self._roll_back_to(request.get("release"))

    def _roll_back_to(self, asked: int | None) -> Said:
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
        if not any(record["commands"].values()):
            raise Refusal("release", f"release {number} was left by another tool, and had no start command")
        files = record.get("files", {})
        lacking = sorted(path for path in files if not (directory / path).is_file())
        if lacking:
            raise Refusal(
                "release", f"release {number} is not whole any more: {lacking[0]} is missing", "Choose another."
            )
        code, taken = releases.code(), None
        if releases.is_other_tools():
            taken = releases.next_number()
            releases.take_over(taken)
        if code is not None and code != directory:
            carried = releases.carry(code, directory, None)
            record["carried"] = {"from": current if taken is None else taken, "files": carried}
            releases.write_record(number, record)
        changed = self._changed(files, directory)
        releases.switch(number, record["commands"], taken)
        releases.set_debug(bool(record.get("debug")))
        return {"release": number, "previous": current, "changed": changed, "about": self._about(number)}

    def _changed(self, files: dict[str, str], directory: Path) -> list[str]:
        self._activity.begin("check", len(files))
        changed = []
        for path, sha256 in files.items():
            if sha256_of(f"{directory}/{path}", self._activity) != sha256:
                changed.append(path)
            self._activity.step()
        return sorted(changed)

    def _undeploy(self) -> Said:
        """First nothing starts the program any more, then it is stopped, then it is removed."""
        with self._transaction():
            for name in (COMMAND, DEBUG_COMMAND):
                remove(self._places.home / name)
            self._releases.set_debug(False)
            self._releases.flush(self._places.home)
            self._activity.begin("stop")
            self._activity.wait_for(partial(stop, self._places, start=False))
            there = self._places.code.exists() or self._places.code.is_symlink()
            self._releases.remove(self._places.code)
            for each in self._places.own.iterdir():
                if each != self._places.lock:
                    self._releases.remove(each)
            # Last, and while it is held: whoever waits for it begins with a new one.
            with suppress(OSError):  # Windows removes no file that is open
                remove(self._places.lock)
                self._places.own.rmdir()
            self._releases.flush(self._places.home)
        return {"removed": there}
