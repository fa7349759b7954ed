"""The rows of the device panels on a canvas: a class for each `RowKind`, in the table `ITEMS`.

Each row is created once; `show` updates what has changed.
"""

from __future__ import annotations

import tkinter as tk
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ....hal.fields import RowKind
from ..models.devices import Row
from ..models.wording import number_text, shown_number
from . import theme as colors
from .theme import Theme, fitting

_MOST_LEDS = 48


@dataclass(frozen=True)
class RowPlace:
    """The place of a row on its canvas, in pixels: its value is between `left` and `right`."""

    left: int
    right: int
    y: int


class Item:
    """One row. This class shows a text, or a title without a value."""

    #: The height of the row and the width of its value, in pixels of the design.
    height, value_room = 22, 96

    def __init__(self, canvas: tk.Canvas, theme: Theme, row: Row, place: RowPlace) -> None:
        self.row, self.place = row, place
        self._canvas, self._theme = canvas, theme
        self._shown: Any = self  # nothing equals it
        label = row.label.rstrip()
        indent = theme.px(12) if label.startswith("   ") else 0
        canvas.create_text(
            theme.px(12) + indent,
            place.y,
            text=fitting(label.strip(), theme.body, self._label_room() - indent),
            anchor="w",
            font=theme.body,
            fill=colors.TEXT,
        )
        self._make()

    def look(self, values: Sequence[object]) -> None:
        """Show these values, one for each of the row's paths."""
        if values != self._shown:
            self._shown = values
            self.show(values)

    def show(self, values: Sequence[object]) -> None:
        value = values[0] if values else ""
        text = shown_number(value) if isinstance(value, float) else str(value)
        self._canvas.itemconfigure(self._text, text=_shortened(text, 22))

    def value_at(self, x: int) -> float | None:
        """Return the value that a click or drag at this pixel sets, if the row is a slider."""
        return None

    def _label_room(self) -> int:
        """Return the greatest width of the label, in pixels."""
        whole = self.place.right - self._theme.px(12)
        return whole - self._theme.px(self.value_room) if self.row.paths else whole

    def _make(self) -> None:
        self._text = self._value_text(self.place.right)

    def _value_text(self, right: int, color: str = colors.MUTED) -> int:
        return self._canvas.create_text(right, self.place.y, anchor="e", font=self._theme.small, fill=color)

    def _rectangles(self, before: list[int], count: int) -> list[int]:
        """Return this many rectangles of the canvas; those that are there stay if their number is right."""
        if len(before) == count:
            return before
        for item in before:
            self._canvas.delete(item)
        return [self._canvas.create_rectangle(0, 0, 0, 0, outline="") for _ in range(count)]

    def _number(self, value: object) -> str:
        return self._with_unit(number_text(value, self.row.decimals)) if isinstance(value, int | float) else str(value)

    def _with_unit(self, number: str) -> str:
        return number + (f" {self.row.unit}" if self.row.unit not in ("", "°") else self.row.unit)


class Bar(Item):
    """A number as the length of a bar; the class for meters and sliders."""

    def _make(self) -> None:
        px, place = self._theme.px, self.place
        self._left, self._right = place.left, place.right - px(52)
        self._track = self._canvas.create_rectangle(
            self._left, place.y - px(5), self._right, place.y + px(5), fill=colors.TRACK, outline=""
        )
        self._fill = self._canvas.create_rectangle(0, 0, 0, 0, outline="")
        if self.row.low < 0:
            zero = self._pixel(0.0)
            self._canvas.create_line(zero, place.y - px(7), zero, place.y + px(7), fill=colors.FAINT)
        self._text = self._value_text(place.right)
        self._color = ""

    def _label_room(self) -> int:
        return self.place.left - self._theme.px(20)

    def _pixel(self, value: float) -> float:
        low, high = self.row.low, self.row.high
        share = (min(max(value, low), high) - low) / (high - low)
        return self._left + share * (self._right - self._left)

    def show(self, values: Sequence[object]) -> None:
        value = values[0] if isinstance(values[0], int | float) else 0.0
        y, half = self.place.y, self._theme.px(5)
        zero, end = self._pixel(0.0), self._pixel(value)
        color = self._color_of(value)
        if color != self._color:
            self._color = color
            self._canvas.itemconfigure(self._fill, fill=color)
        self._canvas.coords(self._fill, min(zero, end), y - half, max(zero, end), y + half)
        self._canvas.itemconfigure(self._text, text=self._number(values[0]))

    def _color_of(self, value: float) -> str:
        return colors.BACKWARDS if value < 0 else colors.FORWARDS


class SliderItem(Bar):
    """An input that is set by dragging."""

    def _make(self) -> None:
        super()._make()
        px, y = self._theme.px, self.place.y
        self._canvas.coords(self._track, self._left, y - px(2), self._right, y + px(2))
        self._knob = self._canvas.create_oval(0, 0, 0, 0, fill=colors.CARD, outline=colors.ACCENT, width=px(2))

    def show(self, values: Sequence[object]) -> None:
        super().show(values)
        y, r = self.place.y, self._theme.px(6)
        value = values[0] if isinstance(values[0], int | float) else 0.0
        zero, x = self._pixel(0.0), self._pixel(value)
        self._canvas.coords(self._fill, min(zero, x), y - r / 3, max(zero, x), y + r / 3)
        self._canvas.coords(self._knob, x - r, y - r, x + r, y + r)

    def value_at(self, x: int) -> float | None:
        if x > self._right + self._theme.px(8):
            return None
        share = min(max((x - self._left) / (self._right - self._left), 0.0), 1.0)
        return round(self.row.low + share * (self.row.high - self.row.low), self.row.decimals)

    def _color_of(self, value: float) -> str:
        return colors.ACCENT


class Number(Item):
    """An input that is typed."""

    def _make(self) -> None:
        px, place = self._theme.px, self.place
        box = place.right - px(96), place.y - px(9), place.right, place.y + px(9)
        self._canvas.create_rectangle(*box, fill="#f5f7f9", outline=colors.BORDER)
        self._text = self._value_text(place.right - px(6), colors.TEXT)

    def show(self, values: Sequence[object]) -> None:
        self._canvas.itemconfigure(self._text, text=self._number(values[0]))

    def _number(self, value: object) -> str:
        return self._with_unit(shown_number(value)) if isinstance(value, int | float) else str(value)


class Lamp(Item):
    """An output that is on or off."""

    value_room = 76

    def _make(self) -> None:
        r, x, y = self._theme.px(6), self.place.right - self._theme.px(7), self.place.y
        self._lamp = self._canvas.create_oval(x - r, y - r, x + r, y + r, outline="")
        self._text = self._value_text(x - self._theme.px(14))

    def show(self, values: Sequence[object]) -> None:
        on = bool(values[0])
        self._canvas.itemconfigure(self._lamp, fill=colors.LAMP_ON if on else colors.LAMP_OFF)
        self._canvas.itemconfigure(self._text, text="on" if on else "off")


class Switch(Item):
    """An input that is switched by a click."""

    value_room = 76

    def _make(self) -> None:
        px, y = self._theme.px, self.place.y
        self._r = r = px(7)
        self._off, self._on = self.place.right - px(26) + r - px(1), self.place.right - r
        self._body = self._canvas.create_line(self._off, y, self._on, y, width=2 * r, capstyle="round")
        self._knob = self._canvas.create_oval(0, 0, 0, 0, fill=colors.CARD, outline="")
        self._text = self._value_text(self._off - r - px(8))

    def show(self, values: Sequence[object]) -> None:
        on, y, r = bool(values[0]), self.place.y, self._r - self._theme.px(2)
        x = self._on if on else self._off
        self._canvas.itemconfigure(self._body, fill=colors.ACCENT if on else colors.FAINT)
        self._canvas.coords(self._knob, x - r, y - r, x + r, y + r)
        self._canvas.itemconfigure(self._text, text="true" if on else "false")


class Relay(Item):
    """Two directions: forward, reverse, both or none."""

    def _make(self) -> None:
        px, right, y = self._theme.px, self.place.right, self.place.y
        tip, back = px(6), px(5)
        self._ways = [
            self._canvas.create_polygon(x, y - back, x, y + back, x + way * tip * 1.5, y, outline="")
            for x, way in ((right - px(10), 1), (right - px(16), -1))
        ]
        self._text = self._value_text(right - px(34))

    def show(self, values: Sequence[object]) -> None:
        forward, reverse = bool(values[0]), bool(values[1])
        for item, on, color in zip(self._ways, (forward, reverse), (colors.FORWARDS, colors.BACKWARDS), strict=True):
            self._canvas.itemconfigure(item, fill=color if on else colors.LAMP_OFF)
        text = "on" if forward and reverse else "forward" if forward else "reverse" if reverse else "off"
        self._canvas.itemconfigure(self._text, text=text)


class Lamps(Item):
    """The solenoids of a module, numbered from 0."""

    height = 34

    def _make(self) -> None:
        px, y = self._theme.px, self.place.y
        count = len(self.row.paths)
        apart = min(px(22), (self.place.right - self.place.left + px(52)) // max(count, 1))
        r = min(px(6), apart // 2 - 1)
        self._lamps = []
        for number in range(count):
            x = self.place.right - r - (count - 1 - number) * apart
            lamp = self._canvas.create_oval(
                x - r, y - px(6) - r, x + r, y - px(6) + r, outline="", fill=colors.LAMP_OFF
            )
            self._lamps.append(lamp)
            if apart >= px(14) or number % 2 == 0:  # sixteen numbers do not fit
                text = str(number)
                self._canvas.create_text(x, y + px(8), text=text, font=self._theme.tiny, fill=colors.MUTED)
        self._lit: list[bool] = [False] * count

    def show(self, values: Sequence[object]) -> None:
        for number, value in enumerate(values):
            if bool(value) != self._lit[number]:
                self._lit[number] = bool(value)
                fill = colors.LAMP_ON if value else colors.LAMP_OFF
                self._canvas.itemconfigure(self._lamps[number], fill=fill)


class Bars(Item):
    """A list of numbers, as bars side by side, and their sum."""

    def _make(self) -> None:
        self._bars: list[int] = []
        super()._make()

    def show(self, values: Sequence[Any]) -> None:
        numbers = [value for value in values[0] if isinstance(value, int | float)]
        left, right, foot = self.place.left, self.place.right - self._theme.px(52), self.place.y + self._theme.px(8)
        self._bars = self._rectangles(self._bars, len(numbers))
        each = (right - left) / max(len(numbers), 1)
        for number, (item, value) in enumerate(zip(self._bars, numbers, strict=True)):
            high = max(min(abs(value) / self.row.high, 1.0) * self._theme.px(16), 1)
            x = left + number * each
            self._canvas.coords(item, x, foot - high, x + max(each - 1, 1), foot)
            self._canvas.itemconfigure(item, fill=colors.ACCENT if value else colors.FAINT)
        self._canvas.itemconfigure(self._text, text=self._number(sum(numbers)))


class Leds(Item):
    """The first LEDs of a strip."""

    def _make(self) -> None:
        self._leds: list[int] = []

    def show(self, values: Sequence[Any]) -> None:
        strip = list(values[0])[:_MOST_LEDS]
        left, right, y, half = self.place.left, self.place.right, self.place.y, self._theme.px(6)
        self._leds = self._rectangles(self._leds, len(strip))
        each = min((right - left) / max(len(strip), 1), 2 * half)
        start = right - each * len(strip)
        for number, (item, color) in enumerate(zip(self._leds, strip, strict=True)):
            self._canvas.coords(item, start + number * each, y - half, start + (number + 1) * each, y + half)
            self._canvas.itemconfigure(item, fill="#{:02x}{:02x}{:02x}".format(*(int(part) & 255 for part in color)))


#: The class that draws each kind of row.
ITEMS: dict[RowKind, type[Item]] = {
    "meter": Bar,
    "slider": SliderItem,
    "number": Number,
    "lamp": Lamp,
    "switch": Switch,
    "relay": Relay,
    "lamps": Lamps,
    "bars": Bars,
    "leds": Leds,
    "text": Item,
}


def _shortened(text: str, most: int) -> str:
    text = text.replace("\n", " ")
    return text if len(text) <= most else text[: most - 1] + "…"
