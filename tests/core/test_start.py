"""How the command starts Python again where no process can replace itself: as on Windows."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from types import SimpleNamespace

import pytest

from pyfrc_cli import start

#: Saves what it has when it is interrupted, which takes as long as a line does to come from the terminal.
COMMAND = """
try:
    print("started", flush=True)
    input()
except KeyboardInterrupt:
    print("interrupted", flush=True)
    print("saved", input())
raise SystemExit(7)
"""

AS_ON_WINDOWS = f"""
import signal, subprocess, sys
from types import SimpleNamespace
from pyfrc_cli import start

start.sys = SimpleNamespace(platform="win32")
sys.exit(start.become([sys.executable, "-c", {COMMAND!r}]))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for a group of processes")
def test_ctrl_c_is_handled_by_the_command_alone() -> None:
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    command = [sys.executable, "-c", AS_ON_WINDOWS]
    with subprocess.Popen(command, **pipes, start_new_session=True, encoding="utf-8") as process:  # type: ignore[call-overload]
        assert process.stdout.readline() == "started\n"
        os.killpg(process.pid, signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        rest = process.communicate("the file\n")
    assert (*rest, process.returncode) == ("saved the file\n", "", 7)


@pytest.mark.parametrize(("code", "passed_on"), [(0, 0), (2, 2), (0xC0000005, 0xC0000005 - (1 << 32))])
def test_the_exit_code_is_passed_on(code: int, passed_on: int, monkeypatch: pytest.MonkeyPatch) -> None:
    class Ended:
        def __init__(self, command: list[str]) -> None:
            self.wait = lambda: code

        def __enter__(self) -> Ended:
            return self

        def __exit__(self, *error: object) -> None:
            pass

    monkeypatch.setattr(start, "sys", SimpleNamespace(platform="win32"))
    monkeypatch.setattr(subprocess, "Popen", Ended)
    before = signal.getsignal(signal.SIGINT)
    try:
        assert start.become(["anything"]) == passed_on
    finally:
        signal.signal(signal.SIGINT, before)
