"""Commands that start warm: forked from a process that has imported what each would otherwise import anew.

A large part of what a short command costs is imports. A process beside pytest imports all once, and runs no robot: it
forks, and the fork becomes the command that a new interpreter would have become. ``PYFRC_COLD_STARTS=1`` does without.
"""

from __future__ import annotations

import atexit
import contextlib
import gc
import importlib
import inspect
import json
import os
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
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple, NoReturn

#: Whether commands can start warm here: where Linux tells of the end of a process by a descriptor.
POSSIBLE = hasattr(os, "pidfd_open") and "PYFRC_COLD_STARTS" not in os.environ

#: What a new interpreter reads, and a fork does not.
READ_AT_START = ("PYTHON", "LC_", "LANG", "LD_", "COVERAGE_")

#: Of these, what a fork can be given after its start.
READ_LATER = {"PYTHONPATH", "PYTHON_CPU_COUNT"}

#: What most commands import, sooner or later; but nothing that takes a name that measuring has to replace before
#: (what `pyfrc_core.measure.user_functions` does).
_IMPORTED = (
    "wpilib.drive",
    "wpilib.simulation",
    "hal.simulation",
    "ntcore",
    "click",
    "numpy.random",
    "pyfrc_core.physics.registry",  # pint, without what pint alone would import
    "encodings.idna",
    "pydantic",
    "pydantic.dataclasses",
    "pydantic.type_adapter",
    "coverage",
    "paramiko",
    "pytest",
    "_pytest.assertion.rewrite",
    "_pytest.terminal",
    "_pytest.junitxml",
    "_pytest.logging",
    "execnet.multi",
    "pdb",
    "unittest",
    "email.parser",
    "ntcore._logutil",
    "pyfrc_cli.main",
    "pyfrc_core.measure.coverage",
    "pyfrc_core.tests",
    "pyfrc_core.test_support.run_tests",
    "pyfrc_core.fuzz.campaign.campaign",
    "pyfrc_core.config.sim_file",
    "pyfrc_core.physics.engine",
    "pyfrc_core.physics.create",
    "pyfrc.physics.motor_cfgs",
    "pyfrc.physics.tankmodel",
    "pyfrc_core.deploy.session",
    "pyfrc_core.doctor.examine",
    "pyfrc_core.sim.simulate",
    "pyfrc_core.sim.ui.headless",
)

#: Modules of the user's that a new interpreter would import before anything else.
_IMPORTED_AT_START = {"sitecustomize", "usercustomize"}

#: Whatever robot code's is made to do.
_exit_now = os._exit

#: A message is one packet: more bytes than any has.
LARGEST = 1 << 17


class WarmStarts:
    """Starts commands, one after the other, from a process that has imported everything.

    :param environment: that of commands with which nothing is special
    :ivar address: where `warm_processes.ask_for_command` has others forked, which go on beside them
    """

    def __init__(self, environment: Mapping[str, str]) -> None:
        self._environment = environment
        self._server, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            process = subprocess.Popen(
                [sys.executable, __file__, str(theirs.fileno())],
                env={**environment, "PYTHONHASHSEED": "0"},
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,  # as the commands will have one
            )
        atexit.register(process.communicate)
        atexit.register(self._server.close)  # comes first, and ends the process
        message = self._server.recv(LARGEST)
        if not message:
            raise RuntimeError("what commands import cannot be imported: its traceback is on standard error")
        modules, self.address = json.loads(message)
        self._modules = frozenset(modules)

    def fit(self, directory: Path, environment: Mapping[str, str]) -> bool:
        """Whether in this directory a fork does the same as a new interpreter."""
        if any(
            name.startswith(READ_AT_START) and self._environment.get(name) != environment[name]
            for name in environment.keys() - READ_LATER
        ):
            return False
        # The user's modules come before others of their names; here, the others are imported already.
        first = self._modules | _IMPORTED_AT_START
        places = (directory, *search_path(environment))
        return not any(
            path.stem in first and (path.parent in places or not (path.parent / "__init__.py").exists())
            for place in places
            for path in _modules_below(place)  # modules of packages have longer names
        )

    def run(
        self,
        program: str,
        arguments: list[str],
        directory: Path,
        environment: Mapping[str, str],
        stdin: str | None,
        address: str | None = None,
    ) -> tuple[int, str, str]:
        """Run ``python -m program arguments``, and wait for its end.

        :param stdin: what fits into a pipe; None is no input at all
        :param address: of `warm_processes.WarmProcesses`; without it, what the command starts are new interpreters
        :return: the exit code (a signal's number, negative), and what was printed, on standard output and of errors
        """
        (out, their_out), (err, their_err) = os.pipe(), os.pipe()
        if stdin is None:
            their_in = os.open(os.devnull, os.O_RDONLY)
        else:
            their_in, told = os.pipe()
            with os.fdopen(told, "w", encoding="utf-8") as file:
                file.write(stdin)
        word, their_word = socket.socketpair()
        job = json.dumps([program, arguments, str(directory), dict(environment), address]).encode()
        streams = (their_in, their_out, their_err)
        with their_word:
            socket.send_fds(self._server, [job], [their_word.fileno(), *streams])
        for descriptor in streams:
            os.close(descriptor)
        with (
            os.fdopen(out, encoding="utf-8", errors="replace") as stdout,
            os.fdopen(err, encoding="utf-8", errors="replace") as stderr,
            ThreadPoolExecutor(1) as beside,
            word,  # closed first: when this is interrupted, the command ends, and with it the reading
        ):
            errors = beside.submit(stderr.read)
            printed = stdout.read()
            return int(word.recv(LARGEST)), printed, errors.result()


def _modules_below(place: Path) -> Iterator[Path]:
    """Yield what may be a module or a package; nothing is imported from hidden directories, as pytest's cache."""
    for directory, directories, files in os.walk(place):
        directories[:] = [name for name in directories if not name.startswith(".")]
        for name in (*directories, *files):
            path = Path(directory, name)
            if path.suffix in ("", ".py"):
                yield path


def search_path(environment: Mapping[str, str]) -> list[Path]:
    """Return the directories of ``PYTHONPATH``."""
    return [Path(place) for place in environment.get("PYTHONPATH", "").split(os.pathsep) if place]


class _Job(NamedTuple):
    """A command to become: what `WarmStarts.run` was given, and descriptors of its three streams."""

    given: tuple[str, list[str], str, dict[str, str], str | None]
    streams: list[int]


def _serve(server: socket.socket) -> _Job | None:
    """Fork for each job.

    :return: in a fork, its job; otherwise None, when there are no more
    """
    while True:
        message, descriptors, _, _ = socket.recv_fds(server, LARGEST, 4)
        if not message:
            return None
        with socket.socket(fileno=descriptors[0]) as word:
            process = os.fork()
            if process == 0:
                return _Job(json.loads(message), descriptors[1:])
            for descriptor in descriptors[1:]:
                os.close(descriptor)
            end = os.pidfd_open(process)
            if end not in select.select([end, word.fileno()], [], [])[0]:
                os.kill(process, signal.SIGKILL)  # nobody waits for it any longer
            os.close(end)
            status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
            with contextlib.suppress(BrokenPipeError):
                word.send(str(status).encode())


def _fork_processes_of_tests(server: socket.socket, interrupted: object) -> tuple[str, int]:
    """Fork a process that forks those of isolated tests.

    :return: where it is asked for them, and a descriptor: it ends when that one is closed, in all forks
    """
    import warm_processes

    address = f"\0pyfrc-tests-{secrets.token_hex(16)}"
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as listener:
        listener.bind(address)
        listener.listen(128)
        ended, alive = os.pipe()
        if os.fork() == 0:
            server.close()
            os.close(alive)
            os.dup2(ended, 0)
            os.close(ended)
            warm_processes.serve(listener, interrupted)
            _exit_now(0)
        os.close(ended)
        return address, alive


def _become(job: _Job, of_tests: str) -> None:
    """Be the process of a job.

    :param of_tests: where processes of isolated tests, and commands of this command, are forked
    """
    for target, descriptor in enumerate(job.streams):
        os.dup2(descriptor, target)
        os.close(descriptor)
    program, arguments, directory, environment, address = job.given
    if address is not None:
        import warm_processes

        warm_processes.start_warm(lambda: address, of_tests)
    run_program(program, arguments, directory, environment)


def run_program(program: str, arguments: list[str], directory: str, environment: Mapping[str, str]) -> NoReturn:
    """Do what ``python -m program arguments`` does in this directory and this environment, and end this process."""
    os.chdir(directory)
    os.environ.clear()
    os.environ.update(environment)
    if os.isatty(1):  # as Python begins there
        sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    sys.orig_argv[1:] = ["-m", program, *arguments]
    sys.argv[1:] = arguments
    sys.path[:0] = [directory, *map(str, search_path(environment))]
    tempfile.tempdir = None  # this environment may name another one
    sys.modules["__main__"] = types.ModuleType("__main__")
    code = 0
    try:
        runpy._run_module_as_main(program)  # type: ignore[attr-defined]
    except SystemExit as end:
        if not isinstance(end.code, int):
            raise
        code = end.code
    end_like_python(code)


def end_like_python(code: int) -> NoReturn:
    """End this process as Python does, but for taking apart all that was imported, which would take 30 ms."""
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    _exit_now(code & 0xFF)


def _fix_the_seed() -> None:
    """Where `pyfrc` would start Python again: it has the seed already."""
    os.environ["PYTHONHASHSEED"] = "0"


def main() -> None:
    """The process that forks."""
    server = socket.socket(fileno=int(sys.argv[1]))
    import warm_processes  # noqa: F401 - not to be found without the path's first entry
    from large_pages import use_large_pages
    from warm_pytest import prepare_pytest

    del sys.path[0]
    interrupted = signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in _IMPORTED:
        importlib.import_module(name)
    prepare_pytest()
    from pyfrc_cli import main as commands
    from pyfrc_cli import start
    from pyfrc_core.config import settings
    from pyfrc_core.deploy.agent_stream import agent_package
    from pyfrc_core.project.loaded_modules import loaded_modules

    for module, _ in commands.COMMANDS.values():
        importlib.import_module(module)
    settings._validator()
    agent_package()  # is kept: packing the agent costs a deploy more than all else that it does on this side
    assert callable(start._restart_with_fixed_seed)  # under another name, each command would start cold
    start._restart_with_fixed_seed = _fix_the_seed
    inspect.stack()  # resolves the files of all modules, which measuring coverage begins with
    loaded_modules.look()
    modules = list(sys.modules)
    gc.collect()
    gc.freeze()
    use_large_pages()
    of_tests, alive = _fork_processes_of_tests(server, interrupted)
    server.send(json.dumps([modules, of_tests]).encode())
    with server:
        job = _serve(server)
    os.close(alive)
    if job is not None:
        signal.signal(signal.SIGINT, interrupted)
        _become(job, of_tests)


if __name__ == "__main__":
    main()
