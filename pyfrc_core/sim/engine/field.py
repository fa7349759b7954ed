"""The field of a project's simulations: from ``sim/config.json``, or the season's."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ...config.pictures import field_picture
from ...errors import UsageError, nearest
from ...physics.pose import METRES_PER_FOOT
from ...season import CURRENT, FIELDS
from .commands import ROBOT_ON_FIELD
from .scene import Field, Pose, Shape

if TYPE_CHECKING:
    from ...config.sim import Coordinates, FieldConfig, FieldObject
    from ...project import Project
    from ...season import FieldPart


def field_of(project: Project, coordinates: Coordinates = "pyfrc") -> Field:
    """Return the project's field, without tags.

    :param coordinates: how the page writes places where ``sim/config.json`` does not say
    :raises SettingsError: when ``sim/config.json`` is invalid
    """
    config = project.sim_config
    given = config.field.model_fields_set
    start = config.start
    starts = {start.name: Pose(start.x, start.y, math.radians(start.angle))}
    if len(config.robot.start_positions) > 1:
        starts |= {each.name: Pose(each.x, each.y, math.radians(each.angle)) for each in config.robot.start_positions}
    return Field(
        width=config.field.w,
        height=config.field.h,
        px_per_ft=config.field.px_per_ft,
        robot_width=config.robot.w,
        robot_length=config.robot.l,
        starts=starts,
        image=None if config.field.image is None else field_picture(project.root, config.field.image)[0],
        objects=tuple(_shape(each) for each in config.field.objects),
        coordinates=config.field.coordinates if "coordinates" in given else coordinates,
        parts=_season_parts(config.field),
    )


def _season_parts(config: FieldConfig) -> tuple[FieldPart, ...]:
    """Return the structures of the season's field; none of another field, or under a picture, which shows them."""
    season = FIELDS.get(config.season) if config.season else CURRENT.field
    if season is None or config.image is not None or (config.w, config.h) != (season.w, season.h):
        return ()
    return season.parts


def _shape(given: FieldObject) -> Shape:
    points = getattr(given, "points", None)
    if points is None:
        x, y, w, h = given.rect  # type: ignore[union-attr]
        points = ((x, y), (x + w, y), (x + w, y + h), (x, y + h))
    return Shape(given.color, tuple(points))


def start_named(field: Field, name: str | None) -> Pose:
    """Return one of the field's starts; the first, if no name is given.

    :raises UsageError: when no start has that name
    """
    if name is None:
        return next(iter(field.starts.values()))
    if name not in field.starts:
        raise UsageError(
            f"there is no start position {name!r}: {nearest(name, list(field.starts))}",
            where="sim/config.json: pyfrc.robot.start_positions",
        )
    return field.starts[name]


def robot_at(field: Field, pose: Pose) -> dict[str, list[float]]:
    """Return the write that puts the robot there: its place as WPILib has it."""
    x, y = pose.x * METRES_PER_FOOT, (field.height - pose.y) * METRES_PER_FOOT
    return {ROBOT_ON_FIELD: [x, y, -pose.angle if CURRENT.dashboards.in_radians else -math.degrees(pose.angle)]}
