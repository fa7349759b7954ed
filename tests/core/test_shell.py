"""Commands in messages fit the user's shell."""

from __future__ import annotations

import pytest

from pyfrc_core.shell import getting_tkinter, quoted


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
