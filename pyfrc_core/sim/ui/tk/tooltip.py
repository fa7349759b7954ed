"""Help beside the mouse pointer, when it rests on something."""

from __future__ import annotations

import tkinter as tk

from .theme import Theme

_DELAY_MS = 500


class Tooltip:
    """The one tooltip of a window."""

    def __init__(self, root: tk.Tk, theme: Theme) -> None:
        self._root, self._theme = root, theme
        self._window: tk.Toplevel | None = None
        self._alarm: str | None = None
        self.text = ""

    def attach(self, widget: tk.Misc, text: str) -> None:
        """Show the text when the mouse rests on the widget."""
        widget.bind("<Enter>", lambda event: self.expect(text, event.x_root, event.y_root), add="+")
        widget.bind("<Leave>", lambda event: self.hide(), add="+")
        widget.bind("<Button>", lambda event: self.hide(), add="+")

    def expect(self, text: str, x: int, y: int) -> None:
        """Show a text at this place soon, unless the mouse moves on."""
        if text == self.text:
            return
        self.hide()
        self.text = text
        if text:
            self._alarm = self._root.after(_DELAY_MS, self._show, x, y)

    def hide(self) -> None:
        if self._alarm is not None:
            self._root.after_cancel(self._alarm)
        if self._window is not None:
            self._window.destroy()
        self._window, self._alarm, self.text = None, None, ""

    def _show(self, x: int, y: int) -> None:
        self._alarm = None
        px = self._theme.px
        self._window = window = tk.Toplevel(self._root)
        window.wm_overrideredirect(True)
        tk.Label(
            window,
            text=self.text,
            font=self._theme.small,
            background="#1c2530",
            foreground="#ffffff",
            padx=px(8),
            pady=px(4),
            justify="left",
            wraplength=px(320),
        ).pack()
        window.update_idletasks()
        x = min(x + px(12), window.winfo_screenwidth() - window.winfo_reqwidth())
        y = min(y + px(16), window.winfo_screenheight() - window.winfo_reqheight())
        window.wm_geometry(f"+{x}+{y}")
