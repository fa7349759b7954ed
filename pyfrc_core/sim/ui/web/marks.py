"""What happened when: the marks of the timeline."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

Kind = Literal["mode", "overrun", "warning", "error", "failure", "press", "own", "run"]

#: The most marks that are kept; of more, the oldest are forgotten, but not the person's own.
_MOST = 2000
_LONGEST_TEXT = 200


@dataclass(frozen=True)
class Mark:
    """One mark.

    :param n: its number; they count from 1
    :param t: robot time, in seconds
    """

    n: int
    t: float
    kind: Kind
    text: str

    def plain(self) -> dict[str, object]:
        """Return it for a page."""
        return {"n": self.n, "t": round(self.t, 3), "kind": self.kind, "text": self.text}


class Marks:
    """The marks of one run, in the order in which they were found."""

    def __init__(self) -> None:
        self._marks: list[Mark] = []
        #: The number of all marks, also of those that are no longer kept.
        self.count = 0
        self._buttons: dict[str, Any] = {}

    def all(self) -> tuple[Mark, ...]:
        """Return all marks."""
        return tuple(self._marks)

    def since(self, number: int) -> list[Mark]:
        """Return the marks after the one with this number."""
        return [mark for mark in tuple(self._marks) if mark.n > number]

    def add(self, time: float, kind: Kind, text: str) -> None:
        """Add a mark."""
        self.count += 1
        marks = [*self._marks, Mark(self.count, time, kind, text[:_LONGEST_TEXT])]
        if len(marks) > _MOST:
            spare = next((each for each in marks if each.kind != "own"), marks[0])
            marks.remove(spare)
        self._marks = marks

    def forget_after(self, time: float, except_own: bool = False) -> None:
        """Forget the marks after a moment: another run goes on from there.

        :param except_own: keep those of the person, since the run comes to the same moments again
        """
        self._marks = [mark for mark in self._marks if mark.t <= time or (except_own and mark.kind == "own")]
        self._buttons = {}

    def look_at_buttons(self, time: float, path: str, pressed: Any) -> None:
        """Add a mark for each button of a joystick that was pressed."""
        before = self._buttons.get(path)
        self._buttons[path] = pressed
        if not isinstance(before, tuple) or not isinstance(pressed, tuple):
            return
        stick = path.partition("[")[2].partition("]")[0]
        for number, (was, now) in enumerate(zip(before, pressed, strict=False)):
            if now and not was:
                self.add(time, "press", f"joystick {stick}, button {number}")
