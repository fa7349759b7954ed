"""Attributes that measuring replaces until it is over. Without measuring, nothing is replaced or slower."""

from __future__ import annotations

from typing import Any


class Replacements:
    """Attributes of classes and modules that are replaced temporarily."""

    def __init__(self) -> None:
        self._originals: dict[tuple[Any, str], Any] = {}

    def replace(self, owner: Any, name: str, replacement: Any) -> None:
        """Replace an attribute. A second replacement does not change what `undo` restores."""
        self._originals.setdefault((owner, name), vars(owner).get(name))
        setattr(owner, name, replacement)

    def __contains__(self, place: tuple[Any, str]) -> bool:
        return place in self._originals

    def undo(self) -> None:
        """Restore all original attributes."""
        while self._originals:
            (owner, name), original = self._originals.popitem()
            if original is None:
                delattr(owner, name)
            else:
                setattr(owner, name, original)
