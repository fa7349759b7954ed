"""The page on a tablet: fingers, no pointer that hovers, 1180 by 820 pixels; and on phones."""

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


def test_two_thumbs_drive(tablet: Seen) -> None:
    page = tablet.page
    assert page.get_by_title("Layout", exact=True).inner_text() == "Tablet"  # nothing else was chosen
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


@pytest.mark.parametrize(
    "layout",
    ["Tablet", "Driving", "Tuning", "Dashboard"],
)
def test_nothing_is_off_the_screen_and_thumbs_hit_it(layout: str, tablet: Seen) -> None:
    page = tablet.page
    page.get_by_title("Layout", exact=True).tap()
    page.locator(".menu-list button", has_text=layout).first.tap()
    page.get_by_title("Layout", exact=True).filter(has_text=layout).wait_for()
    for tab in page.locator(".tab > [role=tab]").all():
        show_tab(tab)
        assert page.evaluate(LOOK) == {"hidden": [], "small": []}, tab.inner_text()


@pytest.mark.parametrize(("width", "height"), [(390, 844), (844, 390), (768, 1024)])
def test_a_phone_and_an_upright_tablet_reach_everything(width: int, height: int, tablet: Seen) -> None:
    page = tablet.page
    page.set_viewport_size({"width": width, "height": height})
    tablet.drawn()
    for tab in page.locator(".tab > [role=tab]").all():
        show_tab(tab)
        assert page.evaluate(LOOK) == {"hidden": [], "small": []}, tab.inner_text()
    # Most of the screen is for the panels, also when a phone lies.
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
    assert {title: each for title, each in found.items() if each != {"hidden": [], "small": []}} == {}


def test_a_value_is_set_and_plotted_without_a_pointer_that_hovers(tablet: Seen) -> None:
    page = tablet.page
    page.locator(".nt-row.folder button", has_text="SmartDashboard").wait_for()
    row = tablet.row("nt:/SmartDashboard/kP")
    row.get_by_role("button", name="Plot kP").tap()
    page.locator(".legend", has_text="kP").wait_for()
    assert page.evaluate(LOOK) == {"hidden": [], "small": []}
    tablet.row("nt:/SmartDashboard/flag").get_by_role("switch").tap()
    tablet.until(lambda: any(step.writes.get("nt:/SmartDashboard/flag") for step in tablet.simulation.script().steps))
    # The moment at the middle of the timeline, and the present again.
    page.get_by_role("slider", name="Timeline").tap()
    page.locator(".timebar.past").wait_for()
    page.get_by_role("button", name="Live", exact=True).tap()
    page.locator(".timebar:not(.past)").wait_for()
