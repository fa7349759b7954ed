"""Layouts for Elastic become dashboards: what each part becomes, what is missing, and where the layout is."""

from __future__ import annotations

import json
import socketserver
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from loops import for_each

from pyfrc_core.config.dashboards import load_dashboards, save_dashboard
from pyfrc_core.config.elastic_layout import ELASTIC_LAYOUT, read_elastic_layout
from pyfrc_core.errors import PyfrcError
from pyfrc_core.sim.ui.web import dashboards as web_dashboards
from pyfrc_core.sim.ui.web.dashboards import Dashboards
from pyfrc_core.sim.ui.web.messages import CommandError

CELL = 128


def part(type_name: str, place: tuple[float, float, float, float] = (0, 0, 2, 1), **properties: Any) -> dict[str, Any]:
    x, y, width, height = (each * CELL for each in place)
    given = {"topic": "/SmartDashboard/a", "period": 0.06, **properties}
    return {"title": "A", "x": x, "y": y, "width": width, "height": height, "type": type_name, "properties": given}


def layout(*containers: dict[str, Any], lists: tuple[dict[str, Any], ...] = (), name: str = "Teleoperated") -> bytes:
    grid = {"layouts": lists, "containers": containers}
    return json.dumps({"version": 1.0, "grid_size": CELL, "tabs": [{"name": name, "grid_layout": grid}]}).encode()


def widgets_of(text: bytes) -> list[dict[str, Any]]:
    (dashboard,) = read_elastic_layout(text, "layout").dashboards.values()
    found: list[dict[str, Any]] = dashboard["widgets"]
    return found


@for_each(
    "theirs, expected",
    [
        (part("Text Display"), {"kind": "input"}),
        (part("Large Text Display", data_type="string"), {"kind": "text"}),
        (part("Large Text Display", data_type="double"), {"kind": "number"}),
        (part("Number Slider", min_value=0.0, max_value=4, divisions=8), {"kind": "slider", "max": 4.0, "step": 0.5}),
        (part("Number Slider", divisions=0, min_value="x"), {"kind": "slider", "min": -1.0, "max": 1.0}),
        (part("Voltage View"), {"kind": "gauge", "min": 4.0, "max": 13.0, "unit": "V"}),
        (part("Graph", time_displayed=10.0, max_value=20.0), {"kind": "graph", "seconds": 10.0, "max": 20.0}),
        (part("Gyro", counter_clockwise_positive=True), {"kind": "gyro", "counterclockwise": True}),
        (part("Gyro", counter_clockwise_positive=False), {"kind": "gyro"}),
        (part("Single Color View"), {"kind": "color"}),
        (part("FMSInfo", topic="/FMSInfo"), {"kind": "values", "topic": "/FMSInfo"}),
        (
            part("Text Display", topic="pose", struct_meta={"path": ["translation", "x"]}),
            {"topic": "nt:pose/translation/x"},
        ),
    ],
)
def test_a_part_of_a_layout_is_a_widget(theirs: dict[str, Any], expected: dict[str, Any]) -> None:
    (widget,) = widgets_of(layout(theirs))
    assert {key: widget[key] for key in expected} == expected
    assert ("counterclockwise" in widget) == ("counterclockwise" in expected)


def test_what_has_no_widget_here_is_named(tmp_path: Path) -> None:
    whole = part("List Layout", (2, 0, 2, 3))
    whole["children"] = [part("Text Display"), part("Boolean Box", topic="/b"), part("Gyro")]
    found = read_elastic_layout(
        layout(part("Scheduler", (0, 0, 2, 1)), part("Gyro", (0, 1, 0.2, 1)), lists=(whole,)), "layout"
    )
    assert found.missing == [
        'Scheduler "A" in Teleoperated',
        'Gyro "A" in Teleoperated',
        'Gyro "A" in A in Teleoperated',
    ]
    (dashboard,) = found.dashboards.values()
    place = {"x": 2, "y": 0, "w": 2, "h": 3}
    assert dashboard["widgets"] == [{"title": "A", "kind": "values", "more": ["/SmartDashboard/a", "/b"], **place}]
    save_dashboard(tmp_path, "Teleoperated", dashboard)
    assert (dashboard["columns"], dashboard["rows"]) == (8, 4)


@given(
    st.lists(st.integers(1, 60), min_size=2, max_size=12),
    st.integers(1, 300),
)
def test_no_widget_covers_another(sizes: list[int], size: int) -> None:
    """Also where the layout was made with another grid, or has more cells than a dashboard."""
    parts, left = [], 0
    for number, wide in enumerate(sizes):
        parts.append({**part("Gyro"), "x": left, "y": number, "width": wide, "height": wide})
        left += wide
    text = json.loads(layout(*parts))
    text["grid_size"] = size
    dashboards = read_elastic_layout(json.dumps(text).encode(), "layout").dashboards
    dashboard = dashboards["Teleoperated"]
    assert max(dashboard["columns"], dashboard["rows"]) <= 48
    for widget in dashboard["widgets"]:
        assert widget["x"] + widget["w"] <= dashboard["columns"]
        assert widget["y"] + widget["h"] <= dashboard["rows"]
    for one, other in combinations(dashboard["widgets"], 2):
        assert one["x"] + one["w"] <= other["x"] or other["x"] + other["w"] <= one["x"]


def test_tabs_of_the_same_name_are_two_dashboards() -> None:
    text = json.loads(layout(part("Gyro")))
    text["tabs"] *= 2
    assert list(read_elastic_layout(json.dumps(text).encode(), "layout").dashboards) == [
        "Teleoperated",
        "Teleoperated 2",
    ]


@for_each(
    "text, problem",
    [
        (b"", "this is no layout"),
        (b"[]", "this is no layout"),
        (b"\xff\xfe", "this is no layout"),
        (b"[" * 100_000, "this is no layout"),
        (b'{"grid_size": 0, "tabs": []}', "has no widgets"),
        (layout(), "has no widgets"),
        (layout({"type": "Gyro"}), "this is no layout"),
        (layout(part("Gyro", (float("nan"), 0, 1, 1))), "this is no layout"),
        (layout(part("Gyro", (float("inf"), 0, 1, 1))), "this is no layout"),
        (layout({**part("Gyro"), "width": "a"}), "this is no layout"),
        (layout({**part("Gyro"), "properties": 3}), "this is no layout"),
        (layout(part("Gyro")).replace(b"128,", b'"a",', 1), "this is no layout"),
    ],
)
def test_another_file_is_no_layout(text: bytes, problem: str) -> None:
    with pytest.raises(PyfrcError, match=problem):
        read_elastic_layout(text, "layout")


# -- where it is ------------------------------------------------------------------------------------------------------


def test_a_project_has_it_in_its_deploy_directory(tmp_path: Path) -> None:
    dashboards = Dashboards(tmp_path)
    with pytest.raises(
        CommandError, match=r"deploy/elastic-layout.json cannot be read: No such file .* Save your layout"
    ):
        dashboards.elastic_layout(None)
    (tmp_path / "deploy").mkdir()
    (tmp_path / ELASTIC_LAYOUT).write_bytes(layout(part("Gyro"), part("Scheduler", (2, 0, 1, 1))))
    found = dashboards.elastic_layout(None)
    assert (found["from"], found["missing"]) == ("deploy/elastic-layout.json", ['Scheduler "A" in Teleoperated'])
    for name, content in found["dashboards"].items():
        save_dashboard(tmp_path, name, content)
    assert [widget.kind for widget in load_dashboards(tmp_path)["Teleoperated"].widgets] == ["gyro"]
    (tmp_path / ELASTIC_LAYOUT).write_text("{", "utf-8")
    with pytest.raises(CommandError, match=r"deploy/elastic-layout.json: this is no layout of Elastic Save it again"):
        dashboards.elastic_layout(None)


@contextmanager
def robot(respond: Callable[[Callable[[bytes], object]], object], monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Have a robot that responds to each request with what `respond` sends."""

    class Handler(socketserver.StreamRequestHandler):
        def handle(self) -> None:
            while self.rfile.readline().strip():
                pass
            respond(self.wfile.write)

    with socketserver.ThreadingTCPServer(("127.0.0.1", 0), Handler) as server:
        server.daemon_threads = True
        monkeypatch.setattr(web_dashboards, "_LAYOUT_PORT", server.server_address[1])
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield
        server.shutdown()


def test_a_robot_elsewhere_serves_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("http_proxy", "http://127.0.0.1:9")
    text = layout(part("Gyro"))
    dashboards = Dashboards(tmp_path)
    with robot(lambda send: send(b"HTTP/1.0 200 OK\r\n\r\n" + text), monkeypatch):
        found = dashboards.elastic_layout("127.0.0.1")
    assert found["from"].startswith("http://127.0.0.1:")
    assert list(found["dashboards"]) == ["Teleoperated"]
    with pytest.raises(CommandError, match="There is no connection to the robot"):
        dashboards.elastic_layout("")
    with pytest.raises(CommandError, match=r"cannot be read: Connection refused. A robot serves it if its code starts"):
        dashboards.elastic_layout("127.0.0.1")


def endless(send: Callable[[bytes], object]) -> None:
    send(b"HTTP/1.0 200 OK\r\n\r\n")
    try:
        while True:
            send(b" " * 100_000)
    except OSError:
        pass


@pytest.mark.parametrize(
    ("respond", "problem"),
    [
        (lambda send: send(b"HTTP/1.0 404 Not Found\r\n\r\n"), "cannot be read: Not Found"),
        (lambda send: send(b"SSH-2.0\r\n"), "cannot be read: SSH-2.0"),
        (lambda send: send(b"HTTP/1.0 302 Found\r\nLocation: file:///etc/passwd\r\n\r\n"), "not allowed"),
        (endless, "it is too large, or comes too slowly"),
    ],
)
def test_what_a_robot_serves_instead_is_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, respond: Any, problem: str
) -> None:
    with robot(respond, monkeypatch), pytest.raises(CommandError, match=problem):
        Dashboards(tmp_path).elastic_layout("127.0.0.1")
