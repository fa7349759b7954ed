"""Starts of new interpreters, which import everything again: for processes that cannot or must not be forked."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Protocol

from ..collector import collector_paused
from .frames import encode, read_frame
from .owner import end_with

#: Where no module of the user's is in Python's way, and where this package is found.
DIRECTORY = Path(__file__).resolve().parents[2]

#: What an interpreter is started with, after its own name.
ARGUMENTS = ("-c", f"from {__name__} import main; main()")


#: The environment of a Python whose output is read as UTF-8: no letter of it is an error. On Windows, Python writes
#: files and pipes in the encoding of the country, which has few letters.
WRITES_UTF_8 = {"PYTHONIOENCODING": "utf-8:backslashreplace"}

#: Starts an interpreter. Always called as an attribute of this module, so that tests can replace it by a faster one.
popen: Callable[..., Any] = subprocess.Popen


#: Called in each new interpreter before what it is started for; can be pickled.
first_calls: list[Callable[[], object]] = []


class StartedProcess(Protocol):
    """A process that was started; with methods of `subprocess.Popen`."""

    @property
    def pid(self) -> int: ...

    def poll(self) -> int | None: ...

    def wait(self, timeout: float | None = None) -> int: ...

    def terminate(self) -> None: ...

    def kill(self) -> None: ...


@dataclass(frozen=True)
class Start:
    """How to start a new interpreter.

    :param call: what it does: a function that can be pickled
    :param stdout, stderr: files or descriptors, as for `subprocess.Popen`; None: those of this process
    :param environment: variables that differ from this process's; what is printed is in UTF-8, unless `stdout` is None
    :param own_session: whether it leads a session of its own, on POSIX
    :param ends_with_owner: whether it is killed when this process ends; only for threads that wait for it
    """

    call: Callable[[], object]
    stdout: int | IO[bytes] | None = subprocess.DEVNULL
    stderr: int | IO[bytes] | None = subprocess.DEVNULL
    environment: Mapping[str, str] | None = None
    own_session: bool = False
    ends_with_owner: bool = True

    def job(self) -> bytes:
        """Return what the interpreter reads from its standard input."""
        owner = os.getpid() if self.ends_with_owner else None
        return encode(_Request(sys.path, str(Path.cwd()), owner, pickle.dumps((first_calls, self.call))))


@dataclass(frozen=True)
class _Request:
    """What a new interpreter is to do.

    :param path: `sys.path`
    :param directory: the current one
    :param owner: the process that it is to end with
    :param call: what it does, after `first_calls`; pickled by themselves, since unpickling them needs `path`
    """

    path: list[str]
    directory: str
    owner: int | None
    call: bytes


def start(how: Start) -> StartedProcess:
    """Start a new interpreter."""
    process = open_interpreter(how)
    assert process.stdin is not None
    with suppress(OSError):  # it has ended already
        process.stdin.close()
    return process


def run_python(arguments: Sequence[str], stdout: IO[Any], environment: Mapping[str, str] | None = None) -> int:
    """Run a new interpreter with these arguments until it ends, and return its exit code.

    :param stdout: a stream with a file descriptor; what goes elsewhere is this process's
    :param environment: variables that differ from this process's
    """
    variables = {**os.environ, **(environment or {})}
    process: StartedProcess = popen([sys.executable, *arguments], stdout=stdout, env=variables)
    try:
        return process.wait()
    except BaseException:
        process.kill()
        raise


def open_interpreter(how: Start) -> subprocess.Popen[bytes]:
    """Start a new interpreter whose standard input stays open: what follows the job is for what it calls."""
    process: subprocess.Popen[bytes] = popen(
        [sys.executable, *ARGUMENTS],
        stdin=subprocess.PIPE,
        stdout=how.stdout,
        stderr=how.stderr,
        cwd=DIRECTORY,
        env={**os.environ, **_output_encoding(how), **(how.environment or {})},
        start_new_session=how.own_session and os.name == "posix",
    )
    assert process.stdin is not None
    with suppress(OSError):  # it has ended already
        process.stdin.write(how.job())
        process.stdin.flush()
    return process


def _output_encoding(how: Start) -> Mapping[str, str]:
    encoding = getattr(sys.stdout, "encoding", None)
    if how.stdout is not None or encoding is None:
        return WRITES_UTF_8
    return {"PYTHONIOENCODING": f"{encoding}:backslashreplace"}  # beside what this process prints


def main() -> None:
    """Run the job on standard input: what a new interpreter does."""
    with open(0, "rb", buffering=0, closefd=False) as stdin:  # what follows the job is not read here
        job: _Request = read_frame(stdin)
    if job.owner is not None:
        end_with(job.owner)
    sys.path[:] = job.path
    os.chdir(job.directory)
    with collector_paused():
        calls: tuple[list[Callable[[], object]], Callable[[], object]] = pickle.loads(job.call)
    first, call = calls
    for each in first:
        each()
    call()
