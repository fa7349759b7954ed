"""Boxes with a list to choose from, which neither keep the keys nor turn with the wheel."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk


def has_keys(widget: tk.Misc) -> bool:
    """Whether what is typed goes to this widget.

    By its name: tkinter knows no widgets that Tk has made for itself, such as a box's list, and `focus_get` fails then.
    """
    return str(widget.tk.call("focus")) == str(widget)


def tame(box: ttk.Combobox, done: Callable[[], object]) -> None:
    """Have something chosen from a box's list only, and by nothing that is meant for what is around it.

    :param done: called when the box gets the keys, and its list is not open, as when that is closed without a choice:
        else the arrows would both drive and open the list again
    """
    for turned in ("<MouseWheel>", "<Button-4>", "<Button-5>"):
        box.bind(turned, lambda event: "break")

    def look() -> None:
        popdown = f"{box}.popdown"
        is_open = int(box.tk.call("winfo", "exists", popdown)) and int(box.tk.call("winfo", "ismapped", popdown))
        if not is_open and has_keys(box):
            done()

    box.bind("<FocusIn>", lambda event: box.after_idle(look), add="+")
