"""What is wrong in robot code although it raises no error here."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class CodeWarning:
    """A mistake in robot code.

    :param where: ``robot.py:12``
    :param text: the problem in one sentence, without its place
    :param remedy: the remedy in one sentence
    """

    where: str
    text: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.where}: {self.text}"
