"""Python programs that start fast: forked from a process that has imported what most of them import.

Half of what a short command costs is imports. A process beside pytest does them once, and runs no robot. For each
program it forks, and the fork becomes what a new interpreter would have become. Where it would not become the same, a
new interpreter is started. ``PYFRC_COLD_STARTS=1`` does without all this.
"""

from __future__ import annotations

import atexit
import functools
import gc
import importlib
import io
import json
import os
import pkgutil
import re
import runpy
import secrets
import select
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import types
import weakref
from collections.abc import Iterable, Mapping, Sequence
from contextlib import redirect_stdout, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import IO, Any, NamedTuple

import other_systems
import pytest

import pyfrc_cli
import pyfrc_core
from pyfrc_cli import start
from pyfrc_core.config.settings import load_settings
from pyfrc_core.deploy.agent_stream import agent_package
from pyfrc_core.processes import spawn
from pyfrc_core.project.loaded_modules import loaded_modules
from pyfrc_core.season import CURRENT

#: Whether programs can be forked here: where Linux reports the end of a process by a descriptor.
POSSIBLE = hasattr(os, "pidfd_open") and "PYFRC_COLD_STARTS" not in os.environ

#: What a new interpreter reads at its start, and a fork does not.
_READ_AT_START = ("PYTHON", "LC_", "LANG", "LD_", "COVERAGE_", "PYFRC_COVERAGE", "PYFRC_PROFILE")

#: Of these, what a fork can be given after its start.
_READ_LATER = {"PYTHONPATH", "PYTHON_CPU_COUNT", "PYTHONDONTWRITEBYTECODE", "PYTHONIOENCODING", "PYTHONUNBUFFERED"}

#: What our modules import later, or not all of it.
_IMPORTED = ("coverage.xmlreport", "numpy.random", "ntcore._logutil", "paramiko", "wpilib.drive", "wpilib.simulation")

#: Whatever robot code's is made to do.
_exit_now = os._exit

#: A request is one packet, which is smaller.
_LARGEST = 1 << 17


class _Request(NamedTuple):
    """A program to become.

    :param arguments: ``-m`` or ``-c``, and what follows
    :param path: where its modules may be found, besides its directory and ``PYTHONPATH``
    :param ignores_hangup: as a new process inherits it
    """

    arguments: list[str]
    directory: str
    environment: dict[str, str]
    path: list[str]
    own_session: bool
    ignores_hangup: bool


# -- the process that asks ---------------------------------------------------------------------------------------------


class Forked:
    """A forked program, with methods of `subprocess.Popen`.

    :param end: receives its exit code
    """

    def __init__(self, pid: int, end: socket.socket, stdin: IO[bytes] | None, stdout: IO[bytes] | None) -> None:
        self.pid = pid
        self.stdin = stdin
        self.stdout = stdout
        self._end = end
        # Not at exit: a thread may still wait for the end of the program.
        weakref.finalize(self, end.close).atexit = False

    def poll(self) -> int | None:
        try:
            return self.wait(0)
        except subprocess.TimeoutExpired:
            return None

    def wait(self, timeout: float | None = None) -> int:
        if not select.select([self._end], [], [], timeout)[0]:
            raise subprocess.TimeoutExpired("a forked program", timeout or 0)
        return int(self._end.recv(_LARGEST, socket.MSG_PEEK))  # stays for the next one to ask

    def terminate(self) -> None:
        self._send(signal.SIGTERM)

    def kill(self) -> None:
        self._send(signal.SIGKILL)

    def _send(self, number: int) -> None:
        if self.poll() is None:
            with suppress(ProcessLookupError):
                os.kill(self.pid, number)


def start_server(environment: Mapping[str, str]) -> str:
    """Start the process that forks, which ends with this one, and return its address.

    :param environment: that of programs with which nothing is special
    """
    address = f"\0pyfrc-tests-{secrets.token_hex(16)}"
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        listener.bind(address)
        listener.listen(128)
        process = subprocess.Popen(
            [sys.executable, __file__, str(listener.fileno())],
            pass_fds=[listener.fileno()],
            stdin=subprocess.PIPE,  # closed when this process ends, and the other ends then
            cwd="/",  # no project
            env={**environment, "PYTHONHASHSEED": "0"},
        )
    atexit.register(process.communicate)
    return address


def popen(address: str, command: Sequence[str], **options: Any) -> Forked | subprocess.Popen[bytes]:
    """Do what `subprocess.Popen` does with Python and its arguments, and these options."""
    streams, ours, theirs = [], [None, None, None], []
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        stream = options.get(name)
        if stream == subprocess.PIPE:
            ends = os.pipe()
            theirs.append(ends[number != 0])
            ours[number] = os.fdopen(ends[number == 0], "rb" if number else "wb")
            streams.append(theirs[-1])
        elif stream == subprocess.DEVNULL:
            theirs.append(os.open(os.devnull, os.O_RDWR))
            streams.append(theirs[-1])
        elif stream == subprocess.STDOUT:
            streams.append(streams[1])
        else:
            streams.append(number if stream is None else stream if isinstance(stream, int) else stream.fileno())
    request = _Request(
        [str(word) for word in command[1:]],
        str(options.get("cwd") or Path.cwd()),
        dict(os.environ if options.get("env") is None else options["env"]),
        sys.path,
        options.get("start_new_session", False),
        signal.getsignal(signal.SIGHUP) is signal.SIG_IGN,
    )
    end = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    end.connect(address)
    socket.send_fds(end, [json.dumps(request).encode()], streams)
    answer = end.recv(_LARGEST)
    for descriptor in theirs:
        os.close(descriptor)
    if not answer:
        raise RuntimeError("the process that forks programs has ended: its traceback is on standard error")
    if answer != b"cold":
        return Forked(int(answer), end, ours[0], ours[1])
    for each in (end, *filter(None, ours)):
        each.close()
    return subprocess.Popen(command, **options)


# -- the process that forks --------------------------------------------------------------------------------------------


def _serve(listener: socket.socket) -> _Request | None:
    """Fork for each request, and report the end of each fork.

    :return: in a fork, its request; otherwise None, when standard input was closed
    """
    server, started_with = os.getpid(), dict(os.environ)
    modules = {name.partition(".")[0] for name in sys.modules} - {"__main__"} | {"sitecustomize", "usercustomize"}
    own = {*sys.path, str(Path(__file__).parent), str(Path(__file__).parents[1])}
    forks: dict[int, tuple[int, socket.socket]] = {}
    while True:
        ready = set(select.select([0, listener, *forks], [], [])[0])
        if 0 in ready:
            return None
        for end in forks.keys() & ready:
            pid, asking = forks.pop(end)
            os.close(end)
            code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
            with asking, suppress(OSError):
                asking.send(str(code).encode())
        if listener in ready:
            asking, _ = listener.accept()
            message, streams, _, _ = socket.recv_fds(asking, _LARGEST, 3)
            if not message:  # it has ended since it connected
                asking.close()
                continue
            request = _Request(*json.loads(message))
            places = {request.directory, *request.path, *_search_path(request.environment)} - own
            if not _the_same(request.environment, started_with) or _hides(places, modules):
                with asking, suppress(OSError):
                    asking.send(b"cold")
            elif pid := os.fork():
                forks[os.pidfd_open(pid)] = pid, asking
            else:
                if request.own_session:
                    os.setsid()
                with suppress(OSError):  # now that who knows this number can end the session, too
                    asking.send(str(os.getpid()).encode())
                for end, (_, other) in forks.items():
                    os.close(end)
                    other.close()
                listener.close()
                asking.close()
                for target, descriptor in enumerate(streams):
                    os.dup2(descriptor, target)
            for descriptor in streams:
                os.close(descriptor)
            if os.getpid() != server:
                return request


def _the_same(environment: Mapping[str, str], started_with: Mapping[str, str]) -> bool:
    """Whether an interpreter with this environment starts as with that one."""
    names = (environment.keys() | started_with.keys()) - _READ_LATER
    if "PYTHONHASHSEED" not in environment:  # any seed might be the new interpreter's
        names.discard("PYTHONHASHSEED")
    return all(environment.get(name) == started_with.get(name) for name in names if name.startswith(_READ_AT_START))


def _hides(places: Iterable[str], modules: set[str]) -> bool:
    """Whether one of these directories has a module with a name that is imported already; there, it would come first.

    pytest imports from directories below them, too; but modules of packages have longer names.
    """
    for place in places:
        for directory, directories, files in os.walk(place):
            directories[:] = [name for name in directories if not name.startswith(".")]
            sources = (name.removesuffix(".py") for name in files if name.endswith(".py"))
            is_package = "__init__.py" in files and directory != place
            if not is_package and not modules.isdisjoint((*directories, *sources)):
                return True
    return False


def _search_path(environment: Mapping[str, str]) -> list[str]:
    return [place for place in environment.get("PYTHONPATH", "").split(os.pathsep) if place]


def _become(request: _Request) -> None:
    """Do what ``python arguments`` does, and end this process."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGHUP, signal.SIG_IGN if request.ignores_hangup else signal.SIG_DFL)
    os.chdir(request.directory)
    os.environ.clear()
    os.environ.update(request.environment)
    tempfile.tempdir = None  # this environment may name another one
    sys.dont_write_bytecode = bool(os.environ.get("PYTHONDONTWRITEBYTECODE"))
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        stream = _standard_stream(number, getattr(sys, name).errors)
        setattr(sys, name, stream)
        setattr(sys, f"__{name}__", stream)
    other_systems.prepare_streams()
    option, program, *words = request.arguments
    sys.orig_argv[1:] = request.arguments
    sys.argv[:] = [option, *words]
    sys.path[:0] = [request.directory if option == "-m" else "", *_search_path(request.environment)]
    main = sys.modules["__main__"] = types.ModuleType("__main__")
    code = 0
    try:
        if option == "-m":
            runpy.run_module(program, run_name="__main__", alter_sys=True)
        else:
            exec(program, vars(main))
    except SystemExit as end:
        if not isinstance(end.code, int):
            raise
        code = end.code
    # As Python ends, but for taking apart all that was imported, which takes 30 ms.
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    _exit_now(code & 0xFF)


def _standard_stream(number: int, errors: str) -> io.TextIOWrapper:
    """Open a standard stream as Python does at its start."""
    unbuffered = bool(os.environ.get("PYTHONUNBUFFERED"))
    encoding, _, chosen = os.environ.get("PYTHONIOENCODING", f"utf-8:{errors}").partition(":")
    raw = io.FileIO(number, "w" if number else "r", closefd=False)
    buffer: Any = io.BufferedReader(raw) if number == 0 else raw if unbuffered else io.BufferedWriter(raw)
    return io.TextIOWrapper(
        buffer,
        encoding,
        "backslashreplace" if number == 2 else chosen or "strict",
        newline="\n" if number else None,
        line_buffering=not unbuffered and (number == 2 or raw.isatty()),
        write_through=unbuffered,
    )


#: The modules that need a package that may be missing.
_NEEDS = {"tkinter": r"\.ui\.tk\b", "libcst": r"\.migrate\."}
_LACKING = re.compile("|".join(["(?!)", *(each for need, each in _NEEDS.items() if find_spec(need) is None)]))
#: The packages that are written for another season's WPILib; those in `season` import none.
_OTHER_SEASON = re.compile(rf"(?<!core\.season)\.season_(?!{CURRENT.year}\b)")


def main() -> None:
    """Be the process that forks."""
    listener = socket.socket(fileno=int(sys.argv[1]))
    del sys.path[0]
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gc.disable()  # what is imported stays
    with redirect_stdout(io.StringIO()):
        pytest.main(["-VV"])  # imports its plugins, in its own way
    for package in (pyfrc_cli, pyfrc_core):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            # Not what imports Dask, nor what imports another season's WPILib; nor what lacks a package.
            if not ("cluster" in module.name or _OTHER_SEASON.search(module.name) or _LACKING.search(module.name)):
                importlib.import_module(module.name)
    for name in _IMPORTED:
        with suppress(ImportError):  # of another season, or an optional package
            importlib.import_module(name)
    # The seed is fixed already: Python need not be started again.
    start._restart_with_fixed_seed = lambda: os.environ.update(PYTHONHASHSEED="0")  # type: ignore[assignment]
    spawn.popen = functools.partial(popen, listener.getsockname().decode())
    loaded_modules.look()  # a fork then goes only through what it has imported itself
    agent_package()  # packed once
    load_settings(Path(__file__).parent / "robots/competition/magic_swerve/pyproject.toml")  # builds their validator
    gc.collect()
    gc.freeze()
    gc.enable()
    if (request := _serve(listener)) is not None:
        _become(request)


if __name__ == "__main__":
    main()
