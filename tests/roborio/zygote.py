"""Forks agents that have everything imported already: a hundred of them a second. Run by `local`.

Each can end itself, by SIGKILL, before its n-th step on the disk; and to lose then what was not on the disk yet, as
in a power cut: every file written since the last flush is empty.
"""

from __future__ import annotations

import contextlib
import functools
import gc
import hashlib
import json
import os
import pathlib
import signal
import socket
import sys
import tempfile
import traceback
import zlib
from collections.abc import Callable, Sequence
from typing import Any

from pyfrc_core.deploy.agent import (
    compiling,
    disk,
    host,
    program,
    robot_paths,
    serve,
    start_monitor,
    system,
    wire,
)
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.targets.roborio import ROBORIO

_CHANGES = {
    "os.rename",
    "os.link",
    "os.symlink",
    "os.mkdir",
    "os.remove",
    "os.rmdir",
    "os.chmod",
    "os.truncate",
    "os.fork",
}
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT
#: In seconds.
_LONGER_THAN_A_TEST = 3600.0


class Steps:
    """Counts an agent's steps on the disk, and ends it before one of them."""

    def __init__(self, last: int | None, loses: bool, root: str) -> None:
        self.count = 0
        self._last = last
        self._loses = loses
        self._root = pathlib.Path(root)
        self._me = os.getpid()
        self._unsaved: dict[int, int] = {}
        self._saved_caches: set[int] = set()
        self._open, self._fsync, self._flush = pathlib.Path.open, os.fsync, system.flush
        if loses:
            # A function, which is bound to the path as the original is; our own method would not be.
            pathlib.Path.open = lambda path, *args, **options: self._opening(path, *args, **options)  # type: ignore[method-assign,assignment]
            os.fsync = self._fsyncing
            for module in (system, disk):
                module.flush = self._flushing  # type: ignore[attr-defined]
        sys.addaudithook(self._hook)

    def _hook(self, event: str, args: Any) -> None:
        # "ctypes.dlsym": right before the disk is flushed, and names are exchanged.
        is_step = event in _CHANGES or event == "ctypes.dlsym" or (event == "open" and (args[2] or 0) & _WRITING)
        if is_step and os.getpid() == self._me:
            self.count += 1
            if self.count == self._last:
                self._end()

    def _end(self) -> None:
        if self._loses:
            for descriptor in self._unsaved.values():
                os.ftruncate(descriptor, 0)
            for cache in self._root.rglob("*.pyc"):
                if cache.stat().st_ino not in self._saved_caches:
                    os.truncate(cache, 0)
        os.kill(self._me, signal.SIGKILL)

    def _opening(self, path: pathlib.Path, mode: str = "r", *args: Any, **options: Any) -> Any:
        stream = self._open(path, mode, *args, **options)
        if mode[0] in "wax":
            self._unsaved[os.fstat(stream.fileno()).st_ino] = os.dup(stream.fileno())
        return stream

    def _fsyncing(self, descriptor: Any) -> None:
        self._fsync(descriptor)
        number = descriptor if isinstance(descriptor, int) else descriptor.fileno()
        self._unsaved.pop(os.fstat(number).st_ino, None)

    def _flushing(self, directory: pathlib.Path) -> None:
        self._flush(directory)
        self._unsaved.clear()
        self._saved_caches = {cache.stat().st_ino for cache in self._root.rglob("*.pyc")}


class Calls:
    """Counts the calls that an agent makes, of functions in Python and in C.

    Other processes and threads, and the wall clock, do not change the count: a busy machine gives the same.
    """

    def __init__(self) -> None:
        self.count = 0
        wait = compiling.Compiler._wait

        def wait_for_all(compiler: compiling.Compiler, activity: Activity) -> Sequence[str]:
            self._uncounted(wait_for_end)(compiler)  # all that was compiled is read at once then
            return wait(compiler, activity)

        compiling.Compiler._wait = wait_for_all  # type: ignore[method-assign]
        wire.Wire._read = self._uncounted(wire.Wire._read)  # type: ignore[method-assign]  # as many reads as come
        Activity.wait_for = self._uncounted(Activity.wait_for)  # type: ignore[method-assign]
        serve.Activity = functools.partial(serve.Activity, pause=_LONGER_THAN_A_TEST)  # type: ignore[misc,assignment]
        sys.setprofile(self._count)

    def _uncounted(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return the function without the calls that it makes."""

        def call(*args: Any) -> Any:
            sys.setprofile(None)
            try:
                return function(*args)
            finally:
                sys.setprofile(self._count)

        return call

    def _count(self, frame: object, event: str, argument: object) -> None:
        self.count += event in ("call", "c_call")


def wait_for_end(compiler: compiling.Compiler) -> None:
    """Wait until the compiling process has ended, and leave its exit to be collected."""
    if compiler._child is not None:
        os.waitid(os.P_PID, compiler._child, os.WEXITED | os.WNOWAIT)


def agent(connection: int, alive: int, options: dict[str, Any]) -> None:
    """Run an agent, and write the number of its steps or calls at its end."""
    os.dup2(connection, 0)
    os.dup2(connection, 1)
    os.close(connection)
    steps = Steps(options.get("last_step"), options.get("loses", False), options["root"])
    if options["all_signs"]:
        serve.Activity = functools.partial(serve.Activity, pause=0.0)  # type: ignore[misc,assignment]
    if options["runs"] is not None:
        seen = {
            "verdict": start_monitor.RUNNING if options["runs"] else start_monitor.ENDED,
            "heard": True,
            "seen": True,
        }

        def watch(self: program.Program, *_: object) -> dict[str, Any]:
            has_run = self._monitor is not None and self._monitor.has_run
            return {**seen, "seconds": 1.0, "age": 1.0, "lived": 1.0, "has_run": has_run}

        program.Program.watch = watch  # type: ignore[method-assign]
    counted: Steps | Calls = Calls() if options["calls"] else steps
    try:
        serve.main(open(0, "rb", 0))  # noqa: SIM115
    except SystemExit:
        pass
    except BaseException:
        traceback.print_exc()
    finally:
        sys.setprofile(None)
        os.write(alive, b"%d" % counted.count)
        os._exit(0)


def rehearse() -> None:
    """Deploy a program to a directory of our own, so that no fork compiles regular expressions and the like again."""
    code = b"pass\n"
    files = [["robot.py", len(code), hashlib.sha256(code).hexdigest(), False]]
    frames = [
        wire.message_frame({"modules": ["json"]}),
        wire.message_frame({"op": "deploy", "files": files, "main": "robot.py"}),
        wire.frame(wire.CONTENT, zlib.compress(code)),
    ]
    with tempfile.TemporaryDirectory() as root, pathlib.Path(os.devnull).open("wb") as unread:
        paths = robot_paths.RobotPaths(ROBORIO.layout, root)
        paths.home.mkdir(parents=True)
        source, target = os.pipe()
        os.write(target, b"".join(frames))
        os.close(target)
        with open(source, "rb", 0) as requests:  # noqa: PTH123 - a descriptor
            connection = wire.Wire(requests, unread)
            serve.Agent(connection, host.RealRobot(paths), connection.receive()).serve()
        assert paths.code.is_dir()


def main() -> None:
    """Fork an agent for each message, with its sockets."""
    control = socket.socket(fileno=int(sys.argv[1]))
    host.RealRobot.processes = lambda robot: set()  # type: ignore[method-assign]  # listing all processes takes long
    rehearse()
    gc.collect()
    gc.freeze()  # keeps this process's memory pages shared with its forks
    while True:
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        message, descriptors, _, _ = socket.recv_fds(control, 65536, 2)
        if not message:
            return
        if os.fork() == 0:
            control.close()
            agent(*descriptors, json.loads(message))
        for each in descriptors:
            os.close(each)


main()
