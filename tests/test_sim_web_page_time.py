"""The page of `pyfrc sim` in a real browser: plots, the timeline, failures, the console, layouts, windows."""

from __future__ import annotations

import json
import threading
from typing import Any

import pytest
from browser_pages import ROBOT, Seen, page_of
from playwright.sync_api import expect
from web_pages import Served, served


def drive(person: Seen, seconds: float = 1.0) -> None:
    """Drive for some robot time, and pause."""
    person.button("Enable").click()
    person.page.keyboard.down("w")
    person.until(lambda: person.value("pwm[0].value") == 1)
    since = person.simulation.snapshot.time
    person.until(lambda: person.simulation.snapshot.time >= since + seconds)
    person.page.keyboard.up("w")
    person.until(lambda: person.value("pwm[0].value") == 0)
    person.pause()


def plotted(person: Seen, panel: str = "plot:1") -> list[str]:
    return person.page.locator(f"[data-panel='{panel}'] .curve-name").all_inner_texts()


def test_values_are_plotted_zoomed_and_saved(person: Seen) -> None:
    page = person.page
    person.choose("Layout", "Tuning")
    page.locator("[data-panel='plot:1']").wait_for()
    person.tab("Devices").click()
    row = person.row("pwm[0].value")
    row.hover()
    row.get_by_label("Plot 0 left motor").click()
    page.locator(".curve-name", has_text="left motor").wait_for()
    row = person.row("dio[3].value")
    row.drag_to(page.locator("[data-panel='plot:1'] .plot-area"))
    page.locator(".curve-name", has_text="Digital I/O 3").wait_for()
    assert plotted(person) == ["PWM 0 left motor", "Digital I/O 3"]
    drive(person)
    plot = page.locator("[data-panel='plot:1']")
    plot.locator("canvas.plot-bands").wait_for()
    person.button("All").first.click()
    # Where the pointer is, the value of that moment is shown: 1 while the key was held, 0 before.
    over = plot.locator(".u-over")
    over.hover(position={"x": 3, "y": 20})
    value = plot.locator(".legend li", has_text="left motor").locator("b")
    value.filter(has_text="0").wait_for()
    person.drag(over, (0.2, 0.5), (0.99, 0.5))  # a slow machine drives late
    person.button("Follow again").wait_for()
    with page.expect_download() as download:
        person.button("Save the values as CSV").first.click()
    lines = download.value.path().read_text("utf-8").splitlines()
    assert lines[0] == "t,pwm[0].value,dio[3].value"
    assert any(line.split(",")[1] == "1" for line in lines[1:])
    person.button("Follow again").click()
    page.get_by_label("axis, of pwm[0].value").click()
    page.get_by_label("axis, of pwm[0].value").filter(has_text="right axis").wait_for()
    page.get_by_label("Remove dio[3].value").click()
    page.reload()
    page.locator(".curve-name", has_text="left motor").wait_for()
    assert plotted(person) == ["PWM 0 left motor"]


#: A series as the page has it, and as the history of the server has it.
SERIES = """async (path) => {
  const { watch } = await module("js/series.js");
  const { ask } = await module("js/connection.js");
  const answer = await ask("plot", { paths: [path], from: 0, to: 1e6, points: 20000, branch: null });
  const rounded = ({ t, v }) => t.map((time, index) => `${time.toFixed(2)} ${v[index].toFixed(3)}`);
  return [rounded(watch(path)), rounded(answer.series[path])];
}"""


def same_series(person: Seen, path: str) -> None:
    """Wait until the page has what the server has, without holes."""
    person.page.get_by_role("button", name="Run", exact=True).first.wait_for()
    person.eventually(SERIES, path, lambda found: set(found[0]) == set(found[1]))  # the last samples are on their way


def test_curves_have_no_holes_when_they_are_added_or_a_run_goes_on(person: Seen) -> None:
    page = person.page
    add = "path => module('js/plotting.js').then(({ addToPlot }) => addToPlot(path, 'plot:1'))"
    person.button("Enable").click()
    page.keyboard.down("w")
    person.until(lambda: person.value("pwm[0].value") == 1)
    page.evaluate(add, "sim.pose[0]")
    since = person.simulation.snapshot.time
    person.until(lambda: person.simulation.snapshot.time > since + 0.3)
    page.evaluate(add, "pwm[0].value")
    person.until(lambda: person.simulation.snapshot.time > since + 0.6)
    page.keyboard.press("F5")
    same_series(person, "sim.pose[0]")
    person.simulation.rewind(since)
    person.until(lambda: person.simulation.status.state == "paused" and person.simulation.snapshot.time <= since + 0.02)
    page.keyboard.press("F5")
    person.until(lambda: person.simulation.snapshot.time > since + 0.4)
    page.keyboard.press("F5")
    same_series(person, "sim.pose[0]")


def test_marks_and_moments_are_found_on_the_timeline(person: Seen) -> None:
    page = person.page
    drive(person)
    timeline = page.get_by_role("slider", name="Timeline")
    box = timeline.bounding_box()
    # The timeline has 10 s at least, between two edges of 8 pixels.
    whole = max(person.simulation.status.length, 10)

    def x(seconds: float) -> float:
        return 8 + seconds / whole * (box["width"] - 16)

    page.mouse.move(box["x"] + x(0.2), box["y"] + 14)
    page.mouse.down()
    page.mouse.move(box["x"] + x(0.5), box["y"] + 14, steps=5)
    page.mouse.up()
    page.locator(".clock", has_text="0:00.5").wait_for()
    page.get_by_role("button", name="Mark", exact=True).click()
    page.get_by_label("A mark at").fill("<i>here</i>")
    page.keyboard.press("Enter")
    timeline.hover(position={"x": x(0.5), "y": 14})
    page.locator(".timeline-tip", has_text="<i>here</i>").wait_for()
    page.keyboard.press("Tab")  # the keys reach what the mouse reaches
    # A file that is there is replaced after a question.
    file = person.simulation.project.root / "kept/drive.jsonl"
    file.parent.mkdir()
    file.write_text("mine")
    for answer in ("Cancel", "Replace"):
        assert file.read_text() == "mine"
        person.choose("Restart, save, end", "Save the recording")
        page.get_by_label("Save the recording").fill("kept/drive.jsonl")
        page.keyboard.press("Enter")
        page.get_by_text("kept/drive.jsonl exists. Replace it?").wait_for()
        person.button(answer).click()
        page.locator("dialog").wait_for(state="detached")
    page.get_by_text("Saved kept/drive.jsonl").wait_for()
    assert file.read_text() != "mine"
    page.get_by_label("Hide this message").click()
    page.get_by_text("Saved kept/drive.jsonl").wait_for(state="detached")


def test_a_robot_that_floods_the_console_or_hangs_leaves_the_page_alive(person: Seen) -> None:
    page = person.page
    person.button("Enable").click()
    page.keyboard.down("9")
    page.locator(".line-text", has_text="flood").first.wait_for()
    page.get_by_label("Search the output").fill("flood 299")
    page.locator(".line-text", has_text="flood 299").first.wait_for()
    page.keyboard.press("Enter")  # in the box: it does not disable the robot
    assert person.simulation.snapshot.enabled
    page.keyboard.up("9")
    page.locator(".field-canvas").click(position={"x": 5, "y": 5})
    page.keyboard.down("8")
    person.state("Not responding")
    page.keyboard.up("8")
    person.tab("NetworkTables").click()
    page.get_by_label("Search NetworkTables").wait_for()
    page.keyboard.press("F9")
    person.state("Teleoperated disabled")


def test_panels_are_moved_sized_closed_and_stay_so(person: Seen) -> None:
    page = person.page
    person.tab("Console").hover()
    person.button("Close Console").click()
    person.tab("Console").wait_for(state="detached")
    person.choose("Open and close panels", "Dashboard")
    person.tab("Dashboard").wait_for()
    # A tab that is dragged to the edge of another panel gets a place of its own.
    target = page.locator("[data-panel='devices']")
    box = target.bounding_box()
    page.locator(".tab", has_text="Match").drag_to(
        target, target_position={"x": box["width"] / 2, "y": box["height"] - 12}
    )
    below = page.locator("[data-panel='match']")
    page.wait_for_function(
        "left => Math.abs(document.querySelector(\"[data-panel='match']\").getBoundingClientRect().left - left) < 3",
        arg=box["x"],
    )
    width = below.bounding_box()["width"]
    border = page.get_by_role("separator").first
    border.focus()
    page.keyboard.press("ArrowDown")
    vertical = page.locator("[role=separator][aria-orientation=vertical]").first
    vertical.focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function(
        "width => document.querySelector(\"[data-panel='match']\").getBoundingClientRect().width > width + 10",
        arg=width,
    )
    # Also by the mouse.
    before = vertical.bounding_box()["x"]
    person.drag(vertical, (0.5, 0.5), (20, 0.5))
    page.wait_for_function(
        "x => document.querySelector('[role=separator][aria-orientation=vertical]').getBoundingClientRect().x > x + 20",
        arg=before,
    )
    # Tabs by keys.
    first = page.get_by_role("tablist").nth(0).get_by_role("tab").first
    name = first.inner_text()
    first.focus()
    page.keyboard.press("ArrowRight")
    expect(person.tab(name)).to_have_attribute("aria-selected", "false")
    expect(person.tab(name)).not_to_be_focused()
    page.keyboard.press("ArrowLeft")
    expect(person.tab(name)).to_be_focused()
    page.keyboard.press("Delete")
    person.tab(name).wait_for(state="detached")
    page.get_by_title("Dark colours").click()
    page.reload()
    below.wait_for()
    assert below.bounding_box()["width"] > width + 10
    assert person.tab("Console").count() == 0
    assert page.locator("html").get_attribute("data-theme") == "dark"
    # A menu by keys.
    menu = page.get_by_title("Layout", exact=True)
    menu.focus()
    for key in ("Enter", "ArrowDown", "ArrowDown", "ArrowUp", "Escape"):
        page.keyboard.press(key)
    page.locator(".menu-list:popover-open").wait_for(state="detached")
    expect(menu).to_be_focused()
    page.keyboard.press("Enter")
    page.locator(".menu-list:popover-open").wait_for()
    for key in ("ArrowDown", "ArrowDown", "ArrowDown", "Enter"):
        page.keyboard.press(key)
    expect(menu).to_have_text("Tuning")
    person.choose("Layout", "Driving")
    person.choose("Layout", "Reset this layout")
    person.tab("Console").wait_for()


def saved_layout(server: Served) -> Any:
    file = server.simulation.project.root / ".pyfrc" / "sim-layout.json"
    return json.loads(file.read_text()) if file.is_file() else {}


def test_two_windows_arrange_the_page_together(person: Seen) -> None:
    with person.page.context.new_page() as second:
        other = Seen(second, person.server).open()
        person.page.get_by_label("Dark colours").click()
        person.until(lambda: saved_layout(person.server).get("theme") == "dark")
        other.choose("Layout", "Tuning")
        other.tab("Mechanism").click()
        person.until(lambda: saved_layout(person.server).get("trees"))
    found = saved_layout(person.server)
    assert (found["theme"], found["layout"], list(found["trees"])) == ("dark", "tuning", ["tuning"])
    person.page.reload()
    person.page.get_by_label("Light colours").wait_for()
    person.page.get_by_title("Layout", exact=True).get_by_text("Tuning").wait_for()


def test_a_branch_that_is_longer_than_the_present_is_shown_whole(person: Seen) -> None:
    page = person.page
    person.simulation.enable()
    person.simulation.set_axis(0, 0, 0.5)  # it turns, so that something changes
    person.simulation.set_speed(0)
    person.until(lambda: person.simulation.snapshot.time > 30)
    person.pause()
    long = person.simulation.snapshot.time
    page.evaluate("module('js/plotting.js').then(({ addToPlot }) => addToPlot('pwm[0].value', 'plot:1'))")
    person.button("All").first.click()
    person.simulation.rewind(1.0)
    person.until(lambda: person.simulation.snapshot.time == pytest.approx(1.0))
    page.get_by_title("Compare with an earlier run").click()
    page.get_by_role("menuitemcheckbox", name="before 0:01.00").last.click()
    shown = """async () => {
      const { compared } = await module("js/compare.js");
      const { length } = await module("js/past.js");
      return [length(), compared.end];
    }"""
    page.locator(".u-over").first.wait_for()
    present, end = person.eventually(shown, accept=lambda found: found[1] > 0)
    assert (present, end) == (pytest.approx(1.0), pytest.approx(long))
    # The pointer is at a moment that only the branch has, and the plot's own curve has no value there.
    page.locator("[data-panel='plot:1'] .u-over").hover(position={"x": 200, "y": 20})
    expect(page.locator("[data-panel='plot:1'] .legend b").first).to_have_text("\N{EN DASH}")


def test_the_page_says_that_the_simulation_was_closed(browser, make_project) -> None:
    with served(make_project(ROBOT), speed=1, paused=False) as server, page_of(browser, server) as person:
        server.front_end.close()
        person.page.get_by_text("The simulation was closed. This is its last state.").wait_for()
        person.page.locator(".live-now", has_text="Ended").wait_for()
        assert person.button("Enable").is_disabled()
        person.state("Ended")
        person.wrong.clear()  # the browser's own words about the lost connection


def test_a_server_that_was_silent_is_connected_again(browser, server) -> None:
    with page_of(browser, server) as person:
        page = person.page
        page.evaluate("window.notReloaded = true")
        loop = server.front_end.server._loop
        awake = threading.Event()
        loop.call_soon_threadsafe(awake.wait)  # nothing is sent, and no connection is closed
        try:
            page.get_by_text("The connection to pyfrc sim was lost, reconnecting").wait_for()
            assert person.button("E-STOP").is_disabled()
            server.simulation.choose_mode("autonomous")
            person.choose("Layout", "Tuning")
            page.wait_for_function("() => sessionStorage.getItem('pyfrc-unsaved')?.includes('tuning')")
        finally:
            awake.set()
        page.get_by_text("reconnecting").wait_for(state="detached")
        saved = server.simulation.project.root / ".pyfrc" / "sim-layout.json"
        while not (saved.exists() and '"layout": "tuning"' in saved.read_text("utf-8")):
            page.wait_for_timeout(50)  # it is saved with the new connection
        assert page.locator(".notice").count() == 0
        person.state("Autonomous disabled")
        page.locator(".live-now", has_text="Live").wait_for()
        server.simulation.enable()  # now: a robot that the last driver has left is disabled
        person.state("Autonomous enabled")
        page.keyboard.press("Enter")
        person.state("Autonomous disabled")
        assert page.evaluate("window.notReloaded")
        person.wrong.clear()  # the browser's own words about attempts that came to nothing
