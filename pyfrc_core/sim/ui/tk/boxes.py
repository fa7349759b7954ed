"""Boxes with a list to choose from, which neither keep the keyboard focus nor react to the wheel."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk


def has_keys(widget: tk.Misc) -> bool:
    """Return whether this widget has the keyboard focus.

    Compares names, since `focus_get` fails for widgets that Tk has made itself, such as a box's list.
    """
    return str(widget.tk.call("focus")) == str(widget)


def tame(box: ttk.Combobox, done: Callable[[], object]) -> None:
    """Let a box change only by its list, and not by the wheel or by keys that drive.

    :param done: called when the box gets the focus while its list is closed, as after a list was closed without a
        choice; otherwise the arrow keys would both drive and open the list again
    """
    for turned in ("<MouseWheel>", "<Button-4>", "<Button-5>"):
        box.bind(turned, lambda event: "break")

    def look() -> None:
        popdown = f"{box}.popdown"
        is_open = int(box.tk.call("winfo", "exists", popdown)) and int(box.tk.call("winfo", "ismapped", popdown))
        if not is_open and has_keys(box):
            done()

    box.bind("<FocusIn>", lambda event: box.after_idle(look), add="+")
