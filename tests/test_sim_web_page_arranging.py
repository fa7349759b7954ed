"""A dashboard that is arranged: steps that are undone, what others write meanwhile, and fingers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from browser_pages import Seen, page_of
from test_sim_web_page_dashboard import TABLE, dashboards_file, shown, widgets, with_widgets  # noqa: F401 - `file`
from test_sim_web_page_tablet import LEAST, LOOK, NOTHING, SIZE, Fingers

LAMP = {"kind": "lamp", "topic": f"{TABLE}flag", "x": 8, "y": 5, "w": 1, "h": 1}
LONG = "A table with a name that is far too long for its column among the values"
GAUGE = {"kind": "gauge", "topic": f"{TABLE}doubled", "x": 2, "y": 1, "w": 2, "h": 2}

#: The draft, or what the file has: its name, and the place of each widget.
ARRANGED = """async () => {
  const { dashboards } = await module("js/dashboard/dashboards.js");
  const { name, widgets } = dashboards.shown ?? { name: "", widgets: [] };
  return [name, ...widgets.map(({ kind, title, x, y, w, h }) => [title || kind, x, y, w, h].join(" "))];
}"""


def arranged(person: Seen) -> list[str]:
    found: list[str] = person.page.evaluate(ARRANGED)
    return found


def places(file: Path, name: str = "Drive") -> list[str]:
    keys = ("x", "y", "w", "h")
    return [
        " ".join(map(str, (each.get("title") or each["kind"], *map(each.get, keys)))) for each in widgets(file, name)
    ]


def test_each_step_is_undone_and_done_again(file: Path, person: Seen) -> None:
    page = person.page
    with_widgets(file, LAMP, GAUGE)
    person.choose("Layout", "Dashboard")
    person.button("Arrange").click()
    undo, redo = person.button("Undo"), person.button("Redo")
    undo.and_(page.locator(":disabled")).wait_for()
    redo.and_(page.locator(":disabled")).wait_for()
    seen = [arranged(person)]

    def step(text: str) -> None:
        page.get_by_title(f"Undo “{text}”: Ctrl+Z").wait_for()
        seen.append(arranged(person))
        assert seen[-1] != seen[-2], text

    box = page.locator(".grid").bounding_box()
    cell = (box["width"] / 12, box["height"] / 8)
    for kind, text, spot in (("gauge", "doubled: moved", 0.5), ("lamp", "flag: moved", 0.5)):
        # A drag is one step, however far it goes.
        person.drag(shown(person, kind), (spot, spot), (spot + cell[0] / 20, spot))
        step(text)
    corner = shown(person, "gauge").locator(".widget-corner")
    person.drag(corner, (0.5, 0.5), (0.5, 0.5 + 1.2 * cell[1] / corner.bounding_box()["height"]))
    step("doubled: size changed")
    person.button("Add widget").click()
    page.get_by_label("Search all values").fill("kP")
    page.keyboard.press("Enter")
    step("kP added")
    person.button("Settings of kP").click()
    page.get_by_label("Title").fill("P")
    page.keyboard.press("Control+z")  # a box undoes what was typed
    page.get_by_label("Title").fill("P")
    page.keyboard.press("Enter")
    step("P: settings changed")
    page.keyboard.press("Escape")
    person.button("Remove flag").click()
    step("flag removed")
    person.button("Grid").click()
    page.get_by_role("spinbutton", name="Rows").fill("3")
    page.keyboard.press("Tab")
    step("grid changed")
    page.locator(".grid").click(position={"x": 3, "y": 3})
    # Back to the beginning and again to the end, by keys and by buttons.
    for each in reversed(seen[:-1]):
        page.keyboard.press("Control+z")
        assert arranged(person) == each
    undo.and_(page.locator(":disabled")).wait_for()
    person.button("Cancel").wait_for()  # nothing is left to be saved
    for each in seen[1:]:
        redo.click()
        assert arranged(person) == each
    redo.and_(page.locator(":disabled")).wait_for()
    undo.click()
    page.keyboard.press("Control+Shift+z")
    assert arranged(person) == seen[-1]
    # Steps outlast saving: then they are undone in the file. A reload forgets them.
    person.button("Save").click()
    person.button("Arrange").wait_for()
    assert places(file) == seen[-1][1:]
    undo.click()
    redo.and_(page.locator(":enabled")).wait_for()
    assert places(file) == seen[-2][1:]
    person.button("Arrange").click()
    person.button("Cancel").wait_for()  # from here on, steps are undone on the page and not in the file
    undo.click()
    assert arranged(person) == seen[-3]
    person.button("Discard").click()
    page.locator("dialog").get_by_text("Discard", exact=True).click()
    person.button("Arrange").wait_for()
    assert places(file) == seen[-2][1:]
    redo.click()
    undo.and_(page.get_by_title("grid changed", exact=False)).wait_for()
    assert places(file) == seen[-1][1:]
    page.reload()
    person.button("Arrange").wait_for()
    assert undo.count() == 0


def test_dashboards_that_were_renamed_and_removed_come_back(file: Path, person: Seen) -> None:
    page = person.page
    with_widgets(file, LAMP)
    before = places(file)
    menu = "Dashboards of this project"
    person.choose("Layout", "Dashboard")
    person.choose(menu, "Rename…")
    page.keyboard.type("Pit")
    page.keyboard.press("Enter")
    page.get_by_title(menu).get_by_text("Pit").wait_for()
    person.choose(menu, "Remove…")
    page.locator("dialog").get_by_text("Remove", exact=True).click()
    person.button("New dashboard…").wait_for()
    assert json.loads(file.read_text("utf-8")) == {"dashboards": {}}
    person.button("Undo").click()
    page.get_by_title(menu).get_by_text("Pit").wait_for()
    assert places(file, "Pit") == before
    page.keyboard.press("Control+z")
    page.get_by_title(menu).get_by_text("Drive").wait_for()
    assert places(file) == before
    page.keyboard.press("Control+Shift+z")
    page.get_by_title(menu).get_by_text("Pit").wait_for()
    assert places(file, "Pit") == before
    # The file has something else meanwhile: the step is refused, and nothing is lost.
    with_widgets(file, GAUGE, name="Pit")
    shown(person, "gauge").wait_for()
    person.button("Undo").click()
    page.get_by_text("“Pit” was changed elsewhere since then: this step can no longer be undone.").wait_for()
    assert places(file, "Pit") == ["gauge 2 1 2 2"]


def test_what_others_write_meanwhile_is_not_lost(file: Path, person: Seen) -> None:
    page = person.page
    with_widgets(file, LAMP)
    person.choose("Layout", "Dashboard")
    person.button("Arrange").click()
    person.button("Save").wait_for()
    shown(person, "lamp").focus()
    page.keyboard.press("ArrowRight")
    mine, theirs = "lamp 9 5 1 1", "gauge 2 1 2 2"
    with_widgets(file, GAUGE)
    alert = page.get_by_role("alert").get_by_text("“Drive” was changed in sim/dashboards.json by another page")
    alert.wait_for()
    assert arranged(person) == ["Drive", mine]
    # Saving asks first.
    person.button("Save").click()
    page.locator("dialog").get_by_text("Cancel", exact=True).click()
    assert places(file) == [theirs]
    # The other one is taken as a step, which is undone and done again.
    person.button("Take the other one").click()
    alert.wait_for(state="detached")
    assert arranged(person) == ["Drive", theirs]
    person.button("Undo").click()
    assert arranged(person) == ["Drive", mine]
    # A file that was cut: what is arranged stays, and is saved when the file is whole again.
    whole = file.read_text("utf-8")
    file.write_text(whole[:32], "utf-8")
    cut = page.get_by_role("alert").filter(has_text="sim/dashboards.json:3: not valid JSON: the file ends too early")
    cut.filter(has_text="What you have arranged stays here").wait_for()
    person.button("Save").and_(page.locator(":disabled")).wait_for()
    assert arranged(person) == ["Drive", mine]
    file.write_text(whole, "utf-8")
    cut.wait_for(state="detached")
    # Another change, which is replaced on purpose: it can be had again.
    with_widgets(file, {**GAUGE, "x": 5})
    alert.wait_for()
    person.button("Save").click()
    page.locator("dialog").get_by_text("Replace it", exact=True).click()
    person.button("Arrange").wait_for()
    assert places(file) == [mine]
    person.button("Undo").click()
    shown(person, "gauge").wait_for()
    assert places(file) == ["gauge 5 1 2 2"]
    # Who looks at a dashboard goes on seeing it.
    file.write_text("[]", "utf-8")
    page.get_by_role("alert").get_by_text("The dashboard is the last one that could be read.").wait_for()
    shown(person, "gauge").wait_for()


def test_fingers_arrange(browser: Any, server: Any, file: Path) -> None:
    with_widgets(file, LAMP, GAUGE, {"kind": "number", "topic": f"{TABLE}kP", "x": 0, "y": 0, "w": 1, "h": 1})
    with page_of(browser, server, has_touch=True) as tablet:
        page = tablet.page
        page.set_viewport_size(SIZE)
        tablet.choose("Layout", "Dashboard")
        tablet.button("Arrange").tap()
        page.locator(".grid.arranging").wait_for()
        fingers = Fingers(tablet)
        grid = page.locator(".grid")
        for finger_at, until in (((8.5, 5.5), (10.5, 2.5)), ((10.5, 2.5), (5.5, 6.5))):
            fingers.put(1, grid, finger_at[0] / 12, finger_at[1] / 8)
            fingers.put(2, grid, 0.9, 0.9)  # a second finger changes nothing
            fingers.put(1, grid, until[0] / 12, until[1] / 8)
            fingers.lift()
        assert arranged(tablet)[1] == "lamp 5 6 1 1"
        shown(tablet, "lamp").tap()
        corner = shown(tablet, "lamp").locator(".widget-corner")
        fingers.put(1, corner, 0.5, 0.5)
        fingers.put(1, grid, 7.6 / 12, 7.8 / 8)
        fingers.lift()
        page.locator(".widget-lamp").get_by_text("false").wait_for()
        assert arranged(tablet)[1] == "lamp 5 6 3 2"
        # The tools of the one that was touched are large enough, and can be reached at each edge.
        for kind in ("lamp", "gauge", "number"):
            shown(tablet, kind).tap(position={"x": 15, "y": 12})
            assert page.locator(".widget-tools:visible").count() == 1
            assert page.evaluate(LOOK) == NOTHING, kind
            box = shown(tablet, kind).locator(".widget-corner").bounding_box()
            assert min(box["width"], box["height"]) >= LEAST
        tablet.button("Settings of kP").tap()
        page.get_by_label("Title").fill("P")
        page.keyboard.press("Enter")
        page.keyboard.press("Escape")
        tablet.button("Remove P").tap()
        for _ in range(5):
            tablet.button("Undo").tap()
        assert arranged(tablet) == ["Drive", "lamp 8 5 1 1", "gauge 2 1 2 2", "number 0 0 1 1"]
        # A value and a table from NetworkTables, also when nothing is arranged yet.
        tablet.button("Cancel").tap()
        tablet.button("Put doubled on the dashboard").tap()
        tablet.button("Put Turn on the dashboard").tap()
        assert arranged(tablet)[4:] == ["number 1 0 2 1", "pid 4 0 3 3"]
        shown(tablet, "pid").locator(".widget-tools:visible").wait_for()
        # A table without a type, whose name is too long, does not push its button off.
        tablet.simulation.write({f"nt:/{LONG}/one": 1.0})
        page.locator(".nt-row.folder", has_text=LONG).wait_for()
        assert page.evaluate(LOOK) == NOTHING
