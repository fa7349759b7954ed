"""A line that grows at its end, such as the robot's trail.

It is cut into pieces, so that a new point does not redraw the whole line.
"""

from __future__ import annotations

import tkinter as tk
from typing import Any

from ...engine.scene import Point
from ..models.viewport import Viewport

_PIECE = 100


class Trail:
    """One trail on a canvas.

    :param options: of the canvas's lines
    """

    def __init__(self, canvas: tk.Canvas, tag: str, **options: Any) -> None:
        self._canvas, self._tag, self._options = canvas, tag, options
        self._points: tuple[Point, ...] = ()
        self._pieces: list[int] = []

    def show(self, points: tuple[Point, ...], view: Viewport) -> None:
        """Draw a line through these points."""
        if points is self._points:
            return
        before, self._points = self._points, points
        goes_on = 0 < len(before) <= len(points) and points[0] == before[0] and points[len(before) - 1] == before[-1]
        if goes_on and len(points) == len(before):
            return
        self._draw((len(before) - 1) // _PIECE if goes_on else 0, view)

    def move(self, view: Viewport) -> None:
        """Place the line for another part of the field."""
        self._draw(0, view)

    def _draw(self, first: int, view: Viewport) -> None:
        needed = (len(self._points) - 1 + _PIECE - 1) // _PIECE if len(self._points) > 1 else 0
        while len(self._pieces) > needed:
            self._canvas.delete(self._pieces.pop())
        for number in range(min(first, needed), needed):
            piece = view.line(self._points[number * _PIECE : (number + 1) * _PIECE + 1])
            if number < len(self._pieces):
                self._canvas.coords(self._pieces[number], *piece)
            else:
                item = self._canvas.create_line(*piece, tags=self._tag, capstyle="round", **self._options)
                self._pieces.append(item)
                if self._canvas.find_withtag("over"):
                    self._canvas.tag_lower(item, "over")
