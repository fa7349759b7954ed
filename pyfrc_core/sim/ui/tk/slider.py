"""A thin, flat slider, coloured up to its knob. `ttk.Scale` cannot look like this on every system."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable

from . import theme as colors
from .theme import Theme


class Slider(tk.Canvas):
    """A slider with positions from 0 to 1.

    :param moved: called with the position while it is dragged; the second argument is True when it is released
    """

    def __init__(self, parent: tk.Misc, theme: Theme, width: int, moved: Callable[[float, bool], object]) -> None:
        background = str(parent.cget("background")) if isinstance(parent, tk.Frame) else colors.BACKGROUND
        height = theme.px(22)
        super().__init__(parent, width=width, height=height, background=background, highlightthickness=0)
        self._theme, self._moved = theme, moved
        self._width, self._middle, self._radius = width, height / 2, theme.px(7)
        self.position, self.held = 0.0, False
        thick = theme.px(4)
        self._track = self.create_line(0, 0, 0, 0, fill=colors.FAINT, width=thick, capstyle="round")
        self._passed = self.create_line(0, 0, 0, 0, fill=colors.ACCENT, width=thick, capstyle="round")
        self._knob = self.create_oval(0, 0, 0, 0, fill=colors.CARD, outline=colors.ACCENT, width=theme.px(2))
        self.bind("<Configure>", self._resized)
        self.bind("<Button-1>", self._press)
        self.bind("<B1-Motion>", self._drag)
        self.bind("<ButtonRelease-1>", self._release)

    def show(self, place: float) -> None:
        """Move to a position, unless the slider is being dragged."""
        if not self.held:
            self._go(place)

    def pixel_of(self, place: float) -> float:
        return self._radius + 1 + place * max(self._width - 2 * self._radius - 2, 1)

    def _go(self, place: float) -> None:
        place = min(max(place, 0.0), 1.0)
        before, now = round(self.pixel_of(self.position)), round(self.pixel_of(place))
        self.position = place
        if before != now:
            self._draw()

    def _draw(self) -> None:
        x, y, r = self.pixel_of(self.position), self._middle, self._radius
        self.coords(self._track, self.pixel_of(0), y, self.pixel_of(1), y)
        self.coords(self._passed, self.pixel_of(0), y, x, y)
        self.coords(self._knob, x - r, y - r, x + r, y + r)

    def _resized(self, event: tk.Event[tk.Canvas]) -> None:
        self._width, self._middle = event.width, event.height / 2
        self._draw()

    def _at(self, pixel: int) -> float:
        first, last = self.pixel_of(0), self.pixel_of(1)
        return min(max((pixel - first) / (last - first), 0.0), 1.0)

    def _press(self, event: tk.Event[tk.Canvas]) -> None:
        self.held = True
        self._drag(event)

    def _drag(self, event: tk.Event[tk.Canvas]) -> None:
        if self.held:
            self._go(self._at(event.x))
            self._moved(self.position, False)

    def _release(self, event: tk.Event[tk.Canvas]) -> None:
        if self.held:
            self.held = False
            self._moved(self.position, True)
