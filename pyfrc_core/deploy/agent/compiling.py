"""The compiled forms of a program's files, made on the robot: it then starts in seconds less."""

from __future__ import annotations

import ctypes
import os
import py_compile
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from importlib.util import cache_from_source
from pathlib import Path
from typing import Any

from .disk import files_below, link_or_copy
from .places import CODE

_SET_DEATH_SIGNAL = 1  # prctl
_TURN = 0.01  # seconds between two looks at the process that compiles
_TURNS_A_SIGN = 300


def compile_below(directory: Path, debug: bool, still_busy: Callable[[], None]) -> None:
    """Compile what is not compiled yet, in a process of its own: its memory is not ours, and its end is not either.

    :param still_busy: called now and then, since a robot takes a second for ten files
    """
    optimize = "" if debug else 1
    sources = [(name, file) for name, file in files_below(directory) if name.endswith(".py")]
    sources = [each for each in sources if not os.access(_cache_of(each[1], optimize), os.F_OK)]
    if not sources:
        return
    child = os.fork()
    if child == 0:
        try:
            ctypes.CDLL(None).prctl(_SET_DEATH_SIGNAL, signal.SIGKILL)
            level = 0 if debug else 1
            for name, file in sources:
                with suppress(Exception):  # such as a name that is too long with the cache's ending
                    py_compile.compile(str(file), _cache_of(file, optimize), f"{CODE}/{name}", quiet=2, optimize=level)
        finally:
            os._exit(0)
    turns = 0
    while os.waitpid(child, os.WNOHANG)[0] == 0:
        turns += 1
        if turns % _TURNS_A_SIGN == 0:
            still_busy()
        time.sleep(_TURN)


def _cache_of(file: Path, optimize: Any) -> str:
    return cache_from_source(str(file), optimization=optimize)


def compiled_forms(source: Path) -> list[Path]:
    """The compiled forms of a source file that are there."""
    cache = source.parent / "__pycache__"
    if source.suffix != ".py" or not cache.is_dir():
        return []
    return [each for each in cache.iterdir() if each.name.rsplit(".cpython-", 1)[0] == source.stem]


def link_compiled(source: Path, target: Path) -> None:
    """Let `target`, which is the same file as `source`, have its compiled forms, too."""
    for compiled in compiled_forms(source):
        cache = target.parent / "__pycache__"
        cache.mkdir(exist_ok=True)
        try:
            link_or_copy(compiled, cache / compiled.name)
        except OSError:
            continue  # it is compiled anew, then
