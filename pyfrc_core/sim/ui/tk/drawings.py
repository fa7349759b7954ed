"""What robot code draws on the field, as items of the canvas."""

from __future__ import annotations

import tkinter as tk
from typing import Any

from ...engine.scene import Line, Text
from ..models.viewport import Viewport
from .theme import Theme

TAG = "drawing"


class Drawings:
    """Keeps the canvas like a scene's drawings; those that stay are left as they are."""

    def __init__(self, canvas: tk.Canvas, theme: Theme) -> None:
        self._canvas, self._theme = canvas, theme
        # By what they are: those told again are equal, but other objects.
        self._items: dict[str, tuple[Line | Text, int]] = {}
        self._shown: tuple[Line | Text, ...] = ()
        self._wrong: dict[str, str] = {}

    @property
    def problem(self) -> str:
        """What could not be drawn, for the user; the first of it."""
        return next((problem for key, problem in self._wrong.items() if key in self._items), "")

    def show(self, drawings: tuple[Line | Text, ...], view: Viewport) -> bool:
        """Draw what is new, and take away what is no more; answers whether there is anything new."""
        if drawings is self._shown:
            return False
        before, self._items, self._shown = self._items, {}, drawings
        for drawing in drawings:
            key = repr(drawing)
            known = before.pop(key, None)
            self._items[key] = (drawing, self._draw(drawing, view)) if known is None else known
        for _, item in before.values():
            self._canvas.delete(item)
        return True

    def move(self, view: Viewport) -> None:
        """Another part of the field is to be seen."""
        for drawing, item in self._items.values():
            points = drawing.points if isinstance(drawing, Line) else ((drawing.x, drawing.y),)
            self._canvas.coords(item, *view.line(points))

    def _draw(self, drawing: Line | Text, view: Viewport) -> int:
        try:
            if isinstance(drawing, Line):
                return self._canvas.create_line(*view.line(drawing.points), **self._line_options(drawing))
            return self._canvas.create_text(*view.to_screen(drawing.x, drawing.y), **self._text_options(drawing))
        except (tk.TclError, TypeError) as wrong:
            name = "draw_line" if isinstance(drawing, Line) else "draw_text"
            self._wrong[repr(drawing)] = f"{name}: {wrong}"
            return self._canvas.create_line(0, 0, 0, 0, state="hidden")

    def _line_options(self, line: Line) -> dict[str, Any]:
        px = self._theme.px
        shape = (px(10), px(12), px(5))
        own: dict[str, Any] = {"fill": line.color, "width": px(2), "joinstyle": "round", "arrowshape": shape}
        own["arrow"] = "last" if line.arrow else "none"
        own.update(line.options)
        own["tags"] = (TAG, *_tags(own))
        return own

    def _text_options(self, text: Text) -> dict[str, Any]:
        size = -max(round(text.size * 96 / 72 * self._theme.scale), 1)
        own: dict[str, Any] = {"text": text.text, "fill": text.color}
        own["font"] = (self._theme.body.cget("family"), size)
        own.update(text.options)
        own["tags"] = (TAG, *_tags(own))
        return own


def _tags(options: dict[str, Any]) -> tuple[str, ...]:
    tags = options.get("tags", ())
    return (tags,) if isinstance(tags, str) else tuple(tags)
