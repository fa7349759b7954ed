"""The device panels: a scrolling canvas, whose inputs are set by the mouse."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from ....config.sim import SimConfig
from ...engine.simulation import Simulation
from ...engine.snapshot import Snapshot
from ..models.devices import SETTABLE, DeviceRows, Row
from ..models.wording import shown_number, typed_number
from . import theme as colors
from .device_items import ITEMS, Item, RowPlace
from .theme import Theme
from .tooltip import Tooltip

#: The width, and the end of the labels, in pixels of the design.
WIDTH, _LABELS = 292, 150


class DeviceView:
    """Shows the devices that the robot has made.

    :param done: called when the user has typed a number, so that keys drive again
    """

    def __init__(
        self, parent: tk.Misc, theme: Theme, tooltip: Tooltip, simulation: Simulation, done: Callable[[], None]
    ) -> None:
        self._theme, self._tooltip, self._simulation, self._done = theme, tooltip, simulation, done
        self.frame = frame = colors.card(parent, theme)
        self.canvas = canvas = tk.Canvas(frame, background=colors.CARD, highlightthickness=0, width=theme.px(WIDTH))
        scrollbar = ttk.Scrollbar(frame, command=canvas.yview)
        canvas.configure(yscrollcommand=scrollbar.set, yscrollincrement=1)
        canvas.pack(side="left", fill="both", expand=True)
        scrollbar.pack(side="right", fill="y")
        self.rows = DeviceRows(simulation.project.sim_config)
        self.items: list[Item] = []
        self._held: Item | None = None
        self._editor: tk.Entry | None = None
        #: What is typed into, and the text that it began with.
        self._edited: tuple[Item, str] | None = None
        #: Why what was typed is refused, for the user.
        self.problem = ""
        self._hint = canvas.create_text(
            theme.px(WIDTH) // 2,
            theme.px(40),
            text="Motors and sensors appear here\nas the robot makes them.",
            justify="center",
            font=theme.body,
            fill=colors.MUTED,
        )
        self._bind()

    def show(self, snapshot: Snapshot) -> None:
        """Draw what has changed since the last one."""
        values = snapshot.values
        if self.rows.update(values):
            self._make_items()
        for item in self.items:
            if item is not self._held:
                item.look([values.get(path) for path in item.row.paths])

    def relabel(self, config: SimConfig) -> None:
        """Use other labels."""
        self.rows = DeviceRows(config)

    def center_of(self, row: Row) -> tuple[int, int]:
        """Return the pixel of the canvas, as it is scrolled, where a click sets a row."""
        item = next(item for item in self.items if item.row == row)
        return item.place.right - self._theme.px(14), item.place.y - round(self.canvas.canvasy(0))

    def _make_items(self) -> None:
        canvas, px = self.canvas, self._theme.px
        self._end_editing()
        self._held = None
        canvas.delete("all")
        self.items = []
        y, right = px(6), px(WIDTH - 10)
        for panel in self.rows.panels:
            y += px(4)
            canvas.create_text(px(12), y + px(9), text=panel.title, anchor="w", font=self._theme.bold, fill=colors.TEXT)
            canvas.create_line(px(12), y + px(20), right, y + px(20), fill=colors.BORDER)
            y += px(24)
            for row in panel.rows:
                make = ITEMS[row.kind]
                height = px(make.height)
                place = RowPlace(px(_LABELS), right, y + height // 2)
                self.items.append(make(canvas, self._theme, row, place))
                y += height
            y += px(4)
        canvas.configure(scrollregion=(0, 0, px(WIDTH), y + px(6)))

    # -- the mouse ------------------------------------------------------------------------------------------------

    def _bind(self) -> None:
        canvas = self.canvas
        canvas.bind("<Button-1>", self._press)
        canvas.bind("<B1-Motion>", self._drag)
        canvas.bind("<ButtonRelease-1>", self._release)
        canvas.bind("<Motion>", self._rest)
        canvas.bind("<Leave>", lambda event: self._tooltip.hide())
        canvas.bind("<MouseWheel>", lambda event: self._scroll(-1 if event.delta > 0 else 1))
        canvas.bind("<Button-4>", lambda event: self._scroll(-1))
        canvas.bind("<Button-5>", lambda event: self._scroll(1))

    def _scroll(self, way: int) -> None:
        self._tooltip.hide()  # another row is under the mouse
        self._end_editing()
        if self.canvas.yview() != (0.0, 1.0):
            self.canvas.yview_scroll(way * self._theme.px(48), "units")

    def _at(self, event: tk.Event[tk.Canvas]) -> Item | None:
        y = self.canvas.canvasy(event.y)
        half = self._theme.px(11)
        return next((item for item in self.items if item.row.paths and abs(item.place.y - y) <= half), None)

    def _rest(self, event: tk.Event[tk.Canvas]) -> None:
        item = self._at(event)
        self.canvas.configure(cursor="hand2" if item is not None and item.row.kind in SETTABLE else "")
        self._tooltip.expect("" if item is None else item.row.tooltip, event.x_root, event.y_root)

    def _press(self, event: tk.Event[tk.Canvas]) -> None:
        self._tooltip.hide()
        self._end_editing()
        item = self._at(event)
        snapshot = self._simulation.snapshot
        if item is None or snapshot is None or item.row.kind not in SETTABLE:
            return
        value = snapshot.values.get(item.row.paths[0])
        if item.row.kind == "switch":
            self._simulation.write({item.row.paths[0]: not value})
        elif item.row.kind == "number" or item.value_at(event.x) is None:
            self._edit(item, value)
        else:
            self._held = item
            self._drag(event)

    def _drag(self, event: tk.Event[tk.Canvas]) -> None:
        if self._held is not None:
            value = self._held.value_at(min(event.x, self._theme.px(WIDTH - 70)))
            self._held.look([value])
            self._simulation.write({self._held.row.paths[0]: value})

    def _release(self, event: tk.Event[tk.Canvas]) -> None:
        self._held = None

    # -- typing a number ------------------------------------------------------------------------------------------

    def _edit(self, item: Item, value: object) -> None:
        px, place = self._theme.px, item.place
        self._editor = editor = tk.Entry(
            self.canvas,
            font=self._theme.small,
            justify="right",
            width=9,
            relief="flat",
            highlightthickness=px(1),
            highlightcolor=colors.ACCENT,
        )
        text = shown_number(value) if isinstance(value, int | float) else str(value)
        self._edited = item, text
        editor.insert(0, text)
        editor.select_range(0, "end")
        self.canvas.create_window(place.right, place.y, anchor="e", window=editor, tags="editor")
        for key in ("<Return>", "<KP_Enter>", "<Tab>"):
            editor.bind(key, lambda event: self._end_editing())
        editor.bind("<FocusOut>", lambda event: self._end_editing(focused=False))
        editor.bind("<Escape>", lambda event: self._close_editor())
        editor.focus_set()

    def _end_editing(self, focused: bool = True) -> None:
        """Set what was typed, if it was edited and is right.

        :param focused: whether the keyboard is still on it
        """
        if self._editor is None or self._edited is None:
            return
        (item, before), text = self._edited, self._editor.get()
        self._close_editor(focused)
        self.problem = ""
        if text == before:
            return
        try:
            value = typed_number(text)
            if item.row.kind == "number" and item.row.decimals == 0 and not value.is_integer():
                raise ValueError(f"a whole number is needed, not {value:g}")
        except ValueError as wrong:
            self.problem = f"{item.row.label.strip()}: {wrong}."
        else:
            self._simulation.write({item.row.paths[0]: value})

    def _close_editor(self, focused: bool = True) -> None:
        if self._editor is not None:
            editor, self._editor = self._editor, None
            self.canvas.delete("editor")
            editor.destroy()
            if focused:
                self._done()
