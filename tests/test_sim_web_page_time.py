"""The page of `pyfrc sim` in a real browser: plots, the timeline, failures, the console, layouts, windows."""

from __future__ import annotations

import threading
from functools import partial

from browser_pages import ROBOT, Seen, page_of
from web_pages import served

from pyfrc_core.sim.ui.web.runs import Runs


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
    person.choose("Restart, save, end", "Save the recording")
    page.get_by_label("Save the recording").fill("kept/drive.jsonl")
    page.keyboard.press("Enter")
    page.get_by_text("Saved kept/drive.jsonl").wait_for()
    assert (person.simulation.project.root / "kept/drive.jsonl").is_file()
    page.get_by_label("Hide this message").click()
    page.get_by_text("Saved kept/drive.jsonl").wait_for(state="detached")


def test_after_a_click_on_the_timeline_arrows_look_around_until_escape(person: Seen) -> None:
    page = person.page
    drive(person)
    timeline = page.get_by_role("slider", name="Timeline")
    timeline.click(position={"x": 20, "y": 14})
    page.locator(".timebar.past .timeline:not([aria-valuetext^=live])").wait_for()
    moment = float(timeline.get_attribute("aria-valuenow"))
    page.keyboard.press("ArrowRight")
    page.locator(f".timeline[aria-valuenow='{moment + 0.02:.2f}']").wait_for()
    page.keyboard.press("PageUp")
    page.locator(f".timeline[aria-valuenow='{min(moment + 1.02, person.simulation.status.length):.2f}']").wait_for()
    page.keyboard.press("Escape")
    page.locator(".timebar.past").wait_for(state="detached")
    page.keyboard.press("ArrowLeft")
    person.drawn()
    assert page.locator(".timebar.past").count() == 0
    # The emergency stop is the space bar, also there.
    timeline.click(position={"x": 20, "y": 14})
    page.keyboard.press(" ")
    page.locator(".timebar.past").wait_for(state="detached")
    person.state("Emergency stopped")


def test_a_crash_shows_the_line_and_the_way_back(person: Seen) -> None:
    page = person.page
    person.button("Enable").click()
    person.until(lambda: person.simulation.snapshot.enabled and person.simulation.snapshot.time > 2.5)
    page.keyboard.down("5")
    alert = page.get_by_role("alert")
    alert.locator("strong", has_text="ZeroDivisionError").wait_for()
    page.keyboard.up("5")
    assert alert.locator("strong").inner_text().startswith("robot.py:")
    assert alert.locator("a.source").get_attribute("href").startswith("vscode://file/")
    alert.locator("summary").click()
    alert.locator("pre", has_text="Traceback").wait_for()
    failed_at = person.simulation.status.failure.time
    page.locator(".live-now", has_text="Ended").wait_for()
    person.button("Load the code again").wait_for()
    person.button("Values of that moment").click()
    page.locator(".state em", has_text="past").wait_for()
    person.button("Go back 2 s and drive on").click()
    page.get_by_role("alert").wait_for(state="detached")
    person.until(lambda: person.simulation.status.state == "running")
    assert person.simulation.snapshot.time < failed_at + 60


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


def test_the_console_is_filtered_and_searched(person: Seen) -> None:
    page = person.page
    page.locator(".line.warning", has_text="this is a warning").first.wait_for()
    page.get_by_role("button", name="Warnings").click()
    page.locator(".line.warning").first.wait_for(state="detached")
    page.get_by_role("button", name="Warnings").click()
    page.get_by_label("Search the output").fill("nothing prints this")
    page.get_by_text("No line matches.").wait_for()
    page.get_by_label("Search the output").fill("WARNING")
    page.locator(".line").first.wait_for()
    assert all("arning" in text for text in page.locator(".line").all_inner_texts())


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
    page.get_by_title("Dark colours").click()
    page.reload()
    below.wait_for()
    assert below.bounding_box()["width"] > width + 10
    assert person.tab("Console").count() == 0
    assert page.locator("html").get_attribute("data-theme") == "dark"
    person.choose("Layout", "Reset this layout")
    person.tab("Console").wait_for()


def test_the_page_says_which_values_are_forgotten(browser, make_project, monkeypatch) -> None:
    monkeypatch.setattr("pyfrc_core.sim.ui.web.collector.Runs", partial(Runs, most_bytes=1))
    with served(make_project(ROBOT)) as server, page_of(browser, server) as person:
        page = person.page
        person.simulation.enable()
        person.simulation.set_axis(0, 0, 0.5)  # it turns, so that something changes
        person.simulation.set_speed(0)
        person.until(lambda: person.simulation.snapshot.time > 60)
        person.pause()
        timeline = page.get_by_role("slider", name="Timeline")
        timeline.press("Home")
        page.locator(".state em", has_text="past").wait_for()
        sentence = "were forgotten, since memory for them is limited."
        page.locator(".notice", has_text=sentence).wait_for()
        assert float(timeline.get_attribute("aria-valuenow") or 0) > 10
        timeline.hover(position={"x": 30, "y": 10})
        page.locator(".timeline-tip", has_text="Values forgotten").wait_for()


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


def test_everything_fits(browser, server) -> None:
    with page_of(browser, server, color_scheme="dark") as person:
        page = person.page
        person.simulation.set_speed(0.1)  # painting fifty updates a second would take most of the time
        assert page.locator("html").get_attribute("data-theme") == "dark"
        for size in ((1366, 768), (3840, 2160), (820, 1180)):
            page.set_viewport_size({"width": size[0], "height": size[1]})
            for layout in ("Driving", "Tuning", "Dashboard"):
                person.choose("Layout", layout)
                page.locator(".tabs").first.wait_for()
                whole = page.evaluate("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
                assert whole == list(size), layout
                outside = page.locator(".station button, .timebar button").evaluate_all(
                    "all => all.map((each) => [each.textContent, each.getBoundingClientRect()])"
                    ".filter(([, box]) => box.right > innerWidth + 1 || box.bottom > innerHeight + 1)"
                    ".map(([text]) => text)"
                )
                assert outside == [], (size, layout)
                rows = page.locator(".station > button, .station > .menu").evaluate_all(
                    "all => all.map((each) => each.getBoundingClientRect()).map((box) => (box.top + box.bottom) / 2)"
                )
                assert max(rows) - min(rows) < 5, (size, layout)  # one row
