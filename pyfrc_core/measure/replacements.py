"""What measuring puts in the place of something else, until it is over. Without it, nothing of it costs anything."""

from __future__ import annotations

from typing import Any


class Replacements:
    """Attributes of classes and modules that are replaced for a while."""

    def __init__(self) -> None:
        self._originals: dict[tuple[Any, str], Any] = {}

    def replace(self, owner: Any, name: str, replacement: Any) -> None:
        """Put `replacement` there; doing it again changes nothing of what `undo` brings back."""
        self._originals.setdefault((owner, name), vars(owner).get(name))
        setattr(owner, name, replacement)

    def __contains__(self, place: tuple[Any, str]) -> bool:
        return place in self._originals

    def undo(self) -> None:
        """Bring everything back as it was."""
        while self._originals:
            (owner, name), original = self._originals.popitem()
            if original is None:
                delattr(owner, name)
            else:
                setattr(owner, name, original)
