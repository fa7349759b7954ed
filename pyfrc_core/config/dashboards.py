"""``sim/dashboards.json``: the dashboards that a team has arranged on the simulator's page.

A dashboard is a grid with widgets, each of which shows a topic. The file has one line for each widget, so that Git
can compare and merge it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path as File
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from ..errors import PyfrcError
from ..text_files import write_whole
from .findings import Path, dotted, finding_at, mistakes, settings_error
from .json_text import JsonText
from .sim import Array, Number

DASHBOARDS = File("sim", "dashboards.json")

#: What a widget may be.
Kind = Literal[
    "number",
    "text",
    "input",
    "lamp",
    "switch",
    "gauge",
    "slider",
    "gyro",
    "power",
    "color",
    "graph",
    "chooser",
    "pid",
    "values",
    "field",
    "mechanism",
    "swerve",
    "time",
    "state",
    "alerts",
    "command",
    "camera",
]

#: The largest grid, in columns or rows.
MOST_CELLS = 48

_Cell = Annotated[int, Field(strict=True, ge=0, lt=MOST_CELLS)]
_Cells = Annotated[int, Field(strict=True, ge=1, le=MOST_CELLS)]
#: The longest title and topic.
LONGEST_TEXT = 400
_Text = Annotated[str, Field(max_length=LONGEST_TEXT)]


class _DashboardPart(BaseModel):
    # A page that writes the file again must not lose what it does not know.
    model_config = ConfigDict(frozen=True, extra="forbid")


class Widget(_DashboardPart):
    """A widget, at a place of the grid."""

    kind: Kind = Field(description="What it is.")
    topic: _Text = Field(
        default="",
        description="What it shows: a topic such as /SmartDashboard/kP or a table such as /SmartDashboard/Arm in "
        "NetworkTables, or a path into hal_data.",
    )
    more: Annotated[tuple[_Text, ...], Array()] = Field(
        default=(),
        description="Further topics: of a graph its other curves; of a swerve drive what is wanted; of a table of "
        "values all of them.",
    )
    title: _Text = Field(default="", description="Its title. Default: the last part of the topic.")
    x: _Cell = Field(description="Its first column, from 0.")
    y: _Cell = Field(description="Its first row, from 0.")
    w: _Cells = Field(description="Its width, in columns.")
    h: _Cells = Field(description="Its height, in rows.")
    min: Number | None = Field(default=None, description="The lowest value of a gauge, a slider or a graph.")
    max: Number | None = Field(
        default=None,
        description="The highest value of a gauge, a slider or a graph; of a swerve drive its highest speed, in m/s.",
    )
    step: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0)] | None = Field(
        default=None, description="The steps of a slider. Default: about a hundredth of its range."
    )
    counterclockwise: Annotated[bool, Field(strict=True)] | None = Field(
        default=None, description="Whether the angle of a gyro is positive counterclockwise. Default: clockwise."
    )
    decimals: Annotated[int, Field(strict=True, ge=0, le=8)] | None = Field(
        default=None, description="The digits behind the point. Default: as many as the values need."
    )
    unit: Annotated[str, Field(max_length=20)] = Field(default="", description="The unit that is shown behind numbers.")
    seconds: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=3600)] | None = Field(
        default=None, description="How much time a graph shows, in seconds; 0: all."
    )


class Dashboard(_DashboardPart):
    """A grid of widgets, which fills the space that it is shown in."""

    columns: _Cells = Field(default=12, description="The columns of the grid.")
    rows: _Cells = Field(default=8, description="The rows of the grid.")
    widgets: Annotated[tuple[Widget, ...], Array()] = Field(default=(), description="Its widgets.")


class DashboardFile(_DashboardPart):
    """sim/dashboards.json of a robot project."""

    dashboards: Annotated[
        dict[Annotated[str, Field(min_length=1, max_length=60)], Dashboard],
        Array(),
    ] = Field(default={}, description="The dashboards by name.")


def load_dashboards(root: File) -> dict[str, Dashboard]:
    """Read ``sim/dashboards.json`` below the project's directory; no dashboards if there is no file.

    :raises SettingsError: with each mistake's line, key and value
    """
    file = root / DASHBOARDS
    try:
        file.lstat()
    except FileNotFoundError:
        return {}
    except OSError:
        pass  # the same is said below
    text = JsonText(file, DASHBOARDS.as_posix())
    repeated = [  # one of them would be lost when the file is written again
        finding_at(text, path, f"{dotted(path)} stands here again, after line {line}", "Merge the two, or rename one.")
        for path, line in text.repeated_keys()
    ]
    if repeated:
        raise settings_error(repeated)
    return _validated(text.value, text)


class ChangedMeanwhileError(PyfrcError):
    """A dashboard in the file is not the one that was seen before it was arranged."""


def save_dashboard(
    root: File,
    name: str,
    dashboard: Mapping[str, Any] | None,
    former_name: str | None = None,
    seen: Mapping[str, Mapping[str, Any] | None] | None = None,
) -> None:
    """Add, change, rename or remove a dashboard. What else the file has stays.

    :param dashboard: its content, as in the file; None removes it
    :param former_name: the name under which the file has it until now
    :param seen: what the file is supposed to have under these names, None for nothing
    :raises SettingsError: when the file or the dashboard has a mistake; the file stays as it is
    :raises ChangedMeanwhileError: when the file has something else there than what was seen; it stays as it is
    :raises OSError: when it cannot be written
    """
    given = {} if dashboard is None else _validated({"dashboards": {name: dashboard}}, _Given())
    before, after = load_dashboards(root), dict[str, Dashboard]()
    for each, supposed in (seen or {}).items():
        expected = {} if supposed is None else _validated({"dashboards": {each: supposed}}, _Given())
        if before.get(each) != expected.get(each):
            raise ChangedMeanwhileError(
                f'"{each}" has just been changed in {DASHBOARDS.as_posix()} by another page, an editor or Git.'
            )
    for each, content in before.items():
        if each in (former_name, name):
            after.update({key: value for key, value in given.items() if key not in after})
        else:
            after[each] = content
    write_whole(root / DASHBOARDS, [_as_text({**after, **given})])


class _Given:
    """A dashboard that a page has sent, as a `Document`."""

    name = "the dashboard"
    table = "an object"

    def line_of(self, path: Path) -> None:
        return None

    def excerpt(self, path: Path, value: object) -> str:
        return repr(value)[:60]


def _validated(data: Any, document: JsonText | _Given) -> dict[str, Dashboard]:
    try:
        return DashboardFile.model_validate(data).dashboards
    except ValidationError as invalid:
        raise settings_error(mistakes(invalid, data, document, known=_known(data))) from None


def _known(data: Any) -> dict[Path, list[str]]:
    """Return the keys that each object may have, by its path."""
    known: dict[Path, list[str]] = {(): list(DashboardFile.model_fields)}
    dashboards = data.get("dashboards") if isinstance(data, dict) else None
    for name, dashboard in dashboards.items() if isinstance(dashboards, dict) else ():
        known["dashboards", name] = list(Dashboard.model_fields)
        widgets = dashboard.get("widgets") if isinstance(dashboard, dict) else None
        for index, _ in enumerate(widgets if isinstance(widgets, list) else ()):
            known["dashboards", name, "widgets", index] = list(Widget.model_fields)
    return known


def _as_text(dashboards: Mapping[str, Dashboard]) -> str:
    blocks = []
    for name, dashboard in dashboards.items():
        widgets = [f"        {_json(widget.model_dump(exclude_defaults=True))}" for widget in dashboard.widgets]
        lines = (
            f"    {_json(name)}: {{",
            f'      "columns": {dashboard.columns},',
            f'      "rows": {dashboard.rows},',
            '      "widgets": [',
            ",\n".join(widgets),
            "      ]",
            "    }",
        )
        blocks.append("\n".join(filter(None, lines)))
    return "\n".join(filter(None, ("{", '  "dashboards": {', ",\n".join(blocks), "  }", "}"))) + "\n"


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)
