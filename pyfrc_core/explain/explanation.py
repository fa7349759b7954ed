"""The result: what an error means."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Explanation:
    """What an error means.

    :param text: what is wrong, in one sentence; empty: the error's own text says it
    :param remedy: what to do; may have several lines
    :param place: the user's line, if it is another than the innermost one of the traceback
    """

    text: str = ""
    remedy: str = ""
    place: str = ""


def ask_for(written: str) -> str:
    """Return a question about an expression that is None."""
    return f"Does {written} return something?" if written.endswith(")") else f"Has anything set {written} before?"
