"""What is different between two locks."""

from __future__ import annotations

from collections.abc import Iterator

from .lock import Lock


def changes(before: Lock, after: Lock) -> Iterator[str]:
    """Yield the changes for the robot, each as one line."""
    old = {each.name: each for each in before.files}
    new = {each.name: each for each in after.files}
    for name in sorted(old.keys() | new.keys()):
        if name not in old:
            yield f"+ {new[name]}"
        elif name not in new:
            yield f"- {old[name]}"
        elif old[name].version != new[name].version:
            other = new[name].index if old[name].index not in (None, new[name].index) else None
            yield f"{old[name]} -> {new[name].version}{f', now from {other}' if other else ''}"
        elif old[name].sha256 != new[name].sha256:
            yield f"{new[name]}: another file of this version"
    for requirement in after.requirements:
        if requirement not in before.requirements:
            yield f"asked for now: {requirement}"
    for requirement in before.requirements:
        if requirement not in after.requirements:
            yield f"no longer asked for: {requirement}"
