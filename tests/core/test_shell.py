"""Commands in messages fit the user's shell."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from pyfrc_core.shell import getting_tkinter, quoted

from .source_texts import texts_in

ROOT = Path(__file__).parents[2]

#: Where commands are for a robot, or the system is asked before.
ELSEWHERE = (
    "pyfrc_core/deploy/agent/",
    "pyfrc_core/deploy/installing.py",
    "pyfrc_core/deploy/targets/",
    "pyfrc_core/virtual_robot/",
    "pyfrc_core/shell.py",
)

#: What PowerShell does not run, or what is not there on Windows.
POSIX_ONLY = re.compile(r"\bsudo\b|\bapt(-get)?\b|\bexport \w|bin/activate|\bpython3\b| && |\bchmod\b|\brm -|^\$ ")


@pytest.mark.parametrize(
    ("word", "on_linux", "on_windows"),
    [
        ("my-robot", "my-robot", "my-robot"),
        ("my robot", "'my robot'", '"my robot"'),
        ("C:\\Users\\team\\robot", "'C:\\Users\\team\\robot'", "C:\\Users\\team\\robot"),
        ("Größe", "'Größe'", "Größe"),
        ("a;b", "'a;b'", '"a;b"'),
        ("", "''", '""'),
    ],
)
def test_a_word_is_quoted_for_the_shell_of_the_system(word: str, on_linux: str, on_windows: str) -> None:
    assert quoted(word, "linux") == quoted(word, "darwin") == on_linux
    assert quoted(word, "win32") == on_windows


def test_tkinter_is_had_in_another_way_on_each_system() -> None:
    assert "sudo apt install python3-tk" in getting_tkinter("linux")
    assert "brew install python-tk" in getting_tkinter("darwin")
    assert "sudo" not in getting_tkinter("win32")


@pytest.mark.parametrize("package", ["pyfrc_cli", "pyfrc_core"])
def test_no_message_has_a_command_that_windows_lacks(package: str) -> None:
    found = [
        f"{file.relative_to(ROOT)}: {text}"
        for file in sorted((ROOT / package).rglob("*.py"))
        if not file.relative_to(ROOT).as_posix().startswith(ELSEWHERE)
        for text in texts_in(file).others
        if POSIX_ONLY.search(text)
    ]
    assert found == []
