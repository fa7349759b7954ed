"""The season's field: its structures are where WPILib's AprilTags say, and only on a field of its size."""

from __future__ import annotations

import math
from typing import Any

import pytest

from pyfrc_core.project import find_project
from pyfrc_core.season import FIELDS, FieldPart
from pyfrc_core.sim.engine.field import field_of
from pyfrc_core.wpi import fields

METRE = 1 / 0.3048  # in feet
#: The parts of which these tags are, from the game manual: on the hub's four sides, over the trenches, at the tower.
HUBS = {2, 3, 4, 5, 8, 9, 10, 11, 18, 19, 20, 21, 24, 25, 26, 27}
TRENCHES = {1, 6, 7, 12, 17, 22, 23, 28}
#: The manual rounds to whole inches, and the layout is that of one of the two kinds of fields.
ROUNDING = 0.1


def box_of(part: FieldPart) -> tuple[float, float, float, float]:
    xs, ys = zip(*part.points, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def named(name: str) -> list[FieldPart]:
    return [part for part in FIELDS[2026].parts if part.name == name]


def outside(part: FieldPart, x: float, y: float) -> float:
    """Return how far a place is from a part's edge: negative inside."""
    left, top, right, bottom = box_of(part)
    return max(left - x, x - right, top - y, y - bottom)


def test_structures_are_where_the_tags_say() -> None:
    known = min(fields.tagged_fields("2026"), key=lambda each: abs(each.length * METRE - FIELDS[2026].w))
    tags = {tag.number: (tag.x * METRE, FIELDS[2026].h - tag.y * METRE) for tag in known.tags}
    for number in HUBS:
        assert min(abs(outside(hub, *tags[number])) for hub in named("hub")) < ROUNDING, number
    for number in TRENCHES:
        assert min(outside(trench, *tags[number]) for trench in named("trench")) < -1.5, number
    for alliance, number, outpost in (("blue", 31, 29), ("red", 15, 13)):
        tower = next(part for part in named("tower") if part.alliance == alliance)
        left, top, right, bottom = box_of(tower)
        assert math.isclose((top + bottom) / 2, tags[number][1], abs_tol=ROUNDING)
        assert min(abs(tags[number][0] - each) for each in (left, right)) < ROUNDING
        gate = next(part for part in named("outpost") if part.alliance == alliance)
        assert math.isclose(sum(y for _, y in gate.points) / 2, tags[outpost][1], abs_tol=ROUNDING)


def test_the_halves_are_alike_and_on_the_field() -> None:
    field = FIELDS[2026]
    both: dict[str, set[Any]] = {"blue": set(), "red": set()}
    for part in field.parts:
        assert all(0 <= x <= field.w and 0 <= y <= field.h for x, y in part.points), part
        if part.alliance:
            points = ((x, y) if part.alliance == "blue" else (field.w - x, field.h - y) for x, y in part.points)
            both[part.alliance].add((part.name, part.kind, *((round(x, 6), round(y, 6)) for x, y in points)))
    assert both["blue"] == both["red"]
    assert len(both["blue"]) == 13


@pytest.mark.filterwarnings("ignore::pyfrc_core.config.findings.SettingsWarning")
@pytest.mark.parametrize(
    ("config", "drawn"),
    [
        ("{}", True),
        ('{"season": 2026}', True),
        ('{"season": 2025}', False),
        ('{"w": 30, "h": 20}', False),
        ('{"image": "picture.png"}', False),
    ],
)
def test_other_fields_and_pictures_have_no_structures(make_project: Any, config: str, drawn: bool) -> None:
    project = make_project({"robot.py": "", "sim/config.json": f'{{"pyfrc": {{"field": {config}}}}}'})
    assert bool(field_of(find_project(project.path)).parts) is drawn
