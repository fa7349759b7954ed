"""One of the six joysticks, with controls that the mouse moves."""

from __future__ import annotations

import math
import tkinter as tk
from tkinter import ttk

from ....config.sim import SimConfig
from ..models.joysticks import (
    BUTTONS,
    FIRST_BUTTON,
    JOYSTICKS,
    RELEASED,
    Joysticks,
    axis_labels,
    button_labels,
    direction,
)
from . import theme as colors
from .theme import Theme, fitting
from .tooltip import Tooltip

#: In pixels of the design.
WIDTH, _PAD, _DIAL, _AXIS, _BUTTON = 288, 84, 60, 18, 18
#: The greatest width of the label of axis 1, beside the POV.
_LABEL = 100

_PAD_HELP = "Drag: axes 0 and 1. With the right button, it stays where you let it go."
_BUTTON_HELP = "Click: pressed while you hold it. Right click: stays pressed."

#: The control that the mouse holds: ``pad``, ``axis 3``, ``button 2``, ``pov``.
_Part = tuple[str, int]


class JoystickView:
    """Shows one joystick; the user chooses which of the six."""

    def __init__(
        self,
        parent: tk.Misc,
        theme: Theme,
        tooltip: Tooltip,
        config: SimConfig,
        sticks: Joysticks,
        classes: frozenset[str],
    ) -> None:
        self._theme, self._config, self._sticks, self._classes = theme, config, sticks, classes
        self._held: tuple[_Part, bool] | None = None
        self._shown: tuple[float, ...] = ()
        self._parts: list[tuple[_Part, tuple[float, float, float, float]]] = []
        px = theme.px
        self.frame = frame = colors.card(parent, theme)
        head = ttk.Frame(frame, style="Card.TFrame")
        head.pack(fill="x", padx=px(10), pady=(px(8), px(4)))
        ttk.Label(head, text="Joystick", style="Title.TLabel").pack(side="left", padx=(0, px(8)))
        self.chosen = tk.IntVar(frame, 0)
        for number in range(JOYSTICKS):
            ttk.Radiobutton(
                head,
                text=str(number),
                value=number,
                variable=self.chosen,
                command=self._make,
                style="Small.Segment.Toolbutton",
                takefocus=False,
            ).pack(side="left", padx=(0, px(2)))
        source = ttk.Frame(frame, style="Card.TFrame")
        source.pack(fill="x", padx=px(10))
        self._plug = ttk.Label(source, style="CardMuted.TLabel")
        self._plug.pack(side="left")
        ttk.Label(source, text="gamepads: --ui web", style="CardMuted.TLabel").pack(side="right")
        self.canvas = tk.Canvas(frame, background=colors.CARD, highlightthickness=0, width=px(WIDTH))
        self.canvas.pack(padx=px(0), pady=(px(4), px(6)))
        for sequence, keeps in (("<Button-1>", False), (f"<Button-{colors.RIGHT_BUTTON}>", True)):
            self.canvas.bind(sequence, lambda event, keeps=keeps: self._press(event, keeps))  # type: ignore[misc]
        self.canvas.bind("<B1-Motion>", self._drag)
        self.canvas.bind(f"<B{colors.RIGHT_BUTTON}-Motion>", self._drag)
        self.canvas.bind("<ButtonRelease-1>", self._release)
        self.canvas.bind(f"<ButtonRelease-{colors.RIGHT_BUTTON}>", self._release)
        self.canvas.bind("<Motion>", lambda event: tooltip.expect(self._help(event), event.x_root, event.y_root))
        self.canvas.bind("<Leave>", lambda event: tooltip.hide())
        self._make()

    def show(self) -> None:
        """Draw what has changed."""
        stick = self._sticks.sticks[self.chosen.get()]
        state = (*stick.axes, *stick.buttons, stick.pov, stick.plugged)
        if state != self._shown:
            self._shown = state
            self._draw()

    def relabel(self, config: SimConfig) -> None:
        """Use other labels."""
        self._config = config
        self._make()

    def center_of(self, part: _Part) -> tuple[int, int]:
        """Return the middle of a control, in the canvas's pixels."""
        x0, y0, x1, y1 = dict(self._parts)[part]
        return round((x0 + x1) / 2), round((y0 + y1) / 2)

    # -- drawing --------------------------------------------------------------------------------------------------

    def _make(self) -> None:
        canvas, px, stick = self.canvas, self._theme.px, self.chosen.get()
        canvas.delete("all")
        self._shown = ()
        self._parts = []
        self._axes = axis_labels(self._config, stick)
        names = button_labels(self._config, stick, self._classes)
        small, left = self._theme.small, px(12)
        y = px(4)
        self._add(("pad", 0), left, y, left + px(_PAD), y + px(_PAD))
        middle_x, middle_y = left + px(_PAD) / 2, y + px(_PAD) / 2
        canvas.create_rectangle(left, y, left + px(_PAD), y + px(_PAD), fill="#f5f7f9", outline=colors.BORDER)
        canvas.create_line(left, middle_y, left + px(_PAD), middle_y, fill=colors.BORDER)
        canvas.create_line(middle_x, y, middle_x, y + px(_PAD), fill=colors.BORDER)
        self._knob = canvas.create_oval(0, 0, 0, 0, fill=colors.ACCENT, outline=colors.CARD, width=px(2))
        text_x = left + px(_PAD + 10)
        self._xy = [
            canvas.create_text(text_x, y + px(middle), anchor="w", font=small, fill=fill)
            for middle, fill in zip((7, 21, 41, 55), (colors.TEXT, colors.MUTED) * 2, strict=True)
        ]
        for axis, item in zip((0, 1), self._xy[::2], strict=True):
            label = fitting(self._axes[axis], small, px(WIDTH - 12) - text_x if axis == 0 else px(_LABEL))
            canvas.itemconfigure(item, text=label)
        dial_x, dial_y, radius = px(WIDTH) - px(12 + _DIAL / 2), y + px(_PAD - _DIAL / 2), px(_DIAL / 2)
        self._add(("pov", 0), dial_x - radius, dial_y - radius, dial_x + radius, dial_y + radius)
        canvas.create_oval(
            dial_x - radius, dial_y - radius, dial_x + radius, dial_y + radius, fill="#f5f7f9", outline=colors.BORDER
        )
        self._rays = {}
        for angle in range(0, 360, 45):
            sin, cos = math.sin(math.radians(angle)), -math.cos(math.radians(angle))
            x, ray_y, r = dial_x + sin * radius * 0.72, dial_y + cos * radius * 0.72, px(5 if angle % 90 == 0 else 3)
            self._rays[angle] = canvas.create_oval(x - r, ray_y - r, x + r, ray_y + r, outline="", fill=colors.FAINT)
        canvas.create_text(dial_x, dial_y, text="POV", font=small, fill=colors.MUTED)
        y += px(_PAD + 10)
        self._bars = {}
        for axis, label in list(self._axes.items())[2:]:
            x0, x1, row = px(96), px(WIDTH - 52), y + px(_AXIS) // 2
            self._add(("axis", axis), x0 - px(6), y, x1 + px(6), y + px(_AXIS))
            canvas.create_text(left, row, text=fitting(label, small, px(72)), anchor="w", font=small, fill=colors.TEXT)
            canvas.create_line(x0, row, x1, row, fill=colors.TRACK, width=px(4), capstyle="round")
            canvas.create_line((x0 + x1) / 2, row - px(5), (x0 + x1) / 2, row + px(5), fill=colors.FAINT)
            knob = canvas.create_oval(0, 0, 0, 0, fill=colors.CARD, outline=colors.ACCENT, width=px(2))
            text = canvas.create_text(px(WIDTH - 12), row, anchor="e", font=small, fill=colors.MUTED)
            self._bars[axis] = knob, text, x0, x1, row
            y += px(_AXIS)
        y += px(6)
        self._lamps = {}
        half = px(WIDTH - 24) // 2
        rows = BUTTONS // 2
        for index in range(BUTTONS):
            button = FIRST_BUTTON + index
            column, row = divmod(index, rows)
            x, top = left + column * half, y + row * px(_BUTTON)
            self._add(("button", button), x, top, x + half, top + px(_BUTTON))
            size = px(_BUTTON - 4)
            lamp = canvas.create_rectangle(x, top + px(2), x + px(24), top + px(2) + size, outline=colors.BORDER)
            number = canvas.create_text(x + px(12), top + px(2) + size / 2, text=str(button), font=small)
            canvas.create_text(
                x + px(31),
                top + px(2) + size / 2,
                text=fitting(names.get(button, ""), small, half - px(34)),
                anchor="w",
                font=small,
                fill=colors.TEXT,
            )
            self._lamps[button] = lamp, number
        y += rows * px(_BUTTON)
        canvas.configure(height=y + px(2))

    def _add(self, part: _Part, x0: float, y0: float, x1: float, y1: float) -> None:
        self._parts.append((part, (x0, y0, x1, y1)))

    def _draw(self) -> None:
        canvas, px = self.canvas, self._theme.px
        stick = self._sticks.sticks[self.chosen.get()]
        self._plug.configure(text="Plugged in" if stick.plugged else "Not plugged in")
        x0, y0, x1, y1 = dict(self._parts)[("pad", 0)]
        r = px(8)
        reach = (x1 - x0) / 2 - r
        x, y = (x0 + x1) / 2 + stick.axes[0] * reach, (y0 + y1) / 2 + stick.axes[1] * reach
        canvas.coords(self._knob, x - r, y - r, x + r, y + r)
        for item, axis in zip(self._xy[1::2], (0, 1), strict=True):
            canvas.itemconfigure(item, text=f"{stick.axes[axis]:.2f}")
        r = px(6)
        for axis, (knob, text, left, right, row) in self._bars.items():
            x = left + (stick.axes[axis] + 1) / 2 * (right - left)
            canvas.coords(knob, x - r, row - r, x + r, row + r)
            canvas.itemconfigure(text, text=f"{stick.axes[axis]:.2f}")
        for button, (lamp, number) in self._lamps.items():
            pressed = stick.buttons[button]
            canvas.itemconfigure(lamp, fill=colors.ACCENT if pressed else "#f5f7f9")
            canvas.itemconfigure(number, fill=colors.CARD if pressed else colors.MUTED)
        for angle, ray in self._rays.items():
            canvas.itemconfigure(ray, fill=colors.ACCENT if angle == stick.pov else colors.FAINT)

    # -- the mouse ------------------------------------------------------------------------------------------------

    def _part_at(self, x: int, y: int) -> _Part | None:
        return next((part for part, (x0, y0, x1, y1) in self._parts if x0 <= x <= x1 and y0 <= y <= y1), None)

    def _help(self, event: tk.Event[tk.Canvas]) -> str:
        part = self._part_at(event.x, event.y)
        if part is None:
            return ""
        kind, number = part
        if kind == "pad":
            return f"{self._axes[0]}, {self._axes[1]}. {_PAD_HELP}"
        if kind == "axis":
            return f"Axis {number}: {self._axes[number]}. It stays where you let it go."
        if kind == "pov":
            return "Click: pressed that way while you hold it. Right click: stays pressed."
        name = button_labels(self._config, self.chosen.get(), self._classes).get(number)
        return f"Button {number}{f', {name}' if name else ''}. {_BUTTON_HELP}"

    def _press(self, event: tk.Event[tk.Canvas], keeps: bool) -> None:
        self.canvas.focus_set()
        part = self._part_at(event.x, event.y)
        if part is None:
            return
        stick = self.chosen.get()
        if part[0] == "button":
            pressed = not self._sticks.sticks[stick].buttons[part[1]] if keeps else True
            self._sticks.press(stick, part[1], pressed)
        elif part[0] == "pov" and keeps and self._sticks.sticks[stick].pov == self._direction(event):
            self._sticks.turn(stick, RELEASED)
            return
        self._held = part, keeps
        self._drag(event)

    def _direction(self, event: tk.Event[tk.Canvas]) -> int:
        x, y = self.center_of(("pov", 0))
        return direction(event.x - x, event.y - y)

    def _drag(self, event: tk.Event[tk.Canvas]) -> None:
        if self._held is None:
            return
        stick, (kind, number) = self.chosen.get(), self._held[0]
        if kind == "pad":
            x0, y0, x1, y1 = dict(self._parts)[("pad", 0)]
            reach = (x1 - x0) / 2 - self._theme.px(8)
            for axis, off in ((0, event.x - (x0 + x1) / 2), (1, event.y - (y0 + y1) / 2)):
                self._sticks.move(stick, axis, _snapped(off / reach))
        elif kind == "axis":
            _, _, left, right, _ = self._bars[number]
            self._sticks.move(stick, number, _snapped(2 * (event.x - left) / (right - left) - 1))
        elif kind == "pov":
            self._sticks.turn(stick, self._direction(event))

    def _release(self, event: tk.Event[tk.Canvas]) -> None:
        held, self._held = self._held, None
        if held is None or held[1]:
            return
        stick, (kind, number) = self.chosen.get(), held[0]
        if kind == "pad":
            for axis in (0, 1):
                self._sticks.move(stick, axis, 0.0)
        elif kind == "button":
            self._sticks.press(stick, number, False)
        elif kind == "pov":
            self._sticks.turn(stick, RELEASED)


def _snapped(value: float) -> float:
    """Return a position of an axis, which snaps to the middle."""
    value = round(min(max(value, -1.0), 1.0), 2)
    return 0.0 if abs(value) < 0.05 else value
