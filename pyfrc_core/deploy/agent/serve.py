"""The agent's conversation: facts first, then one answer to each request, until the laptop hangs up."""

from __future__ import annotations

import errno
import os
import pwd
import re
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

from .deploying import Deploy, plan
from .disk import files_below, flush, free_bytes, remove, remove_if_possible, sha256_of, text_of
from .places import COMMAND, DEBUG_COMMAND, Lock, Places, Refusal
from .program import KILL_SCRIPT, Program, processes, stop
from .releases import Releases
from .wire import EndedError, Said, Wire, WireError

_USER = "lvuser"


def main(source: BinaryIO) -> None:
    """Talk to the laptop, over `source` and standard output."""
    wire = Wire(source, os.fdopen(os.dup(1), "wb"))
    hello = wire.hear()
    if "root" not in hello and os.geteuid() == 0:
        _become(_USER)
    try:
        Agent(wire, Places(hello.get("root", "/")), str(hello.get("who") or "somebody")).serve()
    except (WireError, ConnectionError):
        sys.exit(1)  # the laptop is gone


def _become(user: str) -> None:
    """What is written belongs to the user whose program it is."""
    entry = pwd.getpwnam(user)
    os.initgroups(user, entry.pw_gid)
    os.setgid(entry.pw_gid)
    os.setuid(entry.pw_uid)


class Agent:
    """What the laptop can ask for."""

    def __init__(self, wire: Wire, places: Places, who: str) -> None:
        self._wire = wire
        self._places = places
        self._releases = Releases(places)
        self._program = Program(places)
        self._who = who
        #: Held from a change of the program until it has been started again and watched.
        self._lock: ExitStack | None = None
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
        self._answer(self.facts, {})
        while True:
            # Where no lock is held, the laptop may have to ask its user something.
            self._wire.impatient = self._lock is not None
            try:
                request = self._wire.hear()
            except EndedError:
                return
            self._answer(lambda request: self._requests[request["op"]](request), request)

    def _answer(self, do: Callable[[Said], Said], request: Said) -> None:
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
        image = re.search(
            r'IMAGEVERSION\s*=\s*"?([^"\n]*)',
            text_of(self._places.of("/etc/natinst/share/scs_imagemetadata.ini")) or "",
        )
        ini = text_of(self._places.of("/etc/natinst/share/ni-rt.ini"))
        releases = self._releases
        return {
            "python": ".".join(map(str, sys.version_info[:3])),
            "wpilib": _version_of("wpilib"),
            "image": image[1] if image else None,
            "startup_dlls": any(line.startswith("StartupDLLs") for line in (ini or "").splitlines()),
            "kill_script": self._places.of(KILL_SCRIPT).exists(),
            "free": free_bytes(self._places.home) if self._places.home.is_dir() else 0,
            "user": pwd.getpwuid(os.geteuid()).pw_name,
            "home": self._places.home.is_dir(),
            "current": releases.current(),
            "releases": [self._about(number) for number in releases.numbers()],
            "other_code": releases.is_other_tools() and any(True for _ in files_below(self._places.code)),
            "deploy_json": text_of(self._places.code / "deploy.json"),
            "command": text_of(self._places.home / COMMAND),
            "debug": self._places.debug_flag.exists(),
            "running": bool(processes()),
        }

    def _about(self, number: int) -> Said:
        record = self._releases.record(number)
        known = {key: record.get(key) for key in ("main", "debug", "deploy", "from")}
        return {"release": number, "taken": bool(record.get("taken")), "files": len(record.get("files", ())), **known}

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
                return Deploy(self._releases, self._wire, request).run()
            except BaseException:
                remove_if_possible(self._places.incoming)  # what is left the next deploy clears up
                raise

    def _restart(self) -> Said:
        with self._transaction(keep=True):
            self._program.restart()
            current = self._releases.current()
            if current is not None:
                self._releases.settle(current)
        return {}

    def _watch(self, request: Said) -> Said:
        # Locked: somebody else's restart in the middle of it would be taken for this program's end.
        with self._lock or ExitStack():
            self._lock = None
            return self._program.watch(self._wire, float(request["seconds"]))

    def _roll_back(self, request: Said) -> Said:
        with self._transaction(keep=True):
            self._releases.recover()
            return self._roll_back_to(request.get("release"))

    def _roll_back_to(self, asked: int | None) -> Said:
        releases, numbers, current = self._releases, self._releases.numbers(), self._releases.current()
        number = asked
        if number is None:
            earlier = [each for each in numbers if current is None or each < current]
            before = releases.record(current).get("from") if current is not None else None
            number = before if before in numbers else max(earlier, default=None)
        if number is None or number not in numbers:
            there = ", ".join(map(str, numbers)) or "none"
            what = "there is no earlier release" if asked is None else f"there is no release {asked}"
            raise Refusal(
                "release", f"{what} on the robot to go back to", f"Its releases: {there}; current: {current}."
            )
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
        changed = _changed(files, directory)
        releases.switch(number, record["commands"], taken)
        releases.set_debug(bool(record.get("debug")))
        return {"release": number, "previous": current, "changed": changed, "about": self._about(number)}

    def _undeploy(self) -> Said:
        """First nothing starts the program any more, then it is stopped, then it is removed."""
        with self._transaction():
            for name in (COMMAND, DEBUG_COMMAND):
                remove(self._places.home / name)
            self._releases.set_debug(False)
            flush(self._places.home)
            stop(self._places, start=False)
            there = self._places.code.exists() or self._places.code.is_symlink()
            remove(self._places.code)
            for each in self._places.own.iterdir():
                if each != self._places.lock:
                    remove(each)
            # Last, and while it is held: whoever waits for it begins with a new one.
            remove(self._places.lock)
            with suppress(OSError):
                self._places.own.rmdir()
            flush(self._places.home)
        return {"removed": there}


def _changed(files: dict[str, str], directory: Path) -> list[str]:
    return sorted(path for path, sha256 in files.items() if sha256_of(directory / path) != sha256)


def _version_of(package: str) -> str | None:
    """The version of an installed package, by the name of its directory: importing it would take a second."""
    for place in sys.path:
        for each in Path(place).glob(f"{package}-*.dist-info"):
            return each.name[len(package) + 1 : -len(".dist-info")]
    return None
