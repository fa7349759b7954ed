"""What pyfrc had for its own commands, and test files of some teams import."""

from __future__ import annotations

import sys


def yesno(prompt: str) -> bool:
    """Ask until the answer is y or n; return whether it is y.

    :raises EOFError: when there is no more input
    """
    while (answer := input(f"{prompt} [y/n]").lower()) not in ("y", "n"):
        pass
    return answer == "y"


def print_err(*args: object) -> None:
    """Print to standard error."""
    print(*args, file=sys.stderr)
