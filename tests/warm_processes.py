"""Processes of commands and simulations that start warm: forked from one that has imported what they import.

These are the hosts of simulated robots, and what `pyfrc_core.processes.call` starts. One process forks them, for pytest
and for the commands that `warm_start` starts. A fork becomes what a new interpreter would have become; where it would
not become the same, a new interpreter is started.
"""

from __future__ import annotations

import atexit
import functools
import gc
import importlib
import json
import os
import secrets
import select
import signal
import socket
import subprocess
import sys
import types
import weakref
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, NamedTuple

from large_pages import use_large_pages
from started_commands import How
from warm_start import LARGEST, READ_AT_START, READ_LATER, end_like_python, run_program, search_path

from pyfrc_core.processes import spawn
from pyfrc_core.sim.engine import host_process
from pyfrc_core.sim.engine.host import Hosting

#: Measuring begins before most imports.
_MEASURING = ("PYFRC_COVERAGE", "PYFRC_PROFILE")

#: May differ: what a fork can be given after its start, and what is read no more when the path is set.
_NOT_COMPARED = READ_LATER | {"PYTHONDONTWRITEBYTECODE", "PYTHONIOENCODING", "PYTHONUNBUFFERED"}

#: Modules that a new interpreter does not have.
_OF_THE_SUITE = ("started_commands", "warm_start", "warm_processes", "warm_pytest", "large_pages")

StartInterpreter = Callable[[spawn.Start], spawn.Interpreter]
RunPython = Callable[[Sequence[str], IO[Any]], int]


class WarmProcesses:
    """A process that forks others, until this one ends.

    :param environment: that of processes with which nothing is special
    :param program: forks them: it calls `main`
    :ivar address: where it is asked for them, by this process and others
    """

    def __init__(self, environment: Mapping[str, str], program: str = __file__) -> None:
        self.address = f"\0pyfrc-tests-{secrets.token_hex(16)}"
        with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
            listener.bind(self.address)
            listener.listen(128)
            process = subprocess.Popen(
                [sys.executable, program, str(listener.fileno())],
                pass_fds=[listener.fileno()],
                stdin=subprocess.PIPE,  # closed when this process ends, and the other ends then
                stdout=subprocess.PIPE,  # as a host has one
                cwd=spawn.DIRECTORY,
                env={**environment, **host_process.ENVIRONMENT},
            )
        atexit.register(process.communicate)


def start_warm(address: Callable[[], str], of_tests: str | None = None) -> None:
    """Have this process's simulations ask for their hosts, and `run_in_subprocess` for its processes.

    :param address:  returns where, when the first is asked for
    :param of_tests: where to ask for commands, and for the processes of isolated tests; without it, they are new
        interpreters
    """
    spawn.start = functools.partial(_start, address, of_tests, spawn.start)
    if of_tests is not None:
        spawn.run_python = functools.partial(_run_python, address, of_tests, spawn.run_python)


def _start(
    address: Callable[[], str], of_tests: str | None, cold: StartInterpreter, how: spawn.Start
) -> spawn.Interpreter:
    hosting = how.call.args[0] if isinstance(how.call, functools.partial) else None
    kind = "host" if isinstance(hosting, Hosting) else "test" if how.environment is None else "call"
    # A robot's own process has imported nothing before.
    if (isinstance(hosting, Hosting) and not hosting.fork) or (kind == "test" and of_tests is None):
        return cold(how)
    environment = {**os.environ, **(how.environment or {})}
    with Path(os.devnull).open("wb") as unread:
        streams = how.stdout, how.stdout if kind == "host" else how.stderr
        output, errors = (_descriptor(stream, own, unread) for own, stream in enumerate(streams, 1))
        where = of_tests if kind == "test" and of_tests is not None else address()
        their_end, our_end = os.pipe()
        with os.fdopen(our_end, "wb") as file:
            try:
                warm = ask(where, [kind, sys.path, environment, []], [their_end, output, errors])
            finally:
                os.close(their_end)
            if warm is not None:
                with suppress(OSError):  # it has ended already
                    file.write(how.job())
                    file.flush()
    return warm or cold(how)


def _run_python(
    address: Callable[[], str], of_tests: str, cold: RunPython, arguments: Sequence[str], stdout: IO[Any]
) -> int:
    option, program, *words = arguments
    assert option == "-m", arguments
    how = How(Path.cwd(), os.environ, [0, stdout.fileno(), 2])
    warm = ask_for_command(of_tests, address(), program, words, how)
    return cold(arguments, stdout) if warm is None else warm.wait()


def _descriptor(stream: int | IO[bytes] | None, own: int, unread: IO[bytes]) -> int:
    """Return the descriptor that `subprocess.Popen` would use for a stream; `own` is that of this process."""
    if stream is None:
        return own
    if isinstance(stream, int) and stream != subprocess.DEVNULL:
        return stream
    return (unread if isinstance(stream, int) else stream).fileno()


def ask_for_command(address: str, hosts: str, program: str, arguments: Sequence[str], how: How) -> WarmProcess | None:
    """Have ``python -m program arguments`` forked; return None where a new interpreter has to be started.

    :param hosts: where the command asks for hosts
    """
    path = [*sys.path, str(how.directory), *map(str, search_path(how.environment))]
    ignores_hangup = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN  # as a new process inherits it
    command = [program, list(arguments), str(how.directory), how.own_session, ignores_hangup, hosts, address]
    return ask(address, ["command", path, dict(how.environment), command], how.streams)


def ask(address: str, request: list[object], streams: Sequence[int]) -> WarmProcess | None:
    """Have a process forked; return None where a fork would not do.

    :param request: all but the last two of a `_Request`
    """
    server = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    server.connect(address)
    socket.send_fds(server, [json.dumps(request).encode()], streams)
    if not (pid := server.recv(LARGEST)):
        raise RuntimeError("the process that forks others has ended: its traceback is on standard error")
    if pid == b"cold":
        server.close()
        return None
    return WarmProcess(int(pid), server)


class WarmProcess:
    """A forked process, with the methods of `subprocess.Popen`."""

    def __init__(self, pid: int, end: socket.socket) -> None:
        self.pid = pid
        self._end = end
        # Not at exit: a thread may still wait for the end of the process.
        weakref.finalize(self, end.close).atexit = False

    def poll(self) -> int | None:
        try:
            return self.wait(0)
        except subprocess.TimeoutExpired:
            return None

    def wait(self, timeout: float | None = None) -> int:
        if not select.select([self._end], [], [], timeout)[0]:
            raise subprocess.TimeoutExpired("warm", timeout or 0)
        return int(self._end.recv(LARGEST, socket.MSG_PEEK))  # stays for the next one to ask

    def terminate(self) -> None:
        self._send(signal.SIGTERM)

    def kill(self) -> None:
        self._send(signal.SIGKILL)

    def _send(self, number: int) -> None:
        if self.poll() is None:
            with suppress(ProcessLookupError):
                os.kill(self.pid, number)


class _Request(NamedTuple):
    """A process to become.

    :param kind: "host", "call", "test" or "command"
    :param path: `sys.path`; of a command, where its modules will be found, besides others
    :param command: a program, its arguments and directory, whether it leads a session and ignores SIGHUP, and the two
        addresses for `start_warm`
    :param asking: where to send its number
    """

    kind: str
    path: list[str]
    environment: dict[str, str]
    command: list[Any]
    streams: list[int]
    asking: socket.socket


def _serve(listener: socket.socket) -> _Request | None:
    """Fork for each request, and report each fork's end.

    :return: in a fork, its request; otherwise None, when standard input was closed
    """
    started_with = dict(os.environ)
    modules = {name.partition(".")[0] for name in sys.modules} - {"__main__", *_OF_THE_SUITE}
    known = {*sys.path, str(Path.cwd())}
    processes: dict[int, tuple[int, socket.socket]] = {}
    while True:
        ready = select.select([0, listener, *processes], [], [])[0]
        if 0 in ready:
            return None
        for end in set(ready) & processes.keys():
            process, asking = processes.pop(end)
            os.close(end)
            status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
            with asking, suppress(OSError):
                asking.send(str(status).encode())
        if listener in ready:
            asking = listener.accept()[0]
            message, streams, _, _ = socket.recv_fds(asking, LARGEST, 3)
            if not message:  # it has ended since it connected
                asking.close()
                continue
            request = _Request(*json.loads(message), streams, asking)
            if not _the_same(request.environment, started_with) or _hides(set(request.path) - known, modules):
                with asking, suppress(OSError):
                    asking.send(b"cold")
            else:
                process = os.fork()
                if process == 0:
                    for other in (listener, *(each for _, each in processes.values())):
                        other.detach()
                    return request
                processes[os.pidfd_open(process)] = process, asking
            for stream in streams:
                os.close(stream)


def _the_same(environment: Mapping[str, str], started_with: Mapping[str, str]) -> bool:
    """Whether an interpreter with this environment starts as with that one."""
    if any(name.startswith(_MEASURING) for name in environment):
        return False
    names = (environment.keys() | started_with.keys()) - _NOT_COMPARED
    if "PYTHONHASHSEED" not in environment:  # any seed might be the new interpreter's
        names.discard("PYTHONHASHSEED")
    return all(environment.get(name) == started_with.get(name) for name in names if name.startswith(READ_AT_START))


def _hides(directories: Iterable[str], modules: set[str]) -> bool:
    """Whether a directory has a module with a name that is imported already; there, it would come first."""
    for directory in directories:
        with suppress(OSError):
            if not modules.isdisjoint(entry.name.partition(".")[0] for entry in Path(directory).iterdir()):
                return True
    return False


def _become(request: _Request) -> None:
    """Be what Python is after `spawn.start`."""
    if request.kind == "host":
        os.setsid()
    for target, descriptor in enumerate(request.streams):
        os.dup2(descriptor, target)
    if request.kind == "command":
        program, arguments, directory, own_session, ignores_hangup, address, of_tests = request.command
        if own_session:
            os.setsid()
        signal.signal(signal.SIGHUP, signal.SIG_IGN if ignores_hangup else signal.SIG_DFL)
        start_warm(lambda: address, of_tests)
        _tell_number(request)
        run_program(program, arguments, directory, request.environment)
    os.environ.clear()
    os.environ.update(request.environment)
    sys.dont_write_bytecode = bool(os.environ.get("PYTHONDONTWRITEBYTECODE"))
    sys.orig_argv[1:] = spawn.ARGUMENTS
    sys.argv[:] = spawn.ARGUMENTS[:1]
    if request.kind == "call":
        sys.stdin, sys.stdout, sys.stderr = (  # those of files may not be those of pipes
            open(descriptor, mode, encoding="utf-8", errors="backslashreplace", closefd=False)  # noqa: SIM115
            for descriptor, mode in enumerate("rww")
        )
        sys.__stdin__, sys.__stdout__, sys.__stderr__ = sys.stdin, sys.stdout, sys.stderr  # type: ignore[misc]
    sys.modules["__main__"] = types.ModuleType("__main__")
    for name in _OF_THE_SUITE:
        sys.modules.pop(name, None)
    _tell_number(request)
    spawn.main()
    end_like_python(0)


def _tell_number(request: _Request) -> None:
    request.asking.send(str(os.getpid()).encode())
    request.asking.detach()
    os.closerange(3, os.sysconf("SC_OPEN_MAX"))


def serve(listener: socket.socket, interrupted: object) -> None:
    """Fork for each request until standard input is closed; in a fork, be what was requested.

    :param interrupted: the handler of SIGINT there
    """
    if (request := _serve(listener)) is not None:
        signal.signal(signal.SIGINT, interrupted)  # type: ignore[arg-type]
        _become(request)


def main(*imported: str) -> None:
    """The process that forks.

    :param imported: modules, besides those of a host
    """
    listener = socket.socket(fileno=int(sys.argv[1]))
    sys.path[0] = ""
    interrupted = signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in ("pyfrc_core.sim.engine.robot_side.robot_process", *imported):
        importlib.import_module(name)
    gc.collect()
    gc.freeze()
    use_large_pages()
    serve(listener, interrupted)


if __name__ == "__main__":
    main()
