"""The first message to a page: what stays the same, and the layout that the page has saved."""

from __future__ import annotations

import json
import re
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ...._version import __version__
from ....project import Project
from ....season import CURRENT
from ....text_files import keep_out_of_version_control, write_whole
from ...engine.messages import VALUE
from ...engine.source import Source
from ...logs.align import moment_of
from ..models.joysticks import FIRST_BUTTON, JOYSTICKS, MOST_BUTTONS, axis_labels, button_labels, joystick_classes
from ..models.keyboard import BUTTON_KEYS, BUTTON_KEYS_TEXT, ENABLE_CHORD, GENTLE, LAYOUTS, layout_for
from ..models.time_controls import FASTEST, SLOWEST
from ..models.wording import MODES, NO_OPMODE, STATIONS
from .dashboards import Dashboards

_BATTERY = re.compile(r"battery(_?volt(age|s))?$", re.IGNORECASE)
#: What is plotted first of a driver station's log, with its axis: volts, or a share.
_STATION_CURVES = tuple(
    (f"{VALUE}/DSLog/{name}", axis)
    for name, axis in (
        ("BatteryVoltage", "left"),
        ("PacketLoss", "right"),
        ("CANUtilization", "right"),
        ("Connected", "left"),
        ("Brownout", "left"),
    )
)
#: The version of the messages; a page of another version asks to be reloaded.
PROTOCOL = 1


def greeting(source: Source, client: int, read_only: bool, watching: bool = False) -> dict[str, Any]:
    """Return the message without the state.

    :param client: the number of the page
    :param read_only: whether the page cannot drive
    :param watching: whether saved files bring new code
    """
    project, abilities, recorded = source.project, source.abilities, source.recorded
    return {
        "type": "hello",
        "protocol": PROTOCOL,
        "client": client,
        "readonly": read_only,
        "version": __version__,
        "project": {
            "name": project.root.resolve().name if project.main_file.is_file() else "pyfrc view",
            "root": str(project.root.resolve()),
            "main": project.main_file.name,
        },
        "source": {
            "title": source.title,
            "when": None if source.when is None else source.when.isoformat(timespec="minutes"),
            "begins": None if recorded is None else moment_of(recorded.histories["network"], "match"),
            **asdict(abilities),
        },
        "options": _options(project, watching),
        "layout": load_layout(project.root) if abilities.drives else _looking(source, load_layout(project.root)),
        "dashboards": Dashboards(project.root).found(),
    }


def _options(project: Project, watching: bool) -> dict[str, Any]:
    """Return what a page offers: it depends on the project and the season."""
    config, dashboards, classes = project.sim_config, CURRENT.dashboards, joystick_classes(project)
    return {
        "watch": watching,
        "alliances": STATIONS,
        "game_messages": list(project.game_specific_messages),
        "modes": MODES,
        "no_opmode": NO_OPMODE,
        "dashboard": {
            "tables": [f"nt:{table}" for table in dashboards.tables],
            "robot": re.sub(r"^nt:.*:/", "nt:/", dashboards.robot_on_field),
            "choice": dashboards.choice,
            "publishing": dashboards.publishing,
        },
        "speeds": {"slowest": SLOWEST, "fastest": FASTEST},
        "joysticks": [
            {"axes": axis_labels(config, stick), "buttons": button_labels(config, stick, classes)}
            for stick in range(JOYSTICKS)
        ],
        "buttons": {"first": FIRST_BUTTON, "most": MOST_BUTTONS},
        "gamepad": asdict(CURRENT.gamepad),
        "keyboard": {
            "layouts": [
                {
                    "name": layout.name,
                    "help": layout.help,
                    "axes": {
                        key: [(*control, by) for control, by in moves.items()] for key, moves in layout.axes.items()
                    },
                }
                for layout in LAYOUTS
            ],
            "chosen": layout_for(config).name,
            "gentle": GENTLE,
            "button_keys": BUTTON_KEYS,
            "button_keys_text": BUTTON_KEYS_TEXT,
            "enable_chord": sorted(ENABLE_CHORD),
        },
    }


def _looking(source: Source, saved: Any) -> dict[str, Any]:
    """Return the arrangement of a page that cannot drive: that of driving is of little use."""
    layout = saved if isinstance(saved, dict) else {}
    if not source.abilities.over:
        return {"version": 1, **layout, "layout": source.abilities.kind}
    saved_plots = layout.get("plots")
    plots = saved_plots if isinstance(saved_plots, dict) else {}
    plots = {name: plot for name, plot in plots.items() if isinstance(plot, dict)}
    known = _paths(source)
    text = json.dumps(plots)
    if not any(json.dumps(path) in text for path in known):  # all are of another log, for which the page keeps them
        curves = plots.get("plot:1", {}).get("curves")
        plots = {**plots, "plot:1": {"curves": [*(curves if isinstance(curves, list) else ()), *_first_curves(source)]}}
    whole = {name: {**plot, "seconds": 0} for name, plot in plots.items()}
    return {**layout, "version": 1, "layout": "log", "plots": whole}


def _paths(source: Source) -> set[str]:
    recorded = source.recorded
    return set() if recorded is None else {path for each in recorded.histories.values() for path in each.paths()}


def _first_curves(source: Source) -> list[dict[str, object]]:
    """Return the battery's voltage, with which most questions about a match begin, and what a driver station logs."""
    histories = () if source.recorded is None else source.recorded.histories.values()
    named = {
        path: each for each in histories for path in each.paths() if path.startswith(VALUE) and _BATTERY.search(path)
    }
    found = [path for path, history in named.items() if type(history.now.get(path)) in (float, int)]
    found.sort(key=lambda path: ("volt" not in path.lower(), len(path)))
    own = [(path, "left") for path in found if path not in dict(_STATION_CURVES)][:1]
    curves = [*own, *(each for each in _STATION_CURVES if each[0] in _paths(source))]
    return [{"path": path, "axis": axis, "color": color} for color, (path, axis) in enumerate(curves)]


#: The largest layout, in characters of JSON.
MOST = 256 * 1024


def load_layout(root: Path) -> Any:
    """Return the saved layout; None if there is none that can be read."""
    try:
        file = _file(root).resolve()
        # Another file would be handed to those who look at the page.
        return json.loads(file.read_text("utf-8")) if file.is_relative_to(root.resolve()) else None
    except (OSError, ValueError, RuntimeError, RecursionError):
        return None


def save_layout(root: Path, changes: Any) -> None:
    """Save what a page has changed. What other pages have changed stays.

    :param changes: by name, the new values; of an object, its new values. None removes a value
    :raises ValueError: when it is no object, or the layout too large
    :raises OSError: when it cannot be written
    """
    if not isinstance(changes, dict):
        raise ValueError("a layout is one object")
    saved = load_layout(root)
    layout = dict(saved) if isinstance(saved, dict) else {}
    for name, value in changes.items():
        before = layout.get(name)
        layout[name] = _merged(before if isinstance(before, dict) else {}, value) if isinstance(value, dict) else value
    text = json.dumps(_merged(layout, {}), indent=1)
    if len(text) > MOST:
        raise ValueError(f"the layout has {len(text)} characters; at most {MOST} are saved")
    file = _file(root)
    file.parent.mkdir(exist_ok=True)
    keep_out_of_version_control(file.parent)
    write_whole(file, [text + "\n"])


def _merged(before: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in {**before, **changes}.items() if value is not None}


def _file(root: Path) -> Path:
    return root / ".pyfrc" / "sim-layout.json"
