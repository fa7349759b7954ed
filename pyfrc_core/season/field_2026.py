"""The 2026 field, REBUILT, with its structures seen from above.

Sizes are those of the game manual's section 5, "ARENA". Places are those of the AprilTags in WPILib's layout
``2026-rebuilt-welded``: a hub's tags are on its four sides, those of a trench in the middle of its opening, number 31
is in the middle of the blue tower, and 29 in that of the blue outpost. The distance of the depot from the middle is
that of the official field drawings, as teams have published it. All are in inches from the blue alliance's right
corner, x away from its wall, y to its left, as WPILib has them. The red half is the blue one turned by half a turn.

Not drawn: what the manual gives no size for, and what is only seen from the side.
"""

from __future__ import annotations

from .record import FieldPart, PartKind, SeasonField

_INCHES = 1 / 12  # in feet

#: The near side of hub, bumps and trenches from the alliance's wall, which is also the robots' starting line.
_NEAR = 158.6
_HUB = 47.0  # long and wide
_BUMP_WIDTH, _BUMP_DEPTH = 73.0, 44.4
_TRENCH_DEPTH, _OPENING = 47.0, 50.34
_TOWER_WIDTH, _TOWER_DEPTH, _TOWER_MIDDLE = 49.25, 45.0, 147.47
_UPRIGHT_FRONT, _UPRIGHT_INSIDE, _UPRIGHT_WIDTH, _UPRIGHT_DEPTH = 43.51, 32.25, 1.5, 3.5
_DEPOT_WIDTH, _DEPOT_DEPTH, _DEPOT_FROM_MIDDLE = 42.0, 27.0, 75.93
_OUTPOST_WIDTH, _OUTPOST_MIDDLE = 31.8, 26.22


def _structures(length: float, width: float) -> tuple[FieldPart, ...]:
    """Return the structures on a field of this size, in inches."""
    blue = list(_half(width))
    center = _part("center line", "line", "", (length / 2, 0), (length / 2, width), width)
    red = (
        FieldPart(part.name, part.kind, "red", tuple(_turned(point, length, width) for point in part.points))
        for part in blue
    )
    return (center, *blue, *red)


def _half(width: float) -> list[FieldPart]:
    middle = width / 2
    hub, bump = middle - _HUB / 2, middle - _HUB / 2 - _BUMP_WIDTH
    bump_near, bump_far = _NEAR + (_HUB - _BUMP_DEPTH) / 2, _NEAR + (_HUB + _BUMP_DEPTH) / 2
    upright = _UPRIGHT_INSIDE / 2

    def blue(
        name: str, kind: PartKind, near: tuple[float, float], far: tuple[float, float], mirrored: bool = False
    ) -> FieldPart:
        if mirrored:
            near, far = (near[0], width - near[1]), (far[0], width - far[1])
        return _part(name, kind, "blue", near, far, width)

    return [
        blue("starting line", "line", (_NEAR, 0), (_NEAR, width)),
        blue(
            "depot",
            "floor",
            (0, middle + _DEPOT_FROM_MIDDLE - _DEPOT_WIDTH / 2),
            (_DEPOT_DEPTH, middle + _DEPOT_FROM_MIDDLE + _DEPOT_WIDTH / 2),
        ),
        blue("tower", "floor", (0, _TOWER_MIDDLE - _TOWER_WIDTH / 2), (_TOWER_DEPTH, _TOWER_MIDDLE + _TOWER_WIDTH / 2)),
        *(
            blue(
                "",
                "solid",
                (_UPRIGHT_FRONT - _UPRIGHT_DEPTH, _TOWER_MIDDLE + side * upright),
                (_UPRIGHT_FRONT, _TOWER_MIDDLE + side * (upright + _UPRIGHT_WIDTH)),
            )
            for side in (-1, 1)
        ),
        blue("outpost", "line", (0, _OUTPOST_MIDDLE - _OUTPOST_WIDTH / 2), (0, _OUTPOST_MIDDLE + _OUTPOST_WIDTH / 2)),
        *(
            part
            for mirrored in (False, True)
            for part in (
                blue("trench", "arch", (_NEAR, 0), (_NEAR + _TRENCH_DEPTH, _OPENING), mirrored),
                # What carries it fills the space up to the bump.
                blue("", "solid", (_NEAR, _OPENING), (_NEAR + _TRENCH_DEPTH, bump), mirrored),
                blue("bump", "ramp", (bump_near, bump), (bump_far, hub), mirrored),
            )
        ),
        blue("hub", "solid", (_NEAR, hub), (_NEAR + _HUB, middle + _HUB / 2)),
    ]


def _part(
    name: str, kind: PartKind, alliance: str, near: tuple[float, float], far: tuple[float, float], width: float
) -> FieldPart:
    """Return a rectangle between two corners, or a line along x or y, in feet with y downwards."""
    (x1, y1), (x2, y2) = near, far
    corners = [(x1, y1), (x2, y2)] if kind == "line" else [(x1, y1), (x2, y1), (x2, y2), (x1, y2)]
    return FieldPart(name, kind, alliance, tuple((x * _INCHES, (width - y) * _INCHES) for x, y in corners))


def _turned(point: tuple[float, float], length: float, width: float) -> tuple[float, float]:
    return length * _INCHES - point[0], width * _INCHES - point[1]


#: The game manual: 54 ft 3 in by 26 ft 5 in.
FIELD_2026 = SeasonField(54.25, 26 + 5 / 12, parts=_structures(12 * 54 + 3, 12 * 26 + 5))
