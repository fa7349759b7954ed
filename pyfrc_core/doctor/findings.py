"""What was found, good or bad, as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Status = Literal["ok", "hint", "problem"]


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at.

    :param topic:  what it is about, in a word or two
    :param status: a problem keeps something from working; a hint is of what could be, or does not matter yet
    :param text:   how it is
    :param remedy: what to do about it; every hint and every problem has one
    """

    topic: str
    status: Status
    text: str
    remedy: str | None = None


def ok(topic: str, text: str) -> Finding:
    return Finding(topic, "ok", text)


def hint(topic: str, text: str, remedy: str) -> Finding:
    return Finding(topic, "hint", text, remedy)


def problem(topic: str, text: str, remedy: str) -> Finding:
    return Finding(topic, "problem", text, remedy)
