"""A whole run as one HTML file, which opens without pyfrc and without a network."""

from __future__ import annotations

import gzip
import re
import sys
import sysconfig
from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from datetime import datetime
from pathlib import Path
from typing import Any

from ....config.pictures import field_picture
from ...engine.snapshot import Failure
from ...engine.source import Abilities, Source
from .collector import Collector
from .greeting import greeting, load_layout
from .messages import json_text
from .single_file import data_url, single_file
from .updates import UpdateBuilder

#: What a person has arranged that is of use to others.
_OF_USE = ("version", "plots", "pins", "fieldLayers", "fieldRobot", "coordinates")
#: The number of curves that are suggested where the person has arranged no plot.
_SUGGESTED = 3


def recorded_page(source: Source, collector: Collector, what: str, seen: Failure | None = None) -> str:
    """Return the page of a run that is over.

    :param collector: has followed the source, and has ended
    :param what: the command that ran it
    :param seen: the failure, if it is none that the simulation knows
    """
    while collector.look():  # what came after its last look
        pass
    failure = seen or collector.state.status.failure
    shown = replace(
        collector.state.status,
        state="failed" if failure is not None else "paused",
        failure=failure,
        network_address=None,
        responding=True,
    )
    if seen is not None:
        collector.marks.add(seen.time, "failure", seen.headline)
        collector.console.say(f"failed: {seen.headline}", seen.time, "error")
    branches = tuple(branch for branch in collector.runs.branches if not branch.is_former)
    collector.state = replace(collector.state, status=shown, branches=branches, wants_to_run=False)
    clean = cleaner(collector.root)
    run: dict[str, Any] = {
        "hello": _cleaned(_hello(source, collector, what), clean),
        **collector.runs.packed(clean),
        "branches": [
            branch.plain()
            | branch.packed(clean)
            | {"difference": collector.runs.plain_difference(branch.number, clean=clean)}
            for branch in branches
        ],
    }
    return single_file("A recorded run - pyfrc", gzip.compress(json_text(run).encode(), 9, mtime=0))


def _hello(source: Source, collector: Collector, what: str) -> dict[str, Any]:
    found = {**greeting(source, 1, True), **UpdateBuilder(collector, "").update(1)}
    name = source.project.sim_config.field.image
    image = None if name is None else field_picture(source.project.root, name)[0]
    try:
        found["field"] |= {"image": None if image is None else data_url(image)}
    except OSError:  # it is gone
        found["field"] |= {"image": None}
    found["project"] |= {"root": ""}
    when = source.when or datetime.now().astimezone()
    found["source"] |= {
        "title": what,
        "when": when.isoformat(timespec="minutes"),
        **asdict(Abilities(source.abilities.kind, over=True)),
    }
    if source.abilities.drives:
        found["layout"] = _layout(load_layout(source.project.root), collector)
    return found


def _layout(saved: Any, collector: Collector) -> dict[str, Any]:
    """Return the arrangement of a page that shows a run: the person's plots, whole; otherwise plots of the outputs."""
    layout = {key: saved[key] for key in _OF_USE if key in saved} if isinstance(saved, dict) else {}
    plots = layout.get("plots")
    plots = {name: {**plot, "seconds": 0} for name, plot in plots.items()} if isinstance(plots, dict) else {}
    if not any(plot.get("curves") for plot in plots.values()):
        curves = [{"path": path, "axis": "left", "color": color} for color, path in enumerate(_outputs(collector))]
        plots = {"plot:1": {"curves": curves, "seconds": 0}}
    return {**layout, "version": 1, "layout": "log", "plots": plots}


def _outputs(collector: Collector) -> list[str]:
    """Return the outputs that changed most."""
    meters = [
        row.paths[0] for panel in collector.state.panels for row in panel.rows if row.kind == "meter" and row.paths
    ]
    changes = collector.runs.change_counts(meters)
    moved = sorted(
        (path for path in changes if changes[path] > 1), key=lambda path: (-changes[path], meters.index(path))
    )
    return sorted(moved[:_SUGGESTED], key=meters.index)


def cleaner(root: Path) -> Callable[[str], str]:
    """Return a function that replaces the places of this computer in a text.

    :param root: the project's directory: its files are named relative to it
    """
    paths = sysconfig.get_paths()
    names: dict[str, str] = {}
    for place, name in (
        *((each, "") for each in {str(root), str(root.resolve())}),
        *((paths[key], "site-packages") for key in ("purelib", "platlib")),
        *((paths[key], "python") for key in ("stdlib", "platstdlib")),
        *((each, "python") for each in (sys.prefix, sys.base_prefix)),
        (str(Path(__file__).resolve().parents[4]), "pyfrc"),
        (str(Path.home()), "~"),
    ):
        if len(place) > 1:
            names.setdefault(place, name)
    places = "|".join(re.escape(place) for place in sorted(names, key=len, reverse=True))
    pattern = re.compile(rf"(?<![\w./\\-])(?P<place>{places})(?P<slash>[/\\]|(?![\w.-]))")

    def replaced(match: re.Match[str]) -> str:
        name = names[match["place"]]
        return f"{name}/" if match["slash"] and name else name if match["slash"] else name or "."

    return lambda text: pattern.sub(replaced, text)


def _cleaned(value: Any, clean: Callable[[str], str]) -> Any:
    """Return a value with every text in it changed, except for names of values."""
    if isinstance(value, str):
        return clean(value) if not value.startswith("data:") else value
    if isinstance(value, Mapping):
        return {key: _cleaned(each, clean) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_cleaned(each, clean) for each in value]
    return value
