"""The results of checks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Status = Literal["ok", "hint", "problem"]


@dataclass(frozen=True)
class CheckResult:
    """The result of one check.

    :param topic:  the subject, in one or two words
    :param status: a problem prevents something from working; a hint is optional, or not important yet
    :param text:   a description
    :param remedy: what to do; each hint and each problem has one
    """

    topic: str
    status: Status
    text: str
    remedy: str | None = None


def ok(topic: str, text: str) -> CheckResult:
    return CheckResult(topic, "ok", text)


def hint(topic: str, text: str, remedy: str) -> CheckResult:
    return CheckResult(topic, "hint", text, remedy)


def problem(topic: str, text: str, remedy: str) -> CheckResult:
    return CheckResult(topic, "problem", text, remedy)
