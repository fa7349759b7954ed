"""A column of cards that scrolls when the window is too low for all of them."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from . import theme as colors
from .theme import Theme


class ScrollingColumn:
    """A scrolling column; its widgets are packed into `inside`.

    :param width: in pixels
    """

    def __init__(self, parent: tk.Misc, theme: Theme, width: int) -> None:
        self._theme = theme
        self.frame = frame = ttk.Frame(parent)
        self.canvas = canvas = tk.Canvas(
            frame, width=width, height=1, background=colors.BACKGROUND, highlightthickness=0, yscrollincrement=1
        )
        self._scrollbar = ttk.Scrollbar(frame, command=canvas.yview)
        canvas.configure(yscrollcommand=self._scrollbar.set)
        canvas.pack(side="left", fill="both", expand=True)
        self.inside = ttk.Frame(canvas)
        canvas.create_window(0, 0, anchor="nw", window=self.inside, width=width)
        self.inside.bind("<Configure>", self._fit)
        canvas.bind("<Configure>", self._fit)
        # The wheel turns over whatever is inside.
        window = frame.winfo_toplevel()
        window.bind("<MouseWheel>", lambda event: self._turned(event, -1 if event.delta > 0 else 1), add="+")
        window.bind("<Button-4>", lambda event: self._turned(event, -1), add="+")
        window.bind("<Button-5>", lambda event: self._turned(event, 1), add="+")

    def _fit(self, event: tk.Event[tk.Misc]) -> None:
        height = self.inside.winfo_reqheight()
        self.canvas.configure(scrollregion=(0, 0, self.canvas.winfo_reqwidth(), height))
        if height > self.canvas.winfo_height():
            self._scrollbar.pack(side="right", fill="y")
        else:
            self._scrollbar.pack_forget()
            self.canvas.yview_moveto(0)

    def _turned(self, event: tk.Event[tk.Misc], way: int) -> None:
        if str(event.widget).startswith(f"{self.frame}.") and self.canvas.yview() != (0.0, 1.0):
            self.canvas.yview_scroll(way * self._theme.px(48), "units")
