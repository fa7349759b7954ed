"""The texts of errors, also of those that cannot say what they are."""

from __future__ import annotations

from pathlib import Path

from pyfrc_core.errors import PyfrcError, UsageError, nearest, text_of


class Unspeakable(Exception):
    """Its text raises another error."""

    def __str__(self) -> str:
        raise LookupError


def test_an_error_says_where_what_and_what_to_do() -> None:
    assert str(PyfrcError("no", where=Path("a.py"), remedy="Go.")) == "a.py: no\n  Go."
    assert str(PyfrcError("no")) == "no"
    assert (PyfrcError("no").where, PyfrcError("no").exit_code, UsageError("no").exit_code) == (None, 1, 2)


def test_the_text_of_any_error() -> None:
    errors = {
        ZeroDivisionError("division by zero"): "ZeroDivisionError: division by zero",
        ValueError(): "ValueError",
        Unspeakable(): "Unspeakable (whose text raises LookupError)",
        SystemExit(3): "exit(3) was called",
        SystemExit(): "exit() was called",
        SystemExit("done"): "SystemExit: done",
    }
    assert {error: text_of(error) for error in errors} == errors


def test_a_word_that_was_meant() -> None:
    assert nearest("TELOP", ["teleop", "Test"]) == "did you mean 'teleop'?"
    assert nearest("x", ["b", "a"]) == "there is: a, b"
    assert nearest("x", []) == "there is nothing here"
