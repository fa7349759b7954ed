"""Plots on the page: axes, units, derivatives, differences, statistics, and the parts of structs and lists."""

from __future__ import annotations

import re

import pytest
from browser_pages import Seen

PLOT = "[data-panel='plot:1']"
#: A promise of what the page keeps of this plot.
CONFIG = "module('js/plotting.js').then(({ plotOf }) => plotOf('plot:1'))"
ADD = "paths => module('js/plotting.js').then(({ addToPlot }) => paths.forEach((path) => addToPlot(path, 'plot:1')))"


@pytest.fixture(name="drove")
def drive_once(person: Seen) -> Seen:
    """Drive in an arc, with the robot's x and y in a plot, and pause."""
    person.choose("Layout", "Tuning")
    person.page.evaluate(ADD, ["sim.pose[0]", "sim.pose[1]"])
    person.page.get_by_label("Settings of sim.pose[1]").wait_for()
    person.simulation.enable()
    person.simulation.set_axis(0, 1, -1.0)
    person.simulation.set_axis(0, 0, 0.3)
    person.until(lambda: person.simulation.snapshot.scene.robot.x > 12)
    person.pause()
    return person


def shown(person: Seen, key: str) -> float:
    """Return the number that the legend shows for a curve."""
    person.drawn()
    one = person.page.locator(f"{PLOT} .legend li").filter(has=person.page.get_by_label(f"Remove {key}", exact=True))
    return float(one.locator("b").inner_text())


def limits(person: Seen, axis: str) -> list[float]:
    """Return what the boxes of an axis show."""
    person.drawn()
    person.page.locator(PLOT).get_by_role("button", name="Axes").click()
    found = [float(person.page.get_by_label(f"{axis} axis {end}").input_value()) for end in ("from", "to")]
    person.page.keyboard.press("Escape")
    person.page.get_by_label("Left axis from").wait_for(state="detached")
    return found


def settings(person: Seen, key: str, **chosen: str) -> None:
    """Choose settings of a curve."""
    person.page.get_by_label(re.compile(f"^Settings of {re.escape(key)}, ")).click()
    for label, option in chosen.items():
        person.page.get_by_label(label.replace("_", " "), exact=True).select_option(option)
    person.page.keyboard.press("Escape")
    person.page.locator(".curve-settings").wait_for(state="detached")


def test_a_curve_is_shown_in_another_unit_as_a_derivative_or_without_another_one(drove: Seen) -> None:
    feet = shown(drove, "sim.pose[0]")
    assert feet == pytest.approx(drove.simulation.snapshot.scene.robot.x, abs=1e-3)
    settings(drove, "sim.pose[0]", Shown_in="m")
    assert shown(drove, "sim.pose[0]") == pytest.approx(feet * 0.3048, abs=1e-3)
    drove.page.locator(f"{PLOT} .unit", has_text="m").first.wait_for()
    settings(drove, "sim.pose[0]", Show="derivative")
    drove.page.locator(f"{PLOT} .unit", has_text="m/s").wait_for()
    pose = drove.page.evaluate(
        "module('js/series.js').then(({ watch }) => ({ t: watch('sim.pose[0]').t, v: watch('sim.pose[0]').v }))"
    )
    slope = (pose["v"][-1] - pose["v"][-2]) / (pose["t"][-1] - pose["t"][-2])
    assert shown(drove, "sim.pose[0]") == pytest.approx(slope * 0.3048, rel=0.01)
    settings(drove, "sim.pose[0]", Show="", Shown_in="ft", Minus="sim.pose[1]")
    drove.page.locator(".curve-name", has_text="Robot x \N{MINUS SIGN} Robot y").wait_for()
    assert shown(drove, "sim.pose[0]") == pytest.approx(feet - shown(drove, "sim.pose[1]"), abs=1e-3)
    # The same value once more, as what it adds up to; the file has what is plotted.
    drove.page.get_by_label("Settings of sim.pose[1]").click()
    drove.page.get_by_role("button", name="Add this value once more").click()
    settings(drove, "sim.pose[1] (2)", Show="integral")
    drove.page.locator(f"{PLOT} .unit", has_text="ft·s").wait_for()
    y = [drove.simulation.snapshot.scene.robot.y, 12]
    whole = drove.simulation.snapshot.time
    assert min(y) * whole * 0.9 <= shown(drove, "sim.pose[1] (2)") <= max(y) * whole * 1.1
    with drove.page.expect_download() as download:
        drove.page.locator(PLOT).get_by_role("button", name="Save the values as CSV").click()
    lines = download.value.path().read_text("utf-8").splitlines()
    assert lines[0] == 't,"Robot x \N{MINUS SIGN} Robot y, ft",sim.pose[1],"∫ Robot y, ft·s"'
    assert float(lines[-1].split(",")[3]) == pytest.approx(shown(drove, "sim.pose[1] (2)"), rel=0.01)


def test_axes_tables_and_colours(drove: Seen) -> None:
    page = drove.page
    automatic = limits(drove, "Left")
    page.locator(f"{PLOT} .u-axis.axis-handle").hover()
    page.mouse.wheel(0, -300)
    drove.eventually(f"{CONFIG}.then(({{ ranges }}) => ranges?.left)")
    low, high = limits(drove, "Left")
    assert high - low < 0.9 * (automatic[1] - automatic[0])
    page.locator(PLOT).get_by_role("button", name="Axes").click()
    drove.set_number(page.get_by_label("Left axis to"), "100")
    drove.set_number(page.get_by_label("Left axis from"), "200")
    page.get_by_text("Left axis: the axis ends at 100, which is not above 200").wait_for()
    drove.set_number(page.get_by_label("Left axis from"), "-50")
    assert page.get_by_label("Lock the left axis").is_checked()
    page.get_by_label("Keep the time that is shown").check()
    drove.button("Follow again").wait_for()
    page.get_by_label("Keep the time that is shown").uncheck()
    page.keyboard.press("Escape")
    page.reload()
    page.locator(f"{PLOT} .uplot").wait_for()
    assert limits(drove, "Left") == [-50, 100]
    page.locator(f"{PLOT} .u-axis.axis-handle").dblclick()
    drove.eventually(f"{CONFIG}.then(({{ ranges }}) => !ranges.left)")
    assert limits(drove, "Left") == pytest.approx(automatic, abs=0.1)
    # A table has statistics of what is in view.
    drove.button("All").first.click()
    page.locator(PLOT).get_by_role("button", name="Table", exact=True).click()
    cells = page.locator(f"{PLOT} tbody tr", has_text="Robot x").locator("td.number")
    cells.first.wait_for()
    value, low, mean, high = (
        float(each) for each in cells.locator("b").all_inner_texts() + cells.all_inner_texts()[1:]
    )
    assert low == pytest.approx(10, abs=0.01)
    assert value == pytest.approx(drove.simulation.snapshot.scene.robot.x, abs=1e-3)
    assert low < mean < high
    drove.drag(page.locator(f"{PLOT} .u-over"), (0.3, 0.5), (0.6, 0.5))
    drove.button("Follow again").wait_for()
    assert float(cells.nth(3).inner_text()) < high
    page.get_by_label("Hide sim.pose[0]").click()
    page.get_by_label("Show sim.pose[0]").click()
    page.locator(PLOT).get_by_role("button", name="Table", exact=True).click()
    page.locator(f"{PLOT} .curve-table").wait_for(state="detached")
    # More curves than colours look different.
    page.evaluate(ADD, [f"joysticks[0].axes[{number}]" for number in range(6)])
    page.evaluate(ADD, [f"joysticks[1].axes[{number}]" for number in range(6)])
    page.locator(f"{PLOT} .curve-name").nth(13).wait_for()
    samples = page.locator(f"{PLOT} .swatch").evaluate_all("all => all.map((each) => each.getAttribute('style'))")
    assert len(samples) == len(set(samples)) == 14
    page.get_by_label("Settings of joysticks[1].axes[5]").click()
    page.get_by_label("Colour 1").click()
    page.get_by_label("Line: dotted").click()
    page.keyboard.press("Escape")
    colors = page.evaluate(
        "module('js/plotting.js').then(({ plotOf }) => plotOf('plot:1').curves.map(({ color }) => color))"
    )
    assert colors == [*range(13), 16]
    # The axis of time has times.
    steps = page.evaluate(
        """async () => {
          const { buildChart } = await module("js/plot_chart.js");
          const area = document.createElement("div");
          document.body.append(area);
          const found = {};
          for (const seconds of [1, 20, 150, 1200]) {
            const chart = buildChart(area, { width: 500, height: 200, lines: [{ axis: "left", color: 0 }],
              ranges: () => ({}), setRange() {}, hooks: {}, dblclick() {} }, [[0, seconds], [0, 1]]);
            chart.setScale("x", { min: 0, max: seconds });
            await new Promise(requestAnimationFrame);
            found[seconds] = chart.axes[0]._incr ?? chart.axes[0]._splits[1] - chart.axes[0]._splits[0];
            chart.destroy();
          }
          return Object.values(found);
        }"""
    )
    assert set(steps) <= {0.1, 0.2, 1, 2, 5, 15, 20, 30, 60, 120, 300}


def test_low_panels(person: Seen) -> None:
    page = person.page
    person.choose("Layout", "Tuning")
    page.evaluate(ADD, ["sim.pose[0]"])
    page.get_by_label("Settings of sim.pose[0]").wait_for()
    follow, chart = person.button("Follow again"), page.locator(f"{PLOT} .u-over")
    person.drawn()  # then the chart is no longer another one
    chart.hover()
    page.mouse.wheel(0, -200)  # nothing scrolls
    follow.click()
    page.evaluate(ADD, ["sim.mode", "dio[3].value", "alliance_station"])
    page.set_viewport_size({"width": 1366, "height": 700})
    page.get_by_label("Settings of alliance_station").wait_for()
    person.drawn()
    page.locator(f"{PLOT} .plot-bands").hover()
    page.mouse.wheel(0, 400)
    scrolled = f"() => document.querySelector({PLOT + ' .plot'!r}).scrollTop"
    page.wait_for_function(f"{scrolled} > 0")
    chart.hover()
    page.mouse.wheel(0, -400)
    page.locator(".wheel-hint", has_text="Ctrl and the wheel").wait_for()
    page.wait_for_function(f"{scrolled} === 0")
    assert follow.count() == 0
    page.keyboard.down("Control")
    page.mouse.wheel(0, -4)  # a pinch on a trackpad
    follow.wait_for()
    page.keyboard.up("Control")
    # A chart keeps a height below many curves and above many states.
    page.set_viewport_size({"width": 1600, "height": 1000})
    paths = [
        "sim.pose[0]",
        "sim.pose[1]",
        "sim.pose[2]",
        "pwm[0].value",
        "sim.mode",
        "dio[3].value",
        "alliance_station",
    ]
    page.evaluate(ADD, paths)
    page.locator(f"{PLOT} .curve-name").nth(len(paths) - 1).wait_for()
    page.locator(f"{PLOT} .u-over").wait_for()
    for is_table in (False, True):
        if is_table:
            page.locator(PLOT).get_by_role("button", name="Table").click()
            page.locator(f"{PLOT} .curve-table").wait_for()
        person.drawn()
        least = {".u-over": 80, ".legend": 60 if is_table else 20}
        for part, height in least.items():
            assert page.locator(f"{PLOT} {part}").bounding_box()["height"] >= height
    page.locator(f"{PLOT} .plot-bands").scroll_into_view_if_needed()


MODULES = "nt:/SmartDashboard/Modules"
GOAL = "nt:/SmartDashboard/Plan/goal"


def test_structs_and_lists_unfold_into_parts_that_are_plotted_and_saved(person: Seen) -> None:
    page = person.page
    person.choose("Layout", "Tuning")
    person.tab("NetworkTables").click()
    page.locator(".nt-row.folder", has_text="SwerveModuleState[]").get_by_role("button").click()
    page.get_by_role("button", name="0", exact=True).click()
    speed = person.row(f"{MODULES}/0/speed")
    speed.locator(".nt-value", has_text="1").wait_for()
    person.set_number(person.row("nt:/SmartDashboard/kP").locator("input"), "1.5")
    speed.locator(".nt-value", has_text="3").wait_for()
    assert speed.locator("input").count() == 0
    speed.hover()
    speed.get_by_label("Plot speed").click()
    # The picker offers parts and elements by their names.
    page.locator("[data-panel='plot:1']").get_by_role("button", name="Add value").click()
    page.get_by_label("Search all values").fill("modules 3 angle")
    page.get_by_label("Search all values").press("Enter")
    page.locator(".nt-row.folder", has_text="Field2d").filter(has_text="Plan").get_by_role("button").click()
    person.row(GOAL).get_by_title("The elements of this list").click()
    element = person.row(f"{GOAL}[1]")
    element.locator(".nt-value", has_text="5.5").wait_for()
    assert element.locator("input").count() == 0
    element.hover()
    element.get_by_label("Plot [1]").click()
    for text in ("5.5", "0.7"):
        page.locator(".legend b", has_text=text).first.wait_for()
    with page.expect_download() as download:
        person.button("Save the values as CSV").first.click()
    lines = download.value.path().read_text("utf-8").splitlines()
    assert lines[0] == f"t,{MODULES}/0/speed,{MODULES}/3/angle/value,{GOAL}[1]"
    assert lines[-1].split(",")[1:] == ["3", "0.7", "5.5"]
