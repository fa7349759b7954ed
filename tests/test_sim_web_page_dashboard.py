"""A dashboard that a person arranges on the page, and the drivers look at."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from browser_pages import Seen, page_of

from pyfrc_core.config.dashboards import DASHBOARDS

if TYPE_CHECKING:
    from playwright.sync_api import Locator

TABLE = "/SmartDashboard/"


@pytest.fixture(name="file")
def dashboards_file(server: Any) -> Iterator[Path]:
    file: Path = server.simulation.project.root / DASHBOARDS
    file.unlink(missing_ok=True)
    yield file
    file.unlink(missing_ok=True)


def widgets(file: Path, name: str = "Drive") -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(file.read_text("utf-8"))["dashboards"][name]["widgets"]
    return found


def with_widgets(file: Path, *given: dict[str, Any], name: str = "Drive") -> None:
    places = [{"x": 3 * (index % 4), "y": 2 * (index // 4), "w": 3, "h": 2, **each} for index, each in enumerate(given)]
    file.write_text(json.dumps({"dashboards": {name: {"widgets": places}}}, indent=1), "utf-8")


def put(person: Seen, row: Locator, grid: Locator, place: tuple[float, float]) -> None:
    """Drag a row of NetworkTables to a place on the grid, where the pointer must move twice to be over it."""
    row.hover()
    person.page.mouse.down()
    for _ in range(2):
        grid.hover(position={"x": place[0], "y": place[1]})
    person.page.mouse.up()


def shown(person: Seen, kind: str) -> Locator:
    return person.page.locator(f".widget[data-kind={kind}]")


def test_a_team_makes_a_dashboard(file: Path, person: Seen) -> None:
    page = person.page
    person.choose("Layout", "Dashboard")
    person.button("New dashboard…").click()
    page.keyboard.press("Enter")  # it is called "Drive"
    grid = page.locator(".grid")
    # A value and a table from NetworkTables, and what the search offers.
    put(person, person.row(f"nt:{TABLE}kP"), grid, (400, 300))
    shown(person, "number").wait_for()
    put(person, page.locator(".nt-row.folder", has_text="Turn"), grid, (20, 20))
    shown(person, "pid").wait_for()
    person.button("Add widget").click()
    page.get_by_label("Search all values").fill("flag")
    page.keyboard.press("Enter")
    # Arrow keys move a widget over others and change its size.
    number = shown(person, "number")
    number.focus()
    for key in ("ArrowLeft", *["ArrowUp"] * 7, "Shift+ArrowRight", "Shift+ArrowDown"):
        page.keyboard.press(key)
    person.button("Settings of flag").click()
    page.get_by_label("Show as").select_option("switch")
    switch = shown(person, "switch")
    switch.wait_for()  # the settings are drawn again with it
    page.get_by_label("Title").fill("Arm it")
    page.keyboard.press("Enter")
    switch.get_by_text("Arm it").wait_for()
    page.keyboard.press("Escape")
    # A page that was reloaded goes on; a dashboard is in the file when it was saved.
    page.reload()
    number.wait_for()
    assert not file.exists()
    person.button("Save").click()
    person.button("Arrange").wait_for()
    assert [(each["kind"], each["topic"]) for each in widgets(file)] == [
        ("number", f"{TABLE}kP"),
        ("pid", f"{TABLE}Turn"),
        ("switch", f"{TABLE}flag"),
    ]
    saved = widgets(file)[0]
    assert (saved["w"], saved["h"]) == (3, 2)
    assert saved["y"] <= 1  # the lamp may be above it
    # The drivers see widgets and nothing else, and use them.
    person.button("Full screen").click()
    person.button("Leave the full screen").wait_for()
    assert page.locator(".dashboard .panel-tools").count() == 0
    shown(person, "number").get_by_text("0.50").wait_for()
    shown(person, "switch").locator("label.switch").click()
    person.until(lambda: person.written("flag") == [True])
    box = shown(person, "pid").get_by_label("p", exact=True)
    person.set_number(box, "3.5")
    person.until(lambda: person.written("Turn/p") == [3.5])
    person.button("Leave the full screen").click()
    # Cancelling brings back what was saved.
    person.button("Arrange").click()
    person.button("Remove kP").click()
    person.button("Discard").click()
    page.locator("dialog").get_by_text("Discard", exact=True).click()
    shown(person, "number").wait_for()


def test_the_file_is_the_teams(file: Path, person: Seen) -> None:
    """The page follows what Git or an editor writes, and says what is wrong with it."""
    page = person.page
    with_widgets(file, {"kind": "text", "topic": f"{TABLE}nothing"}, {"kind": "lamp", "topic": f"{TABLE}flag"})
    person.choose("Layout", "Dashboard")
    shown(person, "text").get_by_text(f"Not published: {TABLE}nothing").wait_for()
    shown(person, "lamp").get_by_text("false").wait_for()
    good = file.read_text("utf-8")
    file.write_text(good.replace('"lamp"', '"lampe"'), "utf-8")
    page.get_by_role("alert").get_by_text('dashboards.Drive.widgets[1].kind = "lampe"').wait_for()
    page.get_by_role("alert").get_by_text("sim/dashboards.json:").wait_for()
    file.write_text(good, "utf-8")
    shown(person, "lamp").wait_for()


def test_every_widget_shows_what_the_robot_publishes(file: Path, person: Seen) -> None:
    with_widgets(
        file,
        {"kind": "gauge", "topic": f"{TABLE}doubled", "min": 0, "max": 2, "unit": "V"},
        {"kind": "graph", "topic": f"{TABLE}doubled", "more": ["pwm[0].value"]},
        {"kind": "field"},
        {"kind": "mechanism", "topic": f"{TABLE}Arm"},
        {"kind": "swerve", "topic": f"{TABLE}Modules", "x": 9, "y": 4, "h": 4},
        {"kind": "alerts", "topic": f"{TABLE}Alerts"},
        {"kind": "state"},
        {"kind": "time"},
        {"kind": "input", "topic": f"{TABLE}kP"},
        {"kind": "values", "topic": f"{TABLE}Turn", "x": 6},
    )
    page = person.page
    person.choose("Layout", "Dashboard")
    shown(person, "gauge").get_by_role("img", name="doubled: 1 V").wait_for()
    shown(person, "graph").locator(".legend", has_text="doubled").wait_for()
    shown(person, "graph").locator(".u-over").wait_for()
    shown(person, "field").locator("canvas").wait_for()
    shown(person, "mechanism").get_by_role("img", name="Arm").wait_for()
    shown(person, "swerve").get_by_text("measured").wait_for()
    shown(person, "alerts").get_by_text("the battery is low").wait_for()
    shown(person, "state").get_by_text("Teleoperated disabled").wait_for()
    shown(person, "time").get_by_text("\N{EN DASH}:").wait_for()
    person.button("Practice").click()
    shown(person, "state").get_by_text("Autonomous enabled").wait_for()
    shown(person, "time").get_by_text("0:1").wait_for()
    person.set_number(shown(person, "input").get_by_role("textbox"), "2")
    shown(person, "gauge").get_by_role("img", name="doubled: 4 V").wait_for()
    assert shown(person, "values").locator(".row").count() > 6
    page.get_by_label("Timeline").click(position={"x": 30, "y": 10})
    page.locator(".state em", has_text="past").wait_for()
    shown(person, "gauge").get_by_role("img", name="doubled: 1 V").wait_for()


def test_who_only_looks_changes_no_dashboard(browser: Any, server: Any, file: Path) -> None:
    with_widgets(file, {"kind": "lamp", "topic": f"{TABLE}flag"})
    with page_of(browser, server, server.viewing_address) as person:
        person.choose("Layout", "Dashboard")
        shown(person, "lamp").wait_for()
        assert person.button("Arrange").count() == 0
        person.button("Full screen").click()
        person.button("Leave the full screen").click()
