"""Forks agents that have everything imported already: a hundred of them a second. Run by `local`."""

from __future__ import annotations

import contextlib
import functools
import gc
import hashlib
import json
import os
import pathlib
import socket
import sys
import tempfile
import traceback
import zlib
from collections.abc import Callable
from typing import Any

from pyfrc_core.deploy.agent import (
    compiling,
    host,
    program,
    robot_paths,
    serve,
    start_monitor,
    wire,
)
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.targets.roborio import ROBORIO

#: In seconds.
_LONGER_THAN_A_TEST = 3600.0


class Calls:
    """Counts the calls that an agent makes, of functions in Python and in C.

    Other processes and threads, and the wall clock, do not change the count: a busy machine gives the same.
    """

    def __init__(self) -> None:
        self.count = 0
        wait = compiling.Compiler._wait

        def wait_for_all(compiler: compiling.Compiler, activity: Activity) -> None:
            self._uncounted(wait_for_end)(compiler)  # all that was compiled is read at once then
            wait(compiler, activity)

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
    """Run an agent, and write the number of its calls at its end."""
    os.dup2(connection, 0)
    os.dup2(connection, 1)
    os.close(connection)
    if options["all_signs"]:
        serve.Activity = functools.partial(serve.Activity, pause=0.0)  # type: ignore[misc,assignment]
    if options["runs"] is not None:
        seen = {
            "verdict": start_monitor.RUNNING if options["runs"] else start_monitor.ENDED,
            "heard": True,
            "seen": True,
        }

        def watch(self: program.Program, *_: object) -> dict[str, Any]:
            return {**seen, "seconds": 1.0, "age": 1.0, "lived": 1.0}

        program.Program.watch = watch  # type: ignore[method-assign]
    counted = Calls() if options["calls"] else None
    try:
        serve.main(open(0, "rb", 0))  # noqa: SIM115
    except SystemExit:
        pass
    except BaseException:
        traceback.print_exc()
    finally:
        sys.setprofile(None)
        os.write(alive, b"%d" % (counted.count if counted is not None else 0))
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
