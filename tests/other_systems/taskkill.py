"""Windows' program that ends a process with all that it has started: ``taskkill /F /T /PID 123``."""

from __future__ import annotations

import os
import signal
import sys


def _children(process: int) -> list[int]:
    children = []
    for thread in os.listdir(f"/proc/{process}/task"):
        with open(f"/proc/{process}/task/{thread}/children", encoding="ascii") as file:
            children += [int(child) for child in file.read().split()]
    return children


def _kill(process: int) -> None:
    try:
        children = _children(process)
        os.kill(process, signal.SIGKILL)
    except OSError:
        return
    for child in children:
        _kill(child)


_kill(int(sys.argv[sys.argv.index("/PID") + 1]))
