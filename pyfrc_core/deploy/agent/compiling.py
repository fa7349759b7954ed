"""The compiled forms of a program's files, made on the robot: it then starts in seconds less."""

from __future__ import annotations

import gc
import json
import os
import py_compile
import select
import signal
import sys
from collections.abc import Collection, Sequence
from contextlib import suppress
from importlib.util import cache_from_source
from pathlib import Path
from types import TracebackType
from typing import Any

from .activity import Activity
from .disk import files_below, link_or_copy
from .places import CODE, Refusal
from .system import end_with_parent

#: Bytes of memory for the process that compiles; a robot of 256 MB has a program that runs meanwhile.
_MEMORY = 38_000_000
#: What it may take in any case, of these.
_LEAST_MEMORY = 8_000_000
#: How often another process goes on where one was killed.
_MOST_RESTARTS = 4


class Compiler:
    """Compiles sources in a separate process: while others are received, and in memory that is not the agent's.

    A source that needs too much memory is left out: the program compiles it when it imports it. When the system kills
    the process, another one goes on; a source at which two were killed is left out as well. Where a process cannot be
    forked, on a virtual robot, the agent compiles by itself.

    :param directory: below which they are
    :param names:     in the order in which they are there
    :param debug:     whether their `assert` statements are kept
    :param program:   those that the program imports when it starts; others need not be valid
    """

    def __init__(self, directory: Path, names: Sequence[str], debug: bool, program: Collection[str] = ()) -> None:
        self._directory = directory
        self._debug = debug
        self._program = program
        #: The path, line and message of the program's first source that this Python cannot compile.
        self._failure: list[Any] = []
        self._there_now = 0
        self._child: int | None = None
        self._names: Sequence[str] = ()
        self._begin(names)

    def _begin(self, names: Sequence[str]) -> None:
        self._names = names
        if not names or not hasattr(os, "fork"):
            return
        # A byte for each source that is there, and one for each that is compiled. A pipe holds 65,536 of them, so that
        # neither process waits for the other's reading before there are twice as many sources.
        there, self._there = os.pipe()
        self._compiled, compiled = os.pipe()
        self._child = os.fork()
        if self._child == 0:
            try:
                os.close(self._there)
                end_with_parent()
                _limit_memory()
                for name in names:
                    if self._failure or not os.read(there, 1):
                        break  # the deploy is refused, or over
                    self._compile(name)
                    os.write(compiled, b".")
                os.write(compiled, b"\0" + json.dumps(self._failure).encode())
            finally:
                os._exit(0)
        os.close(there)
        os.close(compiled)

    def next_is_there(self) -> None:
        """Let it compile the next source."""
        if self._child is None:
            self._compile(self._names[self._there_now])
            self._there_now += 1
            return
        with suppress(BrokenPipeError):  # it has ended early: the program compiles the rest itself
            os.write(self._there, b".")

    def finish(self, activity: Activity) -> None:
        """Wait until it has compiled all sources; all of them are there.

        :raises Refusal: when this Python cannot compile one of the program's files
        """
        killed_at = ""
        for restarts_left in reversed(range(_MOST_RESTARTS + 1)):
            left = self._wait(activity)
            if left and left[0] == killed_at:
                left = left[1:]
            if not left or not restarts_left:
                break
            killed_at = left[0]
            self._begin(left)
            for _ in left:
                self.next_is_there()
        if self._failure:
            path, line, message = self._failure
            version = ".".join(map(str, sys.version_info[:2]))
            raise Refusal(
                "syntax",
                f"{path}:{line}: the robot's Python {version} cannot compile this: {message}",
                "The robot still has the program that it had. Correct the line, or write it as that Python needs it.",
            )

    def _wait(self, activity: Activity) -> Sequence[str]:
        """Return the sources that are left since it has ended early."""
        if self._child is None:
            return ()
        activity.begin("compile", len(self._names))
        end, failure, done = b"", b"", 0
        while True:
            # A robot takes a second for ten sources, and more for a large one.
            if not select.select([self._compiled], [], [], 1.0)[0]:
                activity.step(0)
                continue
            piece = os.read(self._compiled, 65536)
            if not piece:
                break
            if not end:
                compiled, end, piece = piece.partition(b"\0")
                activity.step(len(compiled))
                done += len(compiled)
            failure += piece
        self._end()
        if not end:
            return self._names[done:]
        self._failure = json.loads(failure)
        return ()

    def __enter__(self) -> Compiler:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._child is not None:
            os.kill(self._child, signal.SIGKILL)
            self._end()

    def _compile(self, name: str) -> None:
        file = str(self._directory / name)
        optimize = 0 if self._debug else 1
        try:
            py_compile.compile(file, _cache_of(file, self._debug), f"{CODE}/{name}", doraise=True, optimize=optimize)
        except py_compile.PyCompileError as failure:
            error = failure.exc_value
            if name in self._program and not self._failure and not isinstance(error, MemoryError):
                message = str(getattr(error, "msg", failure))[:200]
                self._failure = [name, getattr(error, "lineno", None) or 1, message]
        except Exception:
            pass  # such as a name that is too long with the cache's ending

    def _end(self) -> None:
        assert self._child is not None
        os.waitpid(self._child, 0)
        self._child = None
        os.close(self._there)
        os.close(self._compiled)


def _limit_memory() -> None:
    """Let a source that needs more than there is for this process raise a `MemoryError`."""
    if sys.platform != "linux":
        return
    import resource

    gc.freeze()  # the agent's objects stay shared with it
    lines = (line.split(":", 1) for line in Path("/proc/self/status").read_text().splitlines())
    sizes = {name: int(text.split()[0]) * 1024 for name, text in lines if name in ("VmData", "VmRSS")}
    most = sizes["VmData"] + max(_MEMORY - sizes["VmRSS"], _LEAST_MEMORY)
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))


def _cache_of(file: str, debug: bool) -> str:
    optimization: Any = "" if debug else 1
    return cache_from_source(file, optimization=optimization)


def compile_below(directory: Path, debug: bool, activity: Activity, program: Collection[str] = ()) -> None:
    """Compile what is not compiled yet; for `program` see `Compiler`."""
    compiled = CompiledForms()
    sources = [(name, entry.path) for name, entry in files_below(directory) if name.endswith(".py")]
    names = [name for name, path in sources if not compiled.includes(path, debug)]
    with Compiler(directory, names, debug, program) as compiler:
        for _ in names:
            compiler.next_is_there()
        compiler.finish(activity)


class CompiledForms:
    """The compiled forms of sources, in the directories ``__pycache__`` beside them. Each of these is listed once."""

    def __init__(self) -> None:
        self._listed: dict[str, dict[str, list[str]]] = {}
        self._made: set[str] = set()

    def of(self, source: str) -> list[str]:
        """The compiled forms of the file `source`."""
        directory, forms = self._forms(source)
        return [f"{directory}/__pycache__/{form}" for form in forms]

    def includes(self, source: str, debug: bool) -> bool:
        """Whether the form is there that the robot is going to start."""
        return Path(_cache_of(source, debug)).name in self._forms(source)[1]

    def link(self, source: str, target: str) -> None:
        """Let `target`, which is the same file as `source`, have its compiled forms, too."""
        directory, forms = self._forms(source)
        if not forms:
            return
        cache = os.path.split(target)[0] + "/__pycache__"
        if cache not in self._made:
            Path(cache).mkdir(exist_ok=True)
            self._made.add(cache)
        for form in forms:
            with suppress(OSError):  # the program compiles it when it imports it
                link_or_copy(f"{directory}/__pycache__/{form}", f"{cache}/{form}")

    def _forms(self, source: str) -> tuple[str, list[str]]:
        directory, name = os.path.split(source)
        if not name.endswith(".py"):
            return directory, []
        if directory not in self._listed:
            listed = self._listed[directory] = {}
            with suppress(OSError), os.scandir(f"{directory}/__pycache__") as entries:
                for form in sorted(entry.name for entry in entries):
                    listed.setdefault(form.rsplit(".cpython-", 1)[0], []).append(form)
        return directory, self._listed[directory].get(name[:-3], [])
