"""The field in the middle of the window: draws the scene, with zoom."""

from __future__ import annotations

import tkinter as tk
from typing import Any, Literal

from ....errors import SettingsError
from ....physics.pose import Pose
from ...engine.scene import Field, Point, Scene, Shape, Target
from ...engine.simulation import Simulation
from ...engine.snapshot import Snapshot, Status
from ..models.viewport import RobotDrag, Viewport, grid_lines, is_on_robot, robot_polygons, tag_marks
from ..models.wording import station_name
from . import theme as colors
from .drawings import Drawings
from .field_image import FieldImage
from .theme import Theme

_ZOOM_STEP = 1.2


class FieldView:
    """Draws scenes. Items are created once and then moved; all are placed again when the view changes."""

    def __init__(self, parent: tk.Misc, theme: Theme, simulation: Simulation) -> None:
        self._theme, self._simulation = theme, simulation
        self.canvas = canvas = tk.Canvas(parent, background=colors.BACKGROUND, highlightthickness=0, takefocus=True)
        field = simulation.field
        self._field = field
        self._image = None if field.image is None else FieldImage(canvas, field.image)
        self._image_problem = self._color_problem = ""
        self._picture: tk.PhotoImage | None = None
        self.view = Viewport.whole(field.width, field.height, 100, 100)
        #: Whether the view has changed since the field was drawn.
        self.moved = True
        self._robot: Pose | None = None
        self._bumpers = ""
        self._targets: tuple[Target, ...] = ()
        self._robot_drag: RobotDrag | None = None
        #: The pixel that the field was last dragged to.
        self._panned_from: tuple[int, int] | None = None
        px = theme.px
        self._former = _Trail(canvas, "trail", fill=colors.FORMER_TRAIL, width=px(2), dash=(6, 4))
        self._trail = _Trail(canvas, "trail", fill=colors.TRAIL, width=px(2))
        self._drawings = Drawings(canvas, theme)
        self._make_robot()
        self._draw_field()
        self._bind()

    @property
    def problem(self) -> str:
        """Why something could not be drawn; empty when everything was."""
        return self._image_problem or self._drawings.problem or self._color_problem

    def show(self, snapshot: Snapshot, status: Status) -> None:
        """Draw what has changed since the last one."""
        scene = snapshot.scene
        if scene.field is not self._field and scene.field != self._field:
            self._take_field(scene.field)
        if self.moved:
            self._place_all(scene)
        view = self.view
        self._former.show(status.former_trail, view)
        self._trail.show(scene.trail, view)
        if self._drawings.show(scene.drawings, view):
            self.canvas.tag_raise("over")
        if scene.targets != self._targets:
            self._draw_targets(scene.targets)
        if scene.robot != self._robot:
            self._place_robot(scene.robot)
        station = snapshot.values.get("alliance_station")
        bumpers = colors.BLUE_ALLIANCE if station_name(station).startswith("Blue") else colors.RED_ALLIANCE
        if bumpers != self._bumpers:
            self._bumpers = bumpers
            self.canvas.itemconfigure("bumpers", fill=bumpers)

    # -- the view -------------------------------------------------------------------------------------------------

    def see_whole(self) -> None:
        """Show the whole field."""
        self._see(Viewport.whole(self._field.width, self._field.height, self.view.width, self.view.height))

    def zoom(self, factor: float, x: float | None = None, y: float | None = None) -> None:
        """Zoom by a factor, towards a pixel or towards the middle."""
        view = self.view
        self._see(view.zoomed(factor, view.width / 2 if x is None else x, view.height / 2 if y is None else y))

    def _see(self, view: Viewport) -> None:
        if view != self.view:
            self.view, self.moved = view, True

    def _take_field(self, field: Field) -> None:
        if field.image != self._field.image:
            self._image_problem = ""
            try:
                self._image = None if field.image is None else FieldImage(self.canvas, field.image)
            except SettingsError as wrong:
                self._image, self._image_problem = None, str(wrong)
        former, self._field = self._field, field
        if (field.width, field.height) != (former.width, former.height):
            self.see_whole()
        self._draw_field()
        self.moved = True

    # -- fixed items ----------------------------------------------------------------------------------------------

    def _draw_field(self) -> None:
        canvas, px, field = self.canvas, self._theme.px, self._field
        canvas.delete("field")
        self._color_problem = ""
        self._fixed: list[tuple[int, tuple[tuple[float, float], ...]]] = []
        w, h = field.width, field.height

        def add(item: int, *points: tuple[float, float]) -> int:
            self._fixed.append((item, points))
            return item

        add(canvas.create_rectangle(0, 0, 0, 0, fill=colors.CARPET, outline="", tags="field"), (0, 0), (w, h))
        self._image_item = canvas.create_image(0, 0, anchor="nw", tags="field")
        if self._image is None:
            for ends in grid_lines(field):
                add(canvas.create_line(0, 0, 0, 0, fill=colors.GRID, tags="field"), *ends)
        for shape in field.objects:
            if len(shape.points) > 1:
                add(self._draw_shape(shape), *shape.points)
        edge = canvas.create_rectangle(0, 0, 0, 0, outline=colors.EDGE, width=px(2), tags="field")
        add(edge, (0, 0), (w, h))
        for tag in field.tags:
            ends, number = tag_marks(tag)
            add(canvas.create_line(0, 0, 0, 0, fill=colors.TEXT, width=px(3), tags="field"), *ends)
            text = canvas.create_text(
                0, 0, text=str(tag.number), font=self._theme.tiny, fill=colors.MUTED, tags="field"
            )
            add(text, number)
        canvas.tag_lower("field")

    def _draw_shape(self, shape: Shape) -> int:
        try:
            return self.canvas.create_polygon(*[0] * 2 * len(shape.points), fill=shape.color, tags="field")
        except tk.TclError:  # the shape is drawn all the same
            self._color_problem = f"sim/config.json: pyfrc.field.objects: no colour is called {shape.color!r}."
            return self.canvas.create_polygon(*[0] * 2 * len(shape.points), fill=colors.EDGE, tags="field")

    def _place_all(self, scene: Scene) -> None:
        self.moved = False
        view, canvas = self.view, self.canvas
        for item, points in self._fixed:
            canvas.coords(item, *view.line(points))
        if self._image is not None:
            seen = self._image.seen(view)
            self._picture = None if seen is None else seen[0]  # Tk does not keep it
            canvas.itemconfigure(self._image_item, image=self._picture or "")
            if seen is not None:
                canvas.coords(self._image_item, seen[1], seen[2])
        self._former.move(view)
        self._trail.move(view)
        self._drawings.move(view)
        self._draw_targets(scene.targets)
        self._place_robot(scene.robot)

    # -- moving items ---------------------------------------------------------------------------------------------

    def _make_robot(self) -> None:
        canvas, px, tags = self.canvas, self._theme.px, ("over", "robot")
        hidden = [0] * 8
        self._frame = canvas.create_polygon(
            *hidden, fill=colors.RED_ALLIANCE, outline="#3b4450", width=px(1), tags=(*tags, "bumpers"), state="hidden"
        )
        self._body = canvas.create_polygon(*hidden, fill="#f7f8fa", outline="", tags=tags, state="hidden")
        self._nose = canvas.create_polygon(*hidden[:6], fill="#39424e", outline="", tags=tags, state="hidden")

    def _place_robot(self, robot: Pose | None) -> None:
        was_there, self._robot = self._robot is not None, robot
        parts = self._frame, self._body, self._nose
        if robot is None:
            for item in parts:
                self.canvas.itemconfigure(item, state="hidden")
            return
        for item, corners in zip(parts, robot_polygons(self._field, robot), strict=True):
            self.canvas.coords(item, *self.view.line(corners))
            if not was_there:
                self.canvas.itemconfigure(item, state="normal")

    def _draw_targets(self, targets: tuple[Target, ...]) -> None:
        canvas, r = self.canvas, self._theme.px(6)
        self._targets = targets
        canvas.delete("target")
        for target in targets:
            x, y = self.view.to_screen(target.x, target.y)
            color = colors.LAMP_ON if target.in_view else colors.EDGE
            canvas.create_oval(x - r, y - r, x + r, y + r, outline=color, width=self._theme.px(2), tags="target")
            fill = color if target.in_view else ""
            canvas.create_oval(x - r / 2, y - r / 2, x + r / 2, y + r / 2, outline=color, fill=fill, tags="target")

    # -- the mouse ------------------------------------------------------------------------------------------------

    def _bind(self) -> None:
        canvas = self.canvas
        canvas.bind("<Configure>", self._resized)
        canvas.bind("<Button-1>", self._press)
        canvas.bind(f"<Button-{colors.RIGHT_BUTTON}>", self._press_to_turn)
        canvas.bind("<B1-Motion>", self._drag)
        canvas.bind(f"<B{colors.RIGHT_BUTTON}-Motion>", self._drag)
        canvas.bind("<ButtonRelease-1>", self._release)
        canvas.bind(f"<ButtonRelease-{colors.RIGHT_BUTTON}>", self._release)
        canvas.bind("<Double-Button-1>", lambda event: self.see_whole())
        canvas.bind(
            "<MouseWheel>", lambda event: self.zoom(_ZOOM_STEP ** (1 if event.delta > 0 else -1), event.x, event.y)
        )
        canvas.bind("<Button-4>", lambda event: self.zoom(_ZOOM_STEP, event.x, event.y))
        canvas.bind("<Button-5>", lambda event: self.zoom(1 / _ZOOM_STEP, event.x, event.y))

    def _resized(self, event: tk.Event[tk.Canvas]) -> None:
        self._see(self.view.resized(event.width, event.height))

    def _drag_of_robot(self, event: tk.Event[tk.Canvas], kind: Literal["move", "turn"]) -> RobotDrag | None:
        place = self.view.to_field(event.x, event.y)
        if self._robot is None or not is_on_robot(self._field, self._robot, place):
            return None
        return RobotDrag(self._simulation, self._robot, place, kind)

    def _press(self, event: tk.Event[tk.Canvas]) -> None:
        self.canvas.focus_set()
        self._robot_drag = self._drag_of_robot(event, "move")
        self._panned_from = (event.x, event.y) if self._robot_drag is None else None

    def _press_to_turn(self, event: tk.Event[tk.Canvas]) -> None:
        self._robot_drag = self._drag_of_robot(event, "turn")
        self._panned_from = None

    def _drag(self, event: tk.Event[tk.Canvas]) -> None:
        if self._panned_from is not None:
            x, y = self._panned_from
            self._panned_from = event.x, event.y
            self._see(self.view.panned(event.x - x, event.y - y))
        elif self._robot_drag is not None and self._robot is not None:
            self._robot_drag.drag(self._robot, self.view.to_field(event.x, event.y))

    def _release(self, event: tk.Event[tk.Canvas]) -> None:
        self._robot_drag = self._panned_from = None


#: The points of a piece of a trail.
_PIECE = 100


class _Trail:
    """A line on the canvas that grows at its end. It is in pieces: a new point does not redraw the whole line.

    :param options: of the canvas's lines
    """

    def __init__(self, canvas: tk.Canvas, tag: str, **options: Any) -> None:
        self._canvas, self._tag, self._options = canvas, tag, options
        self._points: tuple[Point, ...] = ()
        self._pieces: list[int] = []

    def show(self, points: tuple[Point, ...], view: Viewport) -> None:
        """Draw a line through these points."""
        if points is self._points:
            return
        before, self._points = self._points, points
        goes_on = 0 < len(before) <= len(points) and points[0] == before[0] and points[len(before) - 1] == before[-1]
        if goes_on and len(points) == len(before):
            return
        self._draw((len(before) - 1) // _PIECE if goes_on else 0, view)

    def move(self, view: Viewport) -> None:
        """Place the line for another part of the field."""
        self._draw(0, view)

    def _draw(self, first: int, view: Viewport) -> None:
        needed = (len(self._points) - 1 + _PIECE - 1) // _PIECE if len(self._points) > 1 else 0
        while len(self._pieces) > needed:
            self._canvas.delete(self._pieces.pop())
        for number in range(min(first, needed), needed):
            piece = view.line(self._points[number * _PIECE : (number + 1) * _PIECE + 1])
            if number < len(self._pieces):
                self._canvas.coords(self._pieces[number], *piece)
            else:
                item = self._canvas.create_line(*piece, tags=self._tag, capstyle="round", **self._options)
                self._pieces.append(item)
                if self._canvas.find_withtag("over"):
                    self._canvas.tag_lower(item, "over")
