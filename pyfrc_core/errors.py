"""Every failure a user can meet: one base class, a message that says what is wrong, where, and what to do.

A command prints the message and exits with `exit_code`; the traceback is shown only with ``-v``.
"""

from __future__ import annotations

from pathlib import Path


class PyfrcError(Exception):
    """A failure with an explanation for the user.

    :param message: what is wrong, in one sentence
    :param where:   the place: a file, optionally with a line (``robot.py:12``) or a key
    :param remedy:  what the user can do about it
    """

    exit_code = 1

    def __init__(self, message: str, *, where: str | Path | None = None, remedy: str | None = None) -> None:
        self.message = message
        self.where = None if where is None else str(where)
        self.remedy = remedy
        Exception.__init__(self, str(self))  # an error that is a library's, too, has another first argument there

    def __str__(self) -> str:
        text = f"{self.where}: {self.message}" if self.where else self.message
        return f"{text}\n  {self.remedy}" if self.remedy else text


class UsageError(PyfrcError):
    """The command was called wrongly: a missing project, an invalid option."""

    exit_code = 2


class ProjectError(UsageError):
    """There is no robot project here, or it has no (or more than one) robot class."""


class SettingsError(UsageError):
    """A key or value in ``[tool.pyfrc]`` or ``sim/config.json`` is not allowed."""


class RobotCodeError(PyfrcError):
    """The robot's own code failed while it was loaded; `where` is the user's own line."""


def text_of(error: BaseException) -> str:
    """Return type and text of an error, such as ``ZeroDivisionError: division by zero``.

    Works for errors whose own `__str__` raises, too.
    """
    try:
        if isinstance(error, SystemExit) and not isinstance(error.code, str):
            return f"exit({'' if error.code is None else repr(error.code)}) was called"
        return f"{type(error).__name__}: {error}".rstrip(": ")
    except Exception as another:
        return f"{type(error).__name__} (whose text raises {type(another).__name__})"


def nearest(word: str, known: list[str]) -> str:
    """Return a hint such as ``did you mean 'teleop'?``, or the list of known words."""
    from difflib import get_close_matches

    by_lower_case = {each.lower(): each for each in known}
    match = get_close_matches(word.lower(), by_lower_case, n=1, cutoff=0.6)
    if match:
        return f"did you mean {by_lower_case[match[0]]!r}?"
    return "there is: " + ", ".join(sorted(known)) if known else "there is nothing here"
