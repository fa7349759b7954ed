"""A layout for the dashboard Elastic, as dashboards: each of its tabs becomes one.

What its parts mean is from Elastic's documentation, and from layouts that teams have published.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path as File
from typing import Any, NamedTuple

from ..errors import PyfrcError
from .dashboards import LONGEST_TEXT, MOST_CELLS, Kind

#: Where a project has it; robots serve their deploy directory.
ELASTIC_LAYOUT = File("deploy", "elastic-layout.json")

#: For each kind, the types of Elastic's widgets that show the same.
_TYPES: dict[Kind, tuple[str, ...]] = {
    "input": ("Text Display",),
    "text": ("Large Text Display",),
    "slider": ("Number Slider",),
    "gauge": ("Number Bar", "Radial Gauge", "Voltage View"),
    "graph": ("Graph",),
    "time": ("Match Time",),
    "lamp": ("Boolean Box",),
    "switch": ("Toggle Button", "Toggle Switch"),
    "color": ("Single Color View", "Multi Color View"),
    "camera": ("Camera Stream",),
    "chooser": ("ComboBox Chooser", "Split Button Chooser"),
    "command": ("Command",),
    "swerve": ("SwerveDrive",),
    "field": ("Field",),
    "gyro": ("Gyro",),
    "pid": ("PIDController", "ProfiledPIDController"),
    "power": ("PowerDistribution",),
    "alerts": ("Alerts",),
    "values": (
        *("3-Axis Accelerometer", "Accelerometer", "DifferentialDrive", "Encoder", "FMSInfo", "Motor Controller"),
        *("Relay", "RobotPreferences", "Subsystem", "Ultrasonic"),
    ),
}
_KINDS = {type_name: kind for kind, names in _TYPES.items() for type_name in names}
#: What Elastic takes where a layout does not say it.
_DEFAULTS: dict[str, Mapping[str, Any]] = {
    "Number Slider": {"min": -1.0, "max": 1.0},
    "Number Bar": {"min": -1.0, "max": 1.0},
    "Radial Gauge": {"min": 0.0, "max": 100.0},
    "Voltage View": {"min": 4.0, "max": 13.0, "unit": "V"},
    "Graph": {"seconds": 5.0},
}
#: Those of a single value, which a table may show.
_SINGLE = ("input", "text", "number", "slider", "gauge", "lamp", "switch", "color", "time")
#: The smallest grid: a single widget does not fill a screen.
_FEWEST_COLUMNS, _FEWEST_ROWS = 8, 4
_LIMITS = {"min_value": "min", "max_value": "max"}
_SETTINGS: dict[str, Mapping[str, str]] = {
    "slider": _LIMITS,
    "gauge": _LIMITS,
    "graph": {**_LIMITS, "time_displayed": "seconds"},
}


class ElasticLayout(NamedTuple):
    """What was found in a layout.

    :param dashboards: their contents, as in ``sim/dashboards.json``, by name
    :param missing: what they lack, each with its type, title and tab
    """

    dashboards: dict[str, dict[str, Any]]
    missing: list[str]


def read_elastic_layout(text: bytes, name: str) -> ElasticLayout:
    """Return the dashboards in a layout.

    :param name: of the layout, for errors
    :raises PyfrcError: when it is none
    """
    found = ElasticLayout({}, [])
    try:
        layout = json.loads(text)
        for tab in layout["tabs"]:
            grid = tab["grid_layout"]
            if given := [*grid["containers"], *grid.get("layouts", ())]:
                title = str(tab["name"]).strip()[:60] or "Elastic"
                if title in found.dashboards:
                    title = f"{title[:50]} {len(found.dashboards) + 1}"
                found.dashboards[title] = _dashboard(given, float(layout["grid_size"]), title, found.missing)
    except (ValueError, KeyError, TypeError, AttributeError, ArithmeticError, RecursionError):
        remedy = "Save it again in Elastic."
        raise PyfrcError("this is no layout of Elastic", where=name, remedy=remedy) from None
    if not found.dashboards:
        raise PyfrcError("this layout of Elastic has no widgets", where=name)
    return found


def _dashboard(given: list[Mapping[str, Any]], size: float, tab: str, missing: list[str]) -> dict[str, Any]:
    """Return a dashboard of these widgets. Their edges are rounded to cells, so that none covers another.

    :param size: of a cell, in the layout's pixels
    """
    edges = [
        (float(each["x"]), float(each["y"]), each["x"] + each["width"], each["y"] + each["height"]) for each in given
    ]
    wide = max(size, max(right for _, _, right, _ in edges) / MOST_CELLS)
    high = max(size, max(bottom for _, _, _, bottom in edges) / MOST_CELLS)
    widgets = []
    for each, (*start, right, bottom) in zip(given, edges, strict=True):
        kind, title = str(each["type"]), str(each["title"])
        x, y = round(start[0] / wide), round(start[1] / high)
        place = {"x": x, "y": y, "w": round(right / wide) - x, "h": round(bottom / high) - y}
        widget = _list(each, title, tab, missing) if kind == "List Layout" else _widget(kind, each["properties"])
        if widget is None or min(x, y) < 0 or min(place["w"], place["h"]) < 1:
            missing.append(f'{kind} "{title}" in {tab}')
        else:
            widgets.append({"title": title[:LONGEST_TEXT], **widget, **place})
    columns = max((each["x"] + each["w"] for each in widgets), default=0)
    rows = max((each["y"] + each["h"] for each in widgets), default=0)
    return {"columns": max(columns, _FEWEST_COLUMNS), "rows": max(rows, _FEWEST_ROWS), "widgets": widgets}


def _list(given: Mapping[str, Any], title: str, tab: str, missing: list[str]) -> dict[str, Any]:
    """Return a table of the values that are in a list."""
    topics = []
    for each in given["children"]:
        widget = _widget(each["type"], each["properties"])
        if widget is None or widget["kind"] not in _SINGLE:
            missing.append(f'{each["type"]} "{each["title"]}" in {title} in {tab}')
        else:
            topics.append(widget["topic"])
    return {"kind": "values", "more": topics}


def _widget(type_name: str, properties: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return a widget without title and place; None if there is none of this type."""
    topic = properties.get("topic")
    if type_name not in _KINDS or not isinstance(topic, str):
        return None
    kind = _KINDS[type_name]
    if kind == "text" and properties.get("data_type") in ("double", "float", "int"):
        kind = "number"
    widget = {"kind": kind, "topic": _topic(topic, properties), **_DEFAULTS.get(type_name, {})}
    for theirs, own in _SETTINGS.get(kind, {}).items():
        if (value := _number(properties.get(theirs))) is not None:
            widget[own] = value
    divisions = _number(properties.get("divisions"))
    if kind == "slider" and divisions and (step := (widget["max"] - widget["min"]) / divisions) > 0:
        widget["step"] = step
    if kind == "gyro" and properties.get("counter_clockwise_positive") is True:
        widget["counterclockwise"] = True
    return widget


def _topic(topic: str, properties: Mapping[str, Any]) -> str:
    """Return the topic, or the part of its struct that is shown, as dashboards name them."""
    parts = (properties.get("struct_meta") or {}).get("path", ())
    whole = "/".join((topic, *map(str, parts)))
    return (whole if whole.startswith("/") else f"nt:{whole}")[:LONGEST_TEXT]


def _number(value: Any) -> float | None:
    return float(value) if type(value) in (int, float) and math.isfinite(value) else None
