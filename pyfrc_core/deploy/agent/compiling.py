"""Compiling a program's source files on the robot, which saves seconds at its start."""

from __future__ import annotations

import gc
import json
import os
import py_compile
import select
import sys
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from importlib.util import cache_from_source
from pathlib import Path
from types import TracebackType
from typing import Any

from .activity import Activity
from .disk import files_below, link_or_copy, sha256_of
from .robot_paths import Refusal
from .system import KILL, end_with_parent

#: Memory for the compiling process, in bytes. A robot with 256 MB runs its program meanwhile.
_MEMORY = 38_000_000
#: Memory that it may always allocate, in bytes.
_LEAST_MEMORY = 8_000_000


class Compiler:
    """Compiles sources in a separate process, with memory of its own, while other files are received.

    A source that needs too much memory is skipped: the program compiles it when it imports it. So are the sources that
    are left if the system kills the process. On systems without ``fork``, which only virtual robots have, the agent
    itself compiles.

    :param directory: contains the sources
    :param names:     relative paths, in the order in which the files become available
    :param debug:     keep `assert` statements
    :param program:   files that the program imports at its start; other files may be invalid
    :param code:      the directory from which the program will run, for its tracebacks; default: `directory`
    """

    def __init__(
        self,
        directory: Path,
        names: Sequence[str],
        debug: bool,
        program: Collection[str] = (),
        code: str | None = None,
    ) -> None:
        self._directory = directory
        self._debug = debug
        self._code = code or str(directory)
        self._program = program
        #: Path, line and message of the program's first source that this Python cannot compile.
        self._failure: list[Any] = []
        self._available = 0
        self._child: int | None = None
        self._names = names
        if not names or not hasattr(os, "fork"):
            return
        # One pipe has a byte for each available source, the other a byte for each compiled one. A pipe holds 65,536
        # bytes, so neither process blocks with up to that many sources.
        available, self._to_child = os.pipe()
        self._compiled, compiled = os.pipe()
        self._child = os.fork()
        if self._child == 0:
            try:
                os.close(self._to_child)
                end_with_parent()
                _limit_memory()
                for name in names:
                    if self._failure or not os.read(available, 1):
                        break  # the deploy was refused or has ended
                    self._compile(name)
                    os.write(compiled, b".")
                os.write(compiled, b"\0" + json.dumps(self._failure).encode())
            finally:
                os._exit(0)
        os.close(available)
        os.close(compiled)

    def add_next(self) -> None:
        """Report that the next source is available."""
        if self._child is None:
            self._compile(self._names[self._available])
            self._available += 1
            return
        with suppress(BrokenPipeError):  # the process was killed
            os.write(self._to_child, b".")

    def finish(self, activity: Activity) -> None:
        """Wait until all sources are compiled. All of them must be available.

        :raises Refusal: if this Python cannot compile one of the program's files
        """
        self._wait(activity)
        if self._failure:
            path, line, message = self._failure
            version = ".".join(map(str, sys.version_info[:2]))
            raise Refusal(
                "syntax",
                f"{path}:{line}: the robot's Python {version} cannot compile this: {message}",
                "The robot still has its old program. Correct the line, or use syntax of that Python version.",
            )

    def _wait(self, activity: Activity) -> None:
        """Wait for the process."""
        if self._child is None:
            return
        activity.begin("compile", len(self._names))
        end, failure = b"", b""
        while True:
            # A robot compiles about ten sources in a second; a large one takes longer.
            if not select.select([self._compiled], [], [], 1.0)[0]:
                activity.step(0)
                continue
            piece = os.read(self._compiled, 65536)
            if not piece:
                break
            if not end:
                compiled, end, piece = piece.partition(b"\0")
                activity.step(len(compiled))
            failure += piece
        self._end()
        if end:
            self._failure = json.loads(failure)

    def __enter__(self) -> Compiler:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._child is not None:
            os.kill(self._child, KILL)
            self._end()

    def _compile(self, name: str) -> None:
        file = str(self._directory / name)
        optimize = 0 if self._debug else 1
        try:
            target = _cache_of(file, self._debug)
            py_compile.compile(file, target, f"{self._code}/{name}", doraise=True, optimize=optimize)
        except py_compile.PyCompileError as failure:
            error = failure.exc_value
            if name in self._program and not self._failure and not isinstance(error, MemoryError):
                message = str(getattr(error, "msg", failure))[:200]
                self._failure = [name, getattr(error, "lineno", None) or 1, message]
        except Exception:
            pass  # for example, the name of the compiled file is too long

    def _end(self) -> None:
        assert self._child is not None
        os.waitpid(self._child, 0)
        self._child = None
        os.close(self._to_child)
        os.close(self._compiled)


def _limit_memory() -> None:
    """Limit the memory of this process: compiling a source that needs more raises `MemoryError`."""
    if sys.platform != "linux":
        return
    import resource

    gc.freeze()  # keeps the agent's memory pages shared
    lines = (line.split(":", 1) for line in Path("/proc/self/status").read_text(encoding="utf-8").splitlines())
    sizes = {name: int(text.split()[0]) * 1024 for name, text in lines if name in ("VmData", "VmRSS")}
    most = sizes["VmData"] + max(_MEMORY - sizes["VmRSS"], _LEAST_MEMORY)
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))


def _cache_of(file: str, debug: bool) -> str:
    optimization: Any = "" if debug else 1
    return cache_from_source(file, optimization=optimization)


def compile_below(
    directory: Path, debug: bool, activity: Activity, code: str | None = None, program: Collection[str] = ()
) -> None:
    """Compile the sources below a directory that have no compiled file yet.

    :param code: see `Compiler`
    :param program: see `Compiler`
    """
    compiled = CompiledForms()
    sources = [(name, entry.path) for name, entry in files_below(directory) if name.endswith(".py")]
    names = [name for name, path in sources if not compiled.includes(path, debug)]
    with Compiler(directory, names, debug, program, code) as compiler:
        for _ in names:
            compiler.add_next()
        compiler.finish(activity)


def compiled_hashes(
    directory: Path, paths: Iterable[str], activity: Activity, known: Mapping[str, str] | None = None
) -> dict[str, str]:
    """Return the SHA-256 of the compiled files of sources, by their paths.

    :param paths: of files below the directory; those that are no sources have none
    :param known: hashes that are not calculated again
    """
    forms, cut = CompiledForms(), len(f"{directory}/")
    files = [form for path in paths for form in forms.of(f"{directory}/{path}")]
    return {each[cut:]: (known or {}).get(each[cut:]) or sha256_of(each, activity) for each in files}


class CompiledForms:
    """Compiled files in ``__pycache__`` directories. Each directory is listed once."""

    def __init__(self) -> None:
        self._listed: dict[str, dict[str, list[str]]] = {}
        self._made: set[str] = set()

    def of(self, source: str) -> list[str]:
        """Return the compiled files of a source."""
        directory, forms = self._forms(source)
        return [f"{directory}/__pycache__/{form}" for form in forms]

    def includes(self, source: str, debug: bool) -> bool:
        """Return whether a source has the compiled file that the robot will use."""
        return Path(_cache_of(source, debug)).name in self._forms(source)[1]

    def link(self, source: str, target: str, is_good: Callable[[str], bool] = lambda form: True) -> bool:
        """Link the compiled files of `source` for `target`, which is a link to the same file. Return whether all are.

        :param is_good: returns whether to link a compiled file
        """
        directory, there = self._forms(source)
        forms = [form for form in there if is_good(f"{directory}/__pycache__/{form}")]
        if not forms:
            return not there
        cache = os.path.split(target)[0] + "/__pycache__"
        if cache not in self._made:
            Path(cache).mkdir(exist_ok=True)
            self._made.add(cache)
        for form in forms:
            with suppress(OSError):  # the program compiles it when it imports it
                link_or_copy(f"{directory}/__pycache__/{form}", f"{cache}/{form}")
        return len(forms) == len(there)

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
