"""The window: its layout, and the loop that draws it."""

from __future__ import annotations

import contextlib
import time
import tkinter as tk
from collections import deque
from tkinter import ttk
from types import TracebackType

from ....compat.c_calls import draw_sharp_text
from ....display import WITHOUT_DISPLAY
from ....errors import UsageError
from ....interruption import interruption
from ...engine.simulation import Simulation
from ...engine.snapshot import Snapshot, Status
from ..models.driver_station_keys import SUMMARY, DriverStationKeys
from ..models.joysticks import Joysticks, joystick_classes
from ..models.wording import status_texts
from .center_view import CenterView
from .column import ScrollingColumn
from .device_view import DeviceView
from .joystick_view import WIDTH as JOYSTICK_WIDTH
from .joystick_view import JoystickView
from .keys import DriveView, Keys
from .match_view import MatchView
from .station_bar import StationBar
from .theme import make_theme
from .time_bar import TimeBar
from .tooltip import Tooltip

#: The interval of drawing, in seconds.
_FRAME = 1 / 40
#: The status line changes at this interval, in frames, so that it can be read.
_STATUS_FRAMES = 6

#: The longest note that is shown, in characters; the tooltip shows all of it.
_MOST_NOTE = 90
#: In pixels of the design.
_WIDTH, _HEIGHT, _LEAST_WIDTH, _LEAST_HEIGHT = 1290, 696, 1000, 660


class Window:
    """Shows one simulation's snapshots, and passes on what the user does.

    :param screen: the X display, if not the one of the environment
    :raises UsageError: when there is no display
    :raises SettingsError: when the field's picture cannot be shown
    """

    def __init__(self, simulation: Simulation, screen: str | None = None) -> None:
        self._simulation = simulation
        self._project = simulation.project
        #: The number of frames that were drawn.
        self.frames = 0
        self._snapshot: Snapshot | None = None
        self._status: Status | None = None
        self._due, self._alarm = 0.0, ""
        #: The robot process that the state of the keys was sent to.
        self._starts = 0
        #: Messages of other threads that are not shown yet.
        self._announced: deque[str] = deque()
        #: The notes of the devices, the field and the simulation; and the one that is shown.
        self._notes, self._noted = ("",) * 3, ""
        #: An error in the window itself, or Ctrl+C.
        self.failure: BaseException | None = None
        self.root = root = _open(screen)
        root.report_callback_exception = self._on_exception
        try:
            self._build()
        except BaseException:
            root.destroy()
            raise
        root.protocol("WM_DELETE_WINDOW", root.quit)

    def _build(self) -> None:
        root, simulation = self.root, self._simulation
        root.title(f"{simulation.project.root.resolve().name} - pyfrc")
        theme = make_theme(root)
        px = theme.px
        width = min(px(_WIDTH), root.winfo_screenwidth())
        height = min(px(_HEIGHT), root.winfo_screenheight() - px(60))
        root.geometry(f"{width}x{height}")
        root.minsize(min(px(_LEAST_WIDTH), width), min(px(_LEAST_HEIGHT), height))
        self._tooltip = tooltip = Tooltip(root, theme)
        gap = px(8)
        self.station = StationBar(root, theme, tooltip, simulation, self.focus_field)
        self.station.frame.pack(side="top", fill="x", padx=gap, pady=gap)
        line = ttk.Frame(root)
        line.pack(side="bottom", fill="x", padx=px(12), pady=(0, px(5)))
        self._line = ttk.Label(line, style="Muted.TLabel", font=theme.small)
        self._line.pack(side="left")
        self._note = ttk.Label(line, text=SUMMARY, style="Muted.TLabel", font=theme.small, anchor="e")
        self._note.pack(side="right", fill="x", padx=(px(20), 0))
        self._note.bind("<Enter>", lambda event: tooltip.expect(self._noted, event.x_root, event.y_root))
        self._note.bind("<Leave>", lambda event: tooltip.hide())
        self.time = TimeBar(root, theme, tooltip, simulation, self.focus_field)
        self.time.frame.pack(side="bottom", fill="x", padx=gap, pady=(px(6), px(4)))

        middle = ttk.Frame(root)
        middle.pack(fill="both", expand=True, padx=gap)
        self.devices = DeviceView(middle, theme, tooltip, simulation, self.focus_field)
        self.devices.frame.pack(side="left", fill="y")
        self.column = ScrollingColumn(middle, theme, px(JOYSTICK_WIDTH + 2))
        self.column.frame.pack(side="right", fill="y")
        right = self.column.inside
        self.center = CenterView(middle, theme, tooltip, simulation)
        self.center.frame.pack(side="left", fill="both", expand=True, padx=gap)
        self.field, self.console = self.center.field, self.center.console

        self.sticks = Joysticks(simulation)
        self.match = MatchView(right, theme, tooltip, simulation, self.focus_field)
        self.match.frame.pack(side="top", fill="x")
        config = simulation.project.sim_config
        classes = joystick_classes(simulation.project)
        self.joystick = JoystickView(right, theme, tooltip, config, self.sticks, classes)
        self.joystick.frame.pack(side="top", fill="x", pady=(gap, 0))
        self._driving = keys = DriverStationKeys(simulation, self.sticks, close=root.quit)
        self._keys = Keys(root, keys)
        self.drive = DriveView(right, theme, keys, self.focus_field)
        self.drive.frame.pack(side="top", fill="x", pady=(gap, 0))
        self.focus_field()

    # -- the loop -------------------------------------------------------------------------------------------------

    def loop(self) -> None:
        """Show the simulation until the window is closed."""
        self.begin()
        with interruption.calling(self._interrupt):
            self.root.mainloop()
        if isinstance(self.failure, tk.TclError) and not self._exists():
            raise UsageError("the window was destroyed from outside") from None
        if self.failure is not None:
            raise self.failure

    def _exists(self) -> bool:
        try:
            return bool(self.root.winfo_exists())
        except tk.TclError:
            return False

    def begin(self) -> None:
        """Begin to draw, between other events."""
        self._stop_drawing()
        self._due = time.monotonic()
        self._frame()

    def close(self) -> None:
        """Destroy the window."""
        with contextlib.suppress(tk.TclError):  # the display has gone
            self._stop_drawing()
            self._tooltip.hide()
            self._keys.close()
            self.root.destroy()

    def _stop_drawing(self) -> None:
        if self._alarm:
            self.root.after_cancel(self._alarm)
            self._alarm = ""

    def announce(self, what: str) -> None:
        """Show an event among the robot's output. May be called from any thread."""
        self._announced.append(what)

    def focus_field(self) -> None:
        """Give the field the keyboard focus, so that keys drive."""
        self.field.canvas.focus_set()

    def _frame(self) -> None:
        self.draw()
        now = time.monotonic()
        self._due = max(self._due + _FRAME, now)
        self._alarm = self.root.after(max(round((self._due - now) * 1000), 1), self._frame)

    def draw(self) -> None:
        """Show the newest snapshot."""
        simulation = self._simulation
        snapshot, status = simulation.snapshot, simulation.status
        if status.state != "starting" and status.starts != self._starts:
            self._starts = status.starts
            self._driving.forget()
        while self._announced:
            self.console.mark(self._announced.popleft())
        self.console.show(status.failure)
        if snapshot is not self._snapshot or status is not self._status:
            self._show(snapshot, status)
        elif snapshot is not None and self.field.moved:
            self.field.show(snapshot, status)
        if self.frames % _STATUS_FRAMES == 0:
            self._show_status(snapshot, status)
        self.joystick.show()
        self.root.update_idletasks()
        self.frames += 1

    def _show(self, snapshot: Snapshot | None, status: Status) -> None:
        if self._simulation.project is not self._project:
            self._project = self._simulation.project
            self.devices.relabel(self._project.sim_config)
            self.joystick.relabel(self._project.sim_config)
        if snapshot is not None and snapshot is not self._snapshot:
            self.sticks.adopt(snapshot.values)
            self.field.show(snapshot, status)
            self.devices.show(snapshot)
            self.match.show(snapshot)
        self.station.show(snapshot, status)
        self.time.show(snapshot, status)
        changed = self._status is None or self._status.state != status.state
        if changed:
            self.center.make_space_for_traceback(status.state == "failed")
            if status.state == "starting":
                self.console.mark("the robot program starts again")
        self._snapshot, self._status = snapshot, status

    def _show_status(self, snapshot: Snapshot | None, status: Status) -> None:
        self._line.configure(text="   ·   ".join(status_texts(snapshot, status)))
        notes = self.devices.problem, self.field.problem, status.note
        if notes != self._notes:
            newer = [now for now, before in zip(notes, self._notes, strict=True) if now != before]
            self._notes = notes
            self._noted = note = " ".join(next((each for each in (*newer, *notes) if each), "").split())
            short = note if len(note) <= _MOST_NOTE else f"{note[:_MOST_NOTE]}…"
            self._note.configure(text=short or SUMMARY, style="Note.TLabel" if note else "Muted.TLabel")
        self.center.show_pose(None if snapshot is None else snapshot.scene.robot)

    def _on_exception(self, kind: type[BaseException], error: BaseException, traceback: TracebackType | None) -> None:
        # `loop` raises it.
        self.failure = error.with_traceback(traceback)
        self.root.quit()

    def _interrupt(self) -> None:
        self.failure = KeyboardInterrupt()
        self.root.quit()


def _open(screen: str | None) -> tk.Tk:
    draw_sharp_text()
    try:
        return tk.Tk(screenName=screen, className="pyfrc")
    except tk.TclError as wrong:
        raise UsageError(
            f"the window cannot be opened: {wrong}",
            remedy=WITHOUT_DISPLAY,
        ) from None
