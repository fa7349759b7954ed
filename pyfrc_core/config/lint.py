"""Find values in ``sim/config.json`` that are allowed but probably a mistake, most often in the wrong unit."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

from .findings import Path
from .sim import FieldConfig, SimConfig

#: Feet. Smaller than the robots of XRP and Romi kits.
_TINY = 0.5

_EIGHTHS = [eighth * pi / 4 for eighth in (*range(-8, 0), *range(1, 9))]


def lint(config: SimConfig) -> Iterator[tuple[Path, str]]:
    """Yield the paths of values in effect that are implausible, each with the reason."""
    robot, field = config.robot, config.field
    size = f"{field.w:g} by {field.h:g} ft"
    for name, length in (("w", robot.w), ("l", robot.l)):
        if length < _TINY:
            yield ("robot", name), "this is very small: is that in metres? Lengths are in feet"
        elif length > min(field.w, field.h):
            yield ("robot", name), f"the robot is larger than the field ({size}); lengths are in feet"
    at_start = {"x": robot.starting_x, "y": robot.starting_y, "angle": robot.starting_angle}
    yield from _of_start(("robot",), "starting_", at_start, field, size)
    for index, start in enumerate(robot.start_positions):
        place = {"x": start.x, "y": start.y, "angle": start.angle}
        yield from _of_start(("robot", "start_positions", index), "", place, field, size)


def _of_start(
    path: Path, prefix: str, start: dict[str, float], field: FieldConfig, size: str
) -> Iterator[tuple[Path, str]]:
    for name, most in (("x", field.w), ("y", field.h)):
        if not 0 <= start[name] <= most:
            yield (*path, prefix + name), f"this is off the field ({size})"
    if _looks_like_radians(start["angle"]):
        yield (*path, f"{prefix}angle"), "this looks like radians; angles are in degrees"


def _looks_like_radians(angle: float) -> bool:
    """Return whether this is a multiple of an eighth of a turn as people write it: 0.785, 1.57, 3.14."""
    if angle == round(angle, 1):  # 5.5 is near an eighth too, but no one rounds so roughly
        return False
    return any(abs(angle - eighth) < 1e-3 or angle == round(eighth, 2) for eighth in _EIGHTHS)
