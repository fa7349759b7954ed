"""The look of the window: colours, fonts, sizes."""

from __future__ import annotations

import sys
import tkinter as tk
from dataclasses import dataclass
from tkinter import font as tk_font
from tkinter import ttk
from typing import Any

# The contrast of text is at least 4.5.
BACKGROUND, CARD, BORDER = "#eef0f3", "#ffffff", "#d8dde3"
TEXT, MUTED, FAINT = "#1c2530", "#5d6875", "#c3cad2"
ACCENT, GREEN, RED, AMBER = "#2563eb", "#15803d", "#c81e1e", "#b45309"
LAMP_ON, LAMP_OFF, TRACK = "#22c55e", "#d3d9e0", "#e3e7ec"
FORWARDS, BACKWARDS = "#2f9e58", "#d9534a"

CARPET, GRID, EDGE = "#dfe3e8", "#d0d6dc", "#8a949f"
TRAIL, FORMER_TRAIL = "#2563eb", "#d97706"
RED_ALLIANCE, BLUE_ALLIANCE = "#c62828", "#1d4fbf"

#: The number of the mouse's right button.
RIGHT_BUTTON = 2 if sys.platform == "darwin" else 3

_FAMILIES = {"win32": ("Segoe UI",), "darwin": ("SF Pro Text", "Helvetica Neue")}
_ELSEWHERE = ("Inter", "Cantarell", "Ubuntu", "Noto Sans", "DejaVu Sans")
_MONO = ("Cascadia Mono", "SF Mono", "Menlo", "JetBrains Mono", "DejaVu Sans Mono")

#: The window's sizes are made for screens of this many pixels an inch, and this many pixels in all.
_DESIGN_DPI, _DESIGN_WIDTH, _DESIGN_HEIGHT = 96.0, 1300.0, 700.0

#: Screens that are denser by less than this are as the design is: letters keep their whole pixels.
_DENSE = 1.2


def scale_for(dpi: float, width: int, height: int, *, points: bool) -> float:
    """Return the number of the screen's pixels per pixel of the design.

    :param points: whether the system multiplies by itself, as macOS does
    """
    if points:
        return 1.0
    wanted = dpi / _DESIGN_DPI
    if wanted < _DENSE:
        wanted = 1.0
    # Never so large that the window does not fit on the screen.
    return max(min(wanted, width / _DESIGN_WIDTH, height / _DESIGN_HEIGHT), 0.75)


@dataclass(frozen=True)
class Theme:
    """Sizes and fonts for one screen."""

    scale: float
    body: tk_font.Font
    small: tk_font.Font
    tiny: tk_font.Font
    bold: tk_font.Font
    large: tk_font.Font
    mono: tk_font.Font

    def px(self, size: float) -> int:
        """Return a length of the design in the screen's pixels."""
        return max(round(size * self.scale), 1)


def make_theme(root: tk.Tk) -> Theme:
    """Prepare the window's styles."""
    scale = scale_for(
        root.winfo_fpixels("1i"), root.winfo_screenwidth(), root.winfo_screenheight(), points=sys.platform == "darwin"
    )
    families = set(tk_font.families(root))
    body = next((name for name in _FAMILIES.get(sys.platform, _ELSEWHERE) if name in families), "TkDefaultFont")
    mono = next((name for name in _MONO if name in families), "TkFixedFont")
    if body not in families:
        body = str(tk_font.nametofont("TkDefaultFont", root).actual("family"))
    if mono not in families:
        mono = str(tk_font.nametofont("TkFixedFont", root).actual("family"))

    def letters(family: str, size: float, weight: str = "normal") -> tk_font.Font:
        # Negative sizes are pixels.
        bold = "bold" if weight == "bold" else "normal"
        return tk_font.Font(root, family=family, size=-max(round(size * scale), 8), weight=bold)  # type: ignore[arg-type]

    theme = Theme(
        scale,
        body=letters(body, 12),
        small=letters(body, 11),
        tiny=letters(body, 9),
        bold=letters(body, 12, "bold"),
        large=letters(body, 15, "bold"),
        mono=letters(mono, 12),
    )
    _style(root, theme)
    return theme


def _style(root: tk.Tk, theme: Theme) -> None:
    px = theme.px
    style = ttk.Style(root)
    style.theme_use("clam")  # the only theme that accepts all colours on every system
    root.configure(background=BACKGROUND)
    root.option_add("*TCombobox*Listbox.font", theme.body)
    root.option_add("*TCombobox*Listbox.background", CARD)
    root.option_add("*TCombobox*Listbox.foreground", TEXT)
    root.option_add("*TCombobox*Listbox.selectBackground", ACCENT)
    root.option_add("*TCombobox*Listbox.selectForeground", CARD)
    style.configure(".", background=BACKGROUND, foreground=TEXT, font=theme.body, borderwidth=0, focuscolor=ACCENT)
    style.configure("TFrame", background=BACKGROUND)
    style.configure("Card.TFrame", background=CARD)
    style.configure("TLabel", background=BACKGROUND)
    style.configure("Card.TLabel", background=CARD)
    style.configure("Muted.TLabel", foreground=MUTED)
    style.configure("Note.TLabel", foreground=AMBER)
    style.configure("CardMuted.TLabel", background=CARD, foreground=MUTED, font=theme.small)
    style.configure("Title.TLabel", background=CARD, foreground=TEXT, font=theme.bold)

    flat: dict[str, Any] = {"relief": "flat", "borderwidth": px(1), "focusthickness": 0, "anchor": "center"}
    edge: dict[str, Any] = {"bordercolor": BORDER, "lightcolor": CARD, "darkcolor": CARD}
    style.configure("TButton", background=CARD, padding=(px(10), px(4)), **flat, **edge)
    style.configure("TButton", relief="raised")  # otherwise it has no border
    style.configure("Tiny.TButton", padding=(px(6), px(1)))
    style.map("TButton", background=[("pressed", TRACK), ("active", "#f5f7f9")], foreground=[("disabled", FAINT)])
    for name, color, active in (("Go", GREEN, "#116632"), ("Stop", RED, "#a51818"), ("Accent", ACCENT, "#1d4ed8")):
        style.configure(
            f"{name}.TButton", background=color, foreground="#ffffff", font=theme.bold, padding=(px(14), px(5)), **flat
        )
        style.configure(f"{name}.TButton", bordercolor=color, lightcolor=color, darkcolor=color)
        style.map(
            f"{name}.TButton",
            background=[("disabled", "#e6e9ed"), ("pressed", active), ("active", active)],
            foreground=[("disabled", "#9aa4af")],
            bordercolor=[("disabled", "#e6e9ed")],
            lightcolor=[("disabled", "#e6e9ed")],
            darkcolor=[("disabled", "#e6e9ed")],
        )
    style.configure("Accent.TButton", font=theme.body, padding=(px(10), px(4)))  # a button may turn into it
    # A row of these is one switch, and the chosen one is highlighted.
    style.configure("Segment.Toolbutton", background=CARD, foreground=MUTED, padding=(px(10), px(5)), **flat, **edge)
    style.map(
        "Segment.Toolbutton",
        background=[("selected", "#dbe6fe"), ("active", "#f5f7f9")],
        foreground=[("selected", "#1d4ed8")],
        lightcolor=[("selected", "#dbe6fe")],
        darkcolor=[("selected", "#dbe6fe")],
        bordercolor=[("selected", "#93b4fb")],
        font=[("selected", theme.bold)],
    )
    style.configure("Small.Segment.Toolbutton", padding=(px(8), px(2)), font=theme.small)
    style.configure(
        "TCombobox",
        fieldbackground=CARD,
        background=CARD,
        bordercolor=BORDER,
        lightcolor=CARD,
        darkcolor=CARD,
        arrowcolor=MUTED,
        arrowsize=px(14),
        padding=(px(6), px(3)),
        borderwidth=px(1),
    )
    style.map(
        "TCombobox",
        fieldbackground=[("readonly", CARD)],
        foreground=[("readonly", TEXT)],
        selectbackground=[("readonly", CARD)],
        selectforeground=[("readonly", TEXT)],
        bordercolor=[("focus", ACCENT)],
    )
    style.configure("Wide.TCombobox", postoffset=(-px(96), 0, px(96), 0))
    style.configure("TEntry", fieldbackground=CARD, bordercolor=BORDER, lightcolor=CARD, padding=px(2))
    style.configure("TScrollbar", background=FAINT, troughcolor=BACKGROUND, bordercolor=BACKGROUND, arrowsize=px(10))
    style.configure("TPanedwindow", background=BACKGROUND)
    style.configure("Sash", sashthickness=px(6), gripcount=0)


def fitting(text: str, font: tk_font.Font, room: float) -> str:
    """Return as much of a text as fits into a width, in pixels."""
    if font.measure(text) <= room:
        return text
    while text and font.measure(f"{text}…") > room:
        text = text[:-1]
    return f"{text.rstrip()}…"


def card(parent: tk.Misc, theme: Theme) -> tk.Frame:
    """Return a white frame with a thin border, for other widgets."""
    thin = theme.px(1)
    return tk.Frame(parent, background=CARD, highlightbackground=BORDER, highlightcolor=BORDER, highlightthickness=thin)
