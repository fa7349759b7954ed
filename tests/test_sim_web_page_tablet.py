"""The page on a tablet: fingers, no pointer that hovers, 1180 by 820 pixels; on phones, and in windows of any size."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from browser_pages import Seen, page_of
from playwright.sync_api import Locator, expect

SIZE = {"width": 1180, "height": 820}
#: The least width and height of what a thumb hits, in pixels.
LEAST = 44

#: What cannot be reached, although it is no part of what scrolls; and what is too small for a thumb.
LOOK = """() => {
  const hidden = [];
  const small = [];
  const lists = ["auto", "scroll"];
  const top = document.querySelector("dialog, .menu-list:popover-open") ?? document;
  for (const each of top.querySelectorAll("button, input, select, summary, a, [tabindex='0'][role]")) {
    const label = ["checkbox", "radio"].includes(each.type) ? each.closest("label:not(.switch)") : null;
    const element = label ?? each.closest(".search") ?? each;
    const box = element.getBoundingClientRect();
    if (!box.width || !box.height || each.closest(".lines, .failure-text")) continue; // parts of lines of text
    const name = each.ariaLabel || each.title || each.textContent || each.className;
    let [scrollsX, scrollsY, isCut] = [false, false, false];
    for (let outer = element.parentElement; outer; outer = outer.parentElement) {
      const style = getComputedStyle(outer);
      const isAll = outer === document.documentElement;
      const limits = isAll ? new DOMRect(0, 0, innerWidth, innerHeight) : outer.getBoundingClientRect();
      scrollsX ||= lists.includes(style.overflowX);
      scrollsY ||= lists.includes(style.overflowY);
      const cutsX = style.overflowX !== "visible" || isAll;
      const cutsY = style.overflowY !== "visible" || isAll;
      isCut ||= cutsX && !scrollsX && (box.left < limits.left - 1 || box.right > limits.right + 1);
      isCut ||= cutsY && !scrollsY && (box.top < limits.top - 1 || box.bottom > limits.bottom + 1);
    }
    if (isCut) hidden.push(name);
    const around = getComputedStyle(each, "::after"); // where fingers hit a border, too
    const [width, height] = ["width", "height"].map((size) => Math.max(box[size], parseFloat(around[size]) || 0));
    if (Math.min(width, height) < LEAST) small.push(`${name}: ${width} x ${height}`);
  }
  return { hidden, small };
}""".replace("LEAST", str(LEAST))


NOTHING: dict[str, list[str]] = {"hidden": [], "small": []}


@pytest.fixture(name="tablet")
def person_with_a_tablet(browser: Any, server: Any) -> Iterator[Seen]:
    with page_of(browser, server, has_touch=True) as person:
        person.page.set_viewport_size(SIZE)
        yield person


def show_tab(tab: Locator) -> None:
    """Tap a tab, and wait until its panel is in front."""
    tab.tap()
    expect(tab).to_have_attribute("aria-selected", "true")


class Fingers:
    """Fingers on the screen, each at a place of an element, as a share of its width and height."""

    def __init__(self, person: Seen) -> None:
        self._person = person
        self._devices = person.page.context.new_cdp_session(person.page)
        self._points: dict[int, dict[str, float]] = {}

    def put(self, finger: int, place: Any, x: float, y: float) -> None:
        """Put a finger down, or move it."""
        box = place.bounding_box()
        point = {"x": box["x"] + x * box["width"], "y": box["y"] + y * box["height"], "id": finger}
        kind = "touchMove" if finger in self._points else "touchStart"
        self._points[finger] = point
        self._send(kind)

    def lift(self) -> None:
        """Lift all of them, and wait until what was moved is drawn where the next finger looks for it."""
        self._points.clear()
        self._send("touchEnd")
        self._person.drawn()

    def _send(self, kind: str) -> None:
        points = list(self._points.values())
        self._devices.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


def axes(person: Seen, stick: int) -> Any:
    return person.value(f"joysticks[{stick}].axes")


def sets_and_plots_a_value_without_a_pointer_that_hovers(tablet: Seen) -> None:
    page = tablet.page
    page.locator(".nt-row.folder button", has_text="SmartDashboard").wait_for()
    row = tablet.row("nt:/SmartDashboard/kP")
    row.get_by_role("button", name="Plot kP").tap()
    page.locator(".legend", has_text="kP").wait_for()
    assert page.evaluate(LOOK) == NOTHING
    tablet.row("nt:/SmartDashboard/flag").get_by_role("switch").tap()
    tablet.until(lambda: any(step.writes.get("nt:/SmartDashboard/flag") for step in tablet.simulation.script().steps))
    # The moment at the middle of the timeline, and the present again.
    page.get_by_role("slider", name="Timeline").tap()
    page.locator(".timebar.past").wait_for()
    page.get_by_role("button", name="Live", exact=True).tap()
    page.locator(".timebar:not(.past)").wait_for()


def test_two_thumbs_drive(tablet: Seen) -> None:
    page = tablet.page
    assert page.get_by_title("Layout", exact=True).inner_text() == "Tablet"  # nothing else was chosen
    sets_and_plots_a_value_without_a_pointer_that_hovers(tablet)
    tablet.button("Enable").tap()
    tablet.state("Teleoperated enabled")
    left, right = (page.get_by_label(f"{side} stick") for side in ("Left", "Right"))
    for place, low, high in ((left, 0.0, 0.3), (right, 0.7, 1.0)):
        box = place.bounding_box()
        assert low * SIZE["width"] <= box["x"]
        assert box["x"] + box["width"] <= high * SIZE["width"]
        assert box["width"] >= 3 * LEAST
    fingers = Fingers(tablet)
    fingers.put(1, left, 0.5, 0.5)
    fingers.put(2, right, 0.5, 0.5)
    fingers.put(1, left, 0.5, 0.0)
    fingers.put(2, right, 0.5, 1.0)
    tablet.until(lambda: axes(tablet, 0)[1] == -1 and axes(tablet, 1)[1] == 1)
    fingers.lift()
    tablet.until(lambda: axes(tablet, 0)[1] == 0 and axes(tablet, 1)[1] == 0)
    fingers.put(1, left, 0.5, 0.5)
    fingers.put(2, page.locator(".touch").get_by_role("button", name="2", exact=True), 0.5, 0.5)
    tablet.until(lambda: tablet.value("joysticks[0].buttons")[2])
    fingers.lift()
    tablet.until(lambda: not tablet.value("joysticks[0].buttons")[2])
    page.get_by_role("button", name="E-STOP").tap()
    tablet.state("Emergency stopped")


def look_at_tabs(person: Seen) -> None:
    """Look at the panel of each tab."""
    for tab in person.page.locator(".tab > [role=tab]").all():
        show_tab(tab)
        assert person.page.evaluate(LOOK) == NOTHING, tab.inner_text()


def test_nothing_is_off_the_screen_and_thumbs_hit_it(tablet: Seen) -> None:
    page = tablet.page
    for layout in ("Tuning", "Driving", "Dashboard", "Tablet"):
        page.get_by_title("Layout", exact=True).tap()
        page.locator(".menu-list button", has_text=layout).first.tap()
        page.get_by_title("Layout", exact=True).filter(has_text=layout).wait_for()
        look_at_tabs(tablet)
    # A phone and an upright tablet: most of the screen is for the panels, also when a phone lies.
    for width, height in ((390, 844), (844, 390), (768, 1024)):
        page.set_viewport_size({"width": width, "height": height})
        tablet.drawn()
        look_at_tabs(tablet)
        dock = page.locator(".dock").bounding_box()
        assert dock is not None
        assert dock["height"] > 0.5 * height


def test_thumbs_hit_what_a_person_opens(tablet: Seen) -> None:
    page = tablet.page
    page.set_viewport_size({"width": 768, "height": 1024})
    found: dict[str, Any] = {}

    def look_into(title: str) -> None:
        page.get_by_title(title, exact=True).or_(tablet.button(title)).first.tap()
        page.locator("dialog, .menu-list:popover-open").wait_for()
        found[title] = page.evaluate(LOOK)
        page.keyboard.press("Escape")

    for title in ("Layout", "Open and close panels", "Restart, save, end", "What is drawn", "Mark"):
        look_into(title)
    page.evaluate("module('js/plotting.js').then(({ addToPlot }) => addToPlot('nt:/SmartDashboard/kP', 'plot:1'))")
    show_tab(tablet.tab("Plot 1"))
    for title in ("Settings of kP", "Axes", "Add value"):
        look_into(title)
    tablet.button("Table").tap()
    found["Table"] = page.evaluate(LOOK)
    tablet.choose("Layout", "Dashboard")
    look_into("Dashboards of this project")
    tablet.button("New dashboard…").tap()
    tablet.button("OK").tap()
    tablet.button("Add widget").tap()
    page.get_by_label("Search all values").fill("kP")
    page.keyboard.press("Enter")
    for title in ("Settings of kP", "Grid", "Add widget"):
        look_into(title)
    assert {title: each for title, each in found.items() if each != NOTHING} == {}


# -- the emergency stop and the robot's state, in windows of any size

LAYOUTS = ["Driving", "Tablet", "Tuning", "Dashboard"]
#: Also those of 1366 by 768 at 150 %, and of 1280 by 800 at 133 %.
WIDTHS = [640, 700, 800, 853, 901, 961, 1024, 1100, 1180, 1281, 1500]
SIZES = [*((width, 400) for width in WIDTHS), (640, 900), (911, 512), (960, 600), (1366, 768)]
#: What is not whole in the window, or has something else before it.
IN_SIGHT = """(names) => names.flatMap((name) => {
  const element = document.querySelector(name);
  if (!element) return [`${name} is missing`];
  const box = element.getBoundingClientRect();
  const [across, down] = [box.left >= 0 && box.right <= innerWidth, box.top >= 0 && box.bottom <= innerHeight];
  if (!box.width || !across || !down) return [`${name} is at ${box.left}, ${box.top}, ${box.right}, ${box.bottom}`];
  const front = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
  if (!element.contains(front)) return [`${name} is behind ${front?.className}`];
  return element.scrollWidth > element.clientWidth + 1 ? [`${name} is cut`] : [];
})"""
ALWAYS = [".estop", ".state .lamp", ".state b"]


def show_layout(seen: Seen, layout: str) -> None:
    """Show a layout, without its menu: the window has just changed its size."""
    setting = "(layout) => module('js/settings.js').then(({ settings }) => settings.set('layout', layout))"
    seen.page.evaluate(setting, layout.lower())
    seen.page.get_by_title("Layout", exact=True).filter(has_text=layout).wait_for()


def out_of_sight(seen: Seen, width: int, height: int) -> list[str]:
    seen.page.set_viewport_size({"width": width, "height": height})
    seen.drawn()
    return [f"{width} x {height}: {each}" for each in seen.page.evaluate(IN_SIGHT, ALWAYS)]


#: What makes the bar longer: more windows, a hint, opmodes as robots of 2027 have, a match, the past.
CROWDED = """async () => {
  const { model } = await module("js/model.js");
  model.set("clients", 12);
  model.set("hint", "A joystick is not plugged in: port 0 of the driver station has none, and robot code reads it");
  model.set("opmodes", [{ mode: "teleop", name: "Everything at the same time", group: "", description: "" }]);
}"""


#: What of the two bars is outside of the window, and how far apart the rows of the upper one are; and the page's size.
FITS = """() => {
  const all = (names) => [...document.querySelectorAll(names)].map((each) => [each, each.getBoundingClientRect()]);
  const isOutside = (box) => box.right > innerWidth + 1 || box.bottom > innerHeight + 1;
  const outside = all(".station button, .timebar button").filter(([, box]) => isOutside(box));
  const rows = all(".station > button, .station > .menu").map(([, box]) => (box.top + box.bottom) / 2);
  const { scrollWidth, scrollHeight } = document.documentElement;
  const isOneRow = Math.max(...rows) - Math.min(...rows) < 5;
  return [outside.map(([each]) => each.textContent), isOneRow, [scrollWidth, scrollHeight]];
}"""


def test_windows_of_any_size_have_everything_in_sight(browser: Any, server: Any) -> None:
    with page_of(browser, server, color_scheme="dark") as person:
        page = person.page
        assert page.locator("html").get_attribute("data-theme") == "dark"
        for layout in LAYOUTS:
            show_layout(person, layout)
            for width, height in ((1366, 768), (3840, 2160), (820, 1180)):
                page.set_viewport_size({"width": width, "height": height})
                person.drawn()
                assert page.evaluate(FITS) == [[], True, [width, height]], (width, layout)
        # The emergency stop, also where there is less room, and when the bar is full.
        page.set_viewport_size({"width": 1366, "height": 768})
        person.button("Practice").click()
        person.state("Autonomous enabled")
        page.evaluate(CROWDED)
        wrong = []
        for layout in LAYOUTS:
            show_layout(person, layout)
            wrong += [f"{layout}: {each}" for size in SIZES for each in out_of_sight(person, *size)]
        person.button("E-STOP").click()
        person.state("Emergency stopped")
        page.evaluate(CROWDED)  # the hint is shown to a robot that is not enabled
        wrong += [each for size in SIZES for each in out_of_sight(person, *size)]
        assert wrong == []
