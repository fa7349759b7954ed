"""The window's middle: the field above, the robot's output below, and a sash between them."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from ....physics.pose import Pose
from ...engine.simulation import Simulation
from ..models.wording import pose_text
from . import theme as colors
from .console_view import ConsoleView
from .field_view import FieldView
from .theme import Theme
from .tooltip import Tooltip

#: The field's share of the height, and the least share of a traceback.
_FIELD_SHARE, _TRACEBACK_SHARE = 0.72, 0.45
#: The zoom factor of the buttons.
_ZOOM = 1.5

_HELP = (
    "The wheel comes nearer, dragging the field moves it, a double click shows it whole. "
    "Drag the robot to put it elsewhere; drag it with the right button to turn it."
)


class CenterView:
    """Field and console, with a sash between them."""

    def __init__(self, parent: tk.Misc, theme: Theme, tooltip: Tooltip, simulation: Simulation) -> None:
        self.frame = frame = ttk.PanedWindow(parent, orient="vertical")
        card = colors.card(frame, theme)
        self.field = FieldView(card, theme, simulation)
        self._make_bar(card, theme, tooltip)
        self.field.canvas.pack(fill="both", expand=True)
        self.console = ConsoleView(frame, theme, simulation)
        frame.add(card, weight=4)
        frame.add(self.console.frame, weight=1)
        #: The sash's place before a traceback needed space.
        self._former_sash = 0
        self._shared = False
        frame.bind("<Configure>", self._share)

    def show_pose(self, robot: Pose | None) -> None:
        """Show the robot's place."""
        self._pose.configure(text=pose_text(robot))

    def make_space_for_traceback(self, failed: bool) -> None:
        """Make the console higher when the robot has failed, and as high as before afterwards."""
        if failed:
            self._former_sash = self._sash()
            self._move_sash(min(self._former_sash, round(self.frame.winfo_height() * (1 - _TRACEBACK_SHARE))))
        elif self._former_sash:
            self._move_sash(self._former_sash)
            self._former_sash = 0

    def _make_bar(self, card: tk.Frame, theme: Theme, tooltip: Tooltip) -> None:
        px, field = theme.px, self.field
        bar = tk.Frame(card, background=colors.CARD)
        bar.pack(side="bottom", fill="x")
        self._pose = ttk.Label(bar, style="CardMuted.TLabel")
        self._pose.pack(side="left", padx=px(10), pady=px(3))
        for text, act in (
            ("Fit", field.see_whole),
            ("+", lambda: field.zoom(_ZOOM)),
            ("-", lambda: field.zoom(1 / _ZOOM)),
        ):
            button = ttk.Button(bar, text=text, width=3, command=act, style="Tiny.TButton", takefocus=False)
            button.pack(side="right", padx=(0, px(4)), pady=px(3))
        how = ttk.Label(bar, style="CardMuted.TLabel", text="?")
        how.pack(side="right", padx=px(10))
        tooltip.attach(how, _HELP)

    def _share(self, event: tk.Event[tk.Misc]) -> None:
        if not self._shared:  # later, the user may have moved the sash
            self._shared = True
            self._move_sash(round(event.height * _FIELD_SHARE))

    # tkinter's own method for it is typed as Any.
    def _sash(self) -> int:
        return int(self.frame.tk.call(str(self.frame), "sashpos", 0))

    def _move_sash(self, y: int) -> None:
        self.frame.tk.call(str(self.frame), "sashpos", 0, y)
