"""Under the field: the robot's output, and the reason when its program has failed."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from ...engine.simulation import Simulation
from ...engine.snapshot import Failure
from ..models.wording import plain_output
from . import theme as colors
from .theme import Theme

#: The lines that stay visible; the longest headline of a failure above them, in characters.
_MOST_LINES, _MOST_HEADLINE = 2000, 300
#: The most text that is added in one frame, in characters: its end, where a robot prints faster.
_MOST_AT_ONCE = 200_000


class ConsoleView:
    """The robot's output, line by line."""

    def __init__(self, parent: tk.Misc, theme: Theme, simulation: Simulation) -> None:
        px = theme.px
        self._simulation, self._output = simulation, simulation.output_cursor()
        self._failure: Failure | None = None
        self.frame = frame = colors.card(parent, theme)
        self._banner = banner = tk.Frame(frame, background="#fdecec")
        self.restart = ttk.Button(
            banner, text="Restart robot", style="Stop.TButton", command=simulation.restart, takefocus=False
        )
        self.restart.pack(side="right", padx=px(10), pady=px(6))
        self.headline = tk.Label(
            banner, background="#fdecec", foreground=colors.RED, font=theme.bold, anchor="w", justify="left"
        )
        self.headline.pack(side="left", fill="x", expand=True, padx=px(10))
        self.headline.bind("<Configure>", lambda event: self.headline.configure(wraplength=event.width))
        self._body = body = tk.Frame(frame, background=colors.CARD)
        body.pack(side="bottom", fill="both", expand=True)
        self.text = text = tk.Text(
            body,
            font=theme.mono,
            background=colors.CARD,
            foreground=colors.TEXT,
            relief="flat",
            highlightthickness=0,
            borderwidth=0,
            wrap="word",
            height=4,
            width=20,
            padx=px(10),
            pady=px(6),
            state="disabled",
            takefocus=False,
            cursor="arrow",
        )
        text.tag_configure("trace", foreground=colors.RED)
        text.tag_configure("hint", foreground=colors.MUTED)
        scrollbar = ttk.Scrollbar(body, command=self._scroll)
        text.configure(yscrollcommand=scrollbar.set)
        #: Whether to show the last line; False while the user reads above it.
        self._follows = True
        for turned in ("<MouseWheel>", "<Button-4>", "<Button-5>"):
            text.bind(turned, lambda event: text.after_idle(self._look))
        text.bind("<Configure>", lambda event: self._show_end())
        # A disabled text widget receives no keys.
        frame.winfo_toplevel().bind("<<Copy>>", lambda event: self._copy(), add="+")
        scrollbar.pack(side="right", fill="y")
        text.pack(side="left", fill="both", expand=True)
        self._empty = True
        self._append("What the robot prints appears here.\n", "hint")
        self._empty = True

    def show(self, failure: Failure | None) -> None:
        """Show new output, and the failure."""
        if output := self._output.read_last(_MOST_AT_ONCE):
            self._append(plain_output(output))
        if failure is self._failure:
            return
        self._failure = failure
        if failure is None:
            self._banner.pack_forget()
            return
        headline = failure.headline
        if len(headline) > _MOST_HEADLINE:
            headline = f"{headline[:_MOST_HEADLINE].rstrip()}…"
        self.headline.configure(text=f"{headline}\nafter {failure.time:.2f} s")
        self._banner.pack(side="top", fill="x", before=self._body)
        self._append(f"\n{failure.details or failure.headline}\n", "trace")

    def mark(self, what: str) -> None:
        """Show an event between the output before it and after it."""
        if not self._empty or self._simulation.snapshot is not None:
            self.show(self._failure)
            self._append(f"— {what} —\n", "hint")

    def _append(self, new: str, tag: str = "") -> None:
        text = self.text
        text.configure(state="normal")
        if self._empty:
            text.delete("1.0", "end")
            self._empty = False
        text.insert("end", new, tag)
        if (lines := int(text.index("end-1c").partition(".")[0])) > _MOST_LINES:
            text.delete("1.0", f"{lines - _MOST_LINES}.0")
        text.configure(state="disabled")
        self._show_end()

    def _show_end(self) -> None:
        if self._follows:
            self.text.see("end")

    def _scroll(self, *how: object) -> None:
        self.text.yview(*how)
        self._look()

    def _look(self) -> None:
        self._follows = float(self.text.yview()[1]) >= 0.999

    def _copy(self) -> None:
        if self.text.tag_ranges("sel"):
            self.text.clipboard_clear()
            self.text.clipboard_append(self.text.get("sel.first", "sel.last"))
