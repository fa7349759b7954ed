"""What robot code draws on the field, as items of the canvas."""

from __future__ import annotations

import tkinter as tk
from typing import Any

from ...engine.scene import Line, Text
from ..models.viewport import Viewport
from .theme import Theme

TAG = "drawing"


class Drawings:
    """Draws a scene's drawings on the canvas; items of drawings that stay are kept."""

    def __init__(self, canvas: tk.Canvas, theme: Theme) -> None:
        self._canvas, self._theme = canvas, theme
        # By their contents: an update brings equal drawings, but other objects.
        self._items: dict[str, tuple[Line | Text, int]] = {}
        self._shown: tuple[Line | Text, ...] = ()
        self._wrong: dict[str, str] = {}

    @property
    def problem(self) -> str:
        """The first reason why something could not be drawn, for the user."""
        return next((problem for key, problem in self._wrong.items() if key in self._items), "")

    def show(self, drawings: tuple[Line | Text, ...], view: Viewport) -> bool:
        """Draw what is new and remove what is gone. Returns False when the drawings are the same."""
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
        """Place all items for another part of the field."""
        for drawing, item in self._items.values():
            points = drawing.points if isinstance(drawing, Line) else ((drawing.x, drawing.y),)
            self._canvas.coords(item, *view.line(points))

    def _draw(self, drawing: Line | Text, view: Viewport) -> int:
        try:
            if drawing.problem:
                return self._hidden(drawing, drawing.problem)
            if isinstance(drawing, Line):
                return self._canvas.create_line(*view.line(drawing.points), **self._line_options(drawing))
            return self._canvas.create_text(*view.to_screen(drawing.x, drawing.y), **self._text_options(drawing))
        except (tk.TclError, TypeError) as wrong:
            name = "draw_line" if isinstance(drawing, Line) else "draw_text"
            return self._hidden(drawing, f"{name}: {wrong}")

    def _hidden(self, drawing: Line | Text, problem: str) -> int:
        self._wrong[repr(drawing)] = problem
        return self._canvas.create_line(0, 0, 0, 0, state="hidden")

    def _line_options(self, line: Line) -> dict[str, Any]:
        px, style = self._theme.px, line.style
        options: dict[str, Any] = {
            "fill": line.color,
            "width": px(2) if style.width is None else style.width,
            "smooth": style.smooth,
            "capstyle": style.cap,
            "joinstyle": style.join,
            "arrow": "last" if line.arrow else "none",
            "arrowshape": (px(10), px(12), px(5)),
            "tags": TAG,
        }
        if style.dash:
            options["dash"] = style.dash
        return options

    def _text_options(self, text: Text) -> dict[str, Any]:
        style, size = text.style, -max(round(text.size * 96 / 72 * self._theme.scale), 1)
        family = style.family or self._theme.body.cget("family")
        return {
            "text": text.text,
            "fill": text.color,
            "font": (family, size, *(name for name in ("bold", "italic", "underline") if getattr(style, name))),
            "anchor": style.anchor,
            "angle": style.angle,
            "justify": style.justify,
            "width": style.width,
            "tags": TAG,
        }
