"""One kind of thing that a robot's run may leave."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator


class StatePart(ABC):
    """One kind of thing, as it is when this is created."""

    def restore(self) -> None:  # noqa: B027 - some can only be looked at
        """Put it back, as far as public calls can."""

    @abstractmethod
    def left_over(self) -> Iterator[str]:
        """Yield what differs from the beginning, as ``the thread 'camera'``."""
