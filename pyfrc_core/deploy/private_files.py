"""Files that ``.gitignore`` names as secrets."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from .patterns import matches

_SECRET = re.compile(
    r"secret|passw(or)?d|credential|token|private|api[_ -]?key|[_ -]keys?\b|id_(rsa|ed25519)"
    r"|\.(env|key|pem|p12|pfx|jks|kdbx)\b",
    re.IGNORECASE,
)


class _Rule(NamedTuple):
    """One line of a ``.gitignore``.

    :param directory: the directory of the file
    :param ignores:   whether it ignores files, or takes them back (``!``)
    :param is_secret: whether it, or the comment above it, names secrets
    """

    directory: Path
    pattern: str
    ignores: bool
    is_secret: bool


class IgnoredSecrets:
    """The rules of the ``.gitignore`` files that apply to a project's directory and below it.

    A file is named as a secret if git ignores it, and its own name, the line that ignores it, or the comment above that
    line has a word such as "secret", "token" or "password".

    :param root: the project's directory
    """

    def __init__(self, root: Path) -> None:
        self._rules: list[_Rule] = []
        repository = next((each for each in (root, *root.parents) if (each / ".git").exists()), root)
        above = [each for each in (root, *root.parents) if each.is_relative_to(repository)]
        for each in reversed(above):
            self.add(each)

    def add(self, directory: Path) -> None:
        """Add the rules of a directory's ``.gitignore``, if it has one. Those of its parent must have been added."""
        file = directory / ".gitignore"
        if file.is_file():
            self._rules += _rules(directory, file.read_text(encoding="utf-8", errors="replace").splitlines())

    def include(self, file: Path) -> bool:
        """Return whether a file is named as a secret."""
        is_named = _SECRET.search(file.name) is not None
        if not any(_fits(rule, file) for rule in self._rules if rule.ignores and (is_named or rule.is_secret)):
            return False
        # The last rule that fits counts.
        return next((rule.ignores for rule in reversed(self._rules) if _fits(rule, file)), False)


def _rules(directory: Path, lines: Iterable[str]) -> Iterator[_Rule]:
    heading = ""
    for line in lines:
        text = line.strip()
        if not text:
            heading = ""
        elif text.startswith("#"):
            heading = text
        else:
            pattern = text.removeprefix("!").removeprefix("\\")
            yield _Rule(directory, pattern, not text.startswith("!"), bool(_SECRET.search(f"{heading}\n{pattern}")))


def _fits(rule: _Rule, file: Path) -> bool:
    """Return whether a rule fits a file, or a directory that contains it."""
    if not file.is_relative_to(rule.directory):
        return False
    parts = file.relative_to(rule.directory).parts
    paths = ["/".join(parts[:count]) for count in range(1, len(parts) + 1)]
    return any(matches(path, rule.pattern) for path in (paths[:-1] if rule.pattern.endswith("/") else paths))
