"""Patterns of paths, as in ``[tool.pyfrc.deploy] exclude`` and in ``.gitignore``."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase


def matches(path: str, pattern: str) -> bool:
    """Return whether a path (relative, with forward slashes) matches a pattern.

    A pattern without a slash matches the name of a file or directory at any depth. A pattern with a slash matches the
    whole path; ``**`` matches any number of directories.
    """
    parts, wanted = path.split("/"), pattern.strip("/").split("/")
    if "/" in pattern.rstrip("/"):
        return _fits(parts, wanted)
    return len(wanted) == 1 and fnmatchcase(parts[-1], wanted[0])


def _fits(parts: Sequence[str], wanted: Sequence[str]) -> bool:
    if not wanted:
        return not parts
    if wanted[0] == "**":
        return any(_fits(parts[skipped:], wanted[1:]) for skipped in range(len(parts) + 1))
    return bool(parts) and fnmatchcase(parts[0], wanted[0]) and _fits(parts[1:], wanted[1:])
