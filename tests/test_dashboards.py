"""``sim/dashboards.json``: read with a line for each mistake, and written so that Git can compare and merge it."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, get_args

import pytest
from skips import require

from pyfrc_core.config.dashboards import DASHBOARDS, Kind, load_dashboards, save_dashboard
from pyfrc_core.errors import SettingsError
from pyfrc_core.sim.ui.web.dashboards import Dashboards
from pyfrc_core.sim.ui.web.messages import CommandError, Message
from pyfrc_core.sim.ui.web.single_file import PAGE

WIDGET = {"kind": "number", "topic": "/SmartDashboard/kP", "x": 0, "y": 0, "w": 2, "h": 1}
GAUGE = {"kind": "gauge", "topic": "/SmartDashboard/speed", "x": 2, "y": 0, "w": 2, "h": 2, "min": -12.0, "max": 12.0}


@pytest.fixture(name="root")
def project_root() -> Iterator[Path]:
    with TemporaryDirectory() as name:  # not pytest's, which other users cannot enter
        root = Path(name)
        root.chmod(0o755)
        save_dashboard(root, "Drive", {"columns": 12, "rows": 8, "widgets": [WIDGET, GAUGE]})
        save_dashboard(root, "Pit", {"widgets": []})
        yield root


def test_a_line_for_each_widget(root: Path) -> None:
    text = (root / DASHBOARDS).read_text("utf-8")
    assert json.dumps(WIDGET) + ",\n" in text
    assert json.dumps(GAUGE) + "\n" in text
    assert json.loads(text)["dashboards"]["Drive"] == {"columns": 12, "rows": 8, "widgets": [WIDGET, GAUGE]}


def test_a_dashboard_is_renamed_and_removed_in_its_place(root: Path) -> None:
    save_dashboard(root, "Drivers", {"widgets": [GAUGE]}, former_name="Drive")
    assert list(load_dashboards(root)) == ["Drivers", "Pit"]
    assert [widget.max for widget in load_dashboards(root)["Drivers"].widgets] == [12.0]
    save_dashboard(root, "Drivers", None)
    assert list(load_dashboards(root)) == ["Pit"]


def test_no_file_no_dashboards(tmp_path: Path) -> None:
    assert load_dashboards(tmp_path) == {}


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"kind": "guage"}, ".kind = 'guage': input should be 'number'"),
        ({"x": -1}, ".x = -1: input should be greater than or equal to 0"),
        ({"w": "2"}, ".w = '2': input should be a valid integer"),
        ({"colour": "red"}, "unknown key 'dashboards.Drive.widgets[1].colour'"),
        ({"h": None}, ".h = None"),
    ],
)
def test_a_wrong_dashboard_changes_nothing(root: Path, wrong: dict[str, Any], message: str) -> None:
    before = (root / DASHBOARDS).read_text("utf-8")
    with pytest.raises(SettingsError) as error:
        save_dashboard(root, "Drive", {"widgets": [WIDGET, {**WIDGET, **wrong}]})
    assert message in str(error.value)
    assert (root / DASHBOARDS).read_text("utf-8") == before


@pytest.mark.parametrize(
    ("now", "then", "message"),
    [
        ('"gauge"', '"guage"', 'sim/dashboards.json:8: dashboards.Drive.widgets[1].kind = "guage": input should be'),
        ('"topic"', '"topik"', "sim/dashboards.json:7: unknown key 'dashboards.Drive.widgets[0].topik'"),
        (', "w": 2', "", "sim/dashboards.json:7: dashboards.Drive.widgets[0]: the key 'w' is missing"),
        ('"Pit"', '"Drive"', "sim/dashboards.json:11: dashboards.Drive stands here again, after line 3"),
        (
            '"columns"',
            '"colums"',
            "sim/dashboards.json:4: unknown key 'dashboards.Drive.colums'\n  did you mean 'columns'?",
        ),
        ("{\n", "<<<<<<< HEAD\n{\n", "sim/dashboards.json:1: not valid JSON: expected a value"),
    ],
)
def test_a_mistake_in_the_file_has_its_line(root: Path, now: str, then: str, message: str) -> None:
    text = (root / DASHBOARDS).read_text("utf-8").replace(now, then, 1)
    (root / DASHBOARDS).write_text(text, "utf-8")
    with pytest.raises(SettingsError) as error:
        load_dashboards(root)
    assert str(error.value).startswith(message)
    with pytest.raises(SettingsError):  # nor is it overwritten
        save_dashboard(root, "Other", {"widgets": []})
    assert (root / DASHBOARDS).read_text("utf-8") == text


def test_the_example_of_the_documentation(tmp_path: Path) -> None:
    text = (Path(__file__).parents[1] / "docs/reference/dashboards.md").read_text("utf-8")
    (example,) = re.findall("^```json\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    (tmp_path / "sim").mkdir()
    (tmp_path / DASHBOARDS).write_text(example, "utf-8")
    (dashboard,) = load_dashboards(tmp_path).values()
    assert [widget.kind for widget in dashboard.widgets] == ["time", "gauge", "graph", "field"]


def test_the_page_has_a_widget_of_each_kind() -> None:
    text = (PAGE / "js" / "dashboard" / "kinds.js").read_text("utf-8")
    assert set(re.findall("^  ([a-z]+): [{] title: ", text, re.MULTILINE)) == set(get_args(Kind))


def test_a_page_gets_them_when_they_have_changed(root: Path) -> None:
    dashboards = Dashboards(root)
    first = dashboards.found()
    assert list(first["dashboards"]) == ["Drive", "Pit"]
    assert first["dashboards"]["Drive"]["widgets"][0] == {**WIDGET, "more": (), "title": "", "unit": ""}
    assert dashboards.found(first["stamp"]) == {"stamp": first["stamp"]}
    (root / DASHBOARDS).write_text("{", "utf-8")
    broken = dashboards.found(first["stamp"])
    assert broken["dashboards"] == {}
    assert broken["problem"].startswith("sim/dashboards.json:1: ")
    (root / DASHBOARDS).unlink()
    assert dashboards.found(broken["stamp"]) == {"stamp": "none", "dashboards": {}, "problem": ""}


@pytest.mark.parametrize(
    ("message", "problem"),
    [
        ({"dashboard": " ", "content": {}}, "A dashboard needs a name."),
        ({"dashboard": "n" * 61, "content": {}}, "at most 60 characters"),
        (
            {"dashboard": "Drive", "content": None, "seen": {"Drive": {"widgets": [WIDGET]}}},
            'The dashboard was not saved: "Drive" has just been changed in sim/dashboards.json by another page',
        ),
        ({"dashboard": "New", "content": {}, "seen": {"New": {}}}, '"New" has just been changed'),
        ({"dashboard": "Drive", "content": {}, "seen": {"Drive": None}}, '"Drive" has just been changed'),
        ({"dashboard": "Drive", "content": {}, "seen": {"Drive": {"rows": 0}}}, "dashboards.Drive.rows = 0"),
        ({"dashboard": "Drive", "content": {}, "seen": 3}, "seen: an object with a dashboard for each name is needed"),
        ({"dashboard": "Drive", "content": "no"}, "dashboards.Drive = 'no': input should be an object"),
        ({"dashboard": "Drive", "content": {"columns": 1e9}}, "dashboards.Drive.columns = 1000000000.0"),
        ({"dashboard": "Drive", "content": {"widgets": [{}] * 1001}}, "at most 1000 of them, not 1001"),
    ],
)
def test_whatever_a_page_sends_has_an_answer(root: Path, message: dict[str, Any], problem: str) -> None:
    before = (root / DASHBOARDS).read_text("utf-8")
    with pytest.raises(CommandError) as error:
        Dashboards(root).save(Message(message))
    assert problem in str(error.value)
    assert (root / DASHBOARDS).read_text("utf-8") == before


def test_the_second_of_two_pages_replaces_only_what_it_has_seen(root: Path) -> None:
    dashboards = Dashboards(root)
    seen = dashboards.found()["dashboards"]

    def save(name: str, *widgets: dict[str, Any]) -> None:
        message = {"dashboard": name, "content": {"widgets": widgets}, "seen": {name: seen[name]}}
        dashboards.save(Message(json.loads(json.dumps(message))))

    save("Drive", GAUGE)
    with pytest.raises(CommandError, match='"Drive" has just been changed'):
        save("Drive", WIDGET)
    save("Pit", WIDGET)  # which the first has not touched
    assert [len(each.widgets) for each in load_dashboards(root).values()] == [1, 1]
    assert load_dashboards(root)["Drive"].widgets[0].kind == "gauge"


def test_a_file_that_cannot_be_read_or_written_is_a_sentence(root: Path) -> None:
    dashboards, file = Dashboards(root), root / DASHBOARDS
    before = file.read_text("utf-8")
    with read_only(file.parent), pytest.raises(CommandError) as error:
        dashboards.save(Message({"dashboard": "Pit", "content": {}}))
    assert "not saved: sim/dashboards.json cannot be written: Permission denied. Make the file" in str(error.value)
    assert file.read_text("utf-8") == before
    file.unlink()
    file.mkdir()
    first = dashboards.found()
    assert first["problem"] == "sim/dashboards.json: this is a directory, where a file is expected"
    assert dashboards.found(first["stamp"]) == {"stamp": first["stamp"]}
    shutil.rmtree(file.parent)
    file.parent.write_text("no directory", "utf-8")
    assert dashboards.found()["problem"].startswith("sim/dashboards.json: the file cannot be read: ")


@contextmanager
def read_only(directory: Path) -> Iterator[None]:
    """Have a directory that this process cannot write: as root, as another user."""
    require("directories that cannot be written", ["POSIX"] if sys.platform == "win32" else [])
    directory.chmod(0o555)
    is_root = os.geteuid() == 0
    if is_root:
        os.seteuid(65534)
    try:
        yield
    finally:
        if is_root:
            os.seteuid(0)
        directory.chmod(0o755)
