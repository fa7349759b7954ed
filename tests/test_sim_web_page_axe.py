"""Everyone can use the page: axe-core finds nothing serious in what drivers and programmers see, light and dark."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from axe import barriers, missing_axe
from browser_pages import CHOOSER, Seen, opened_page, page_of
from skips import requires
from test_sim_web_page_dashboard import TABLE, dashboards_file, shown, with_widgets  # noqa: F401 - `file`
from web_pages import served_source
from written_logs import a_match

from pyfrc_core.project import Project
from pyfrc_core.sim.logs import open_log
from pyfrc_core.sim.logs.source import LogSource

pytestmark = requires("whether everyone can use the page", missing_axe())

THEME = """async (theme) => {
  const { applyTheme, settings } = await module("js/settings.js");
  settings.set("theme", theme);
  applyTheme();
  await Promise.allSettled(document.getAnimations().map((each) => each.finished));
}"""

#: What has been opened above everything else.
OPEN = "dialog, .menu-list:popover-open"

#: More curves than a small legend shows, and more alerts than a small card.
CURVES = ["pwm[0].value", "pwm[1].value", *(f"{TABLE}Turn/{name}" for name in "pid"), f"{TABLE}kP"]

#: What else a robot publishes.
PUBLISHED = {
    f"nt:{TABLE}Power/.type": "PowerDistribution",
    **{
        f"nt:{TABLE}Power/{name}": 12.0
        for name in ("Voltage", "TotalCurrent", *(f"Chan{number}" for number in range(24)))
    },
    f"nt:{TABLE}colour": "#80C0FF",
}

#: Each kind of widget, and one whose value the robot does not publish.
WIDGETS: list[dict[str, Any]] = [
    {"kind": "gauge", "topic": f"{TABLE}doubled", "min": 0, "max": 2, "unit": "V"},
    {"kind": "graph", "topic": f"{TABLE}doubled", "more": CURVES},
    {"kind": "field"},
    {"kind": "mechanism", "topic": f"{TABLE}Arm"},
    {"kind": "swerve", "topic": f"{TABLE}Modules", "x": 9, "y": 4, "h": 4},
    {"kind": "pid", "topic": f"{TABLE}Turn"},
    {"kind": "values", "topic": f"{TABLE}Turn", "x": 6, "y": 2},
    {"kind": "alerts", "topic": f"{TABLE}Alerts", "x": 0, "y": 4, "h": 1},
    {"kind": "state", "x": 0, "y": 5, "h": 1},
    {"kind": "time", "x": 0, "y": 6, "h": 1},
    {"kind": "input", "topic": f"{TABLE}kP", "x": 0, "y": 7, "h": 1},
    {"kind": "lamp", "topic": f"{TABLE}flag", "x": 3, "y": 4, "w": 1, "h": 1},
    {"kind": "switch", "topic": f"{TABLE}flag", "x": 4, "y": 4, "w": 2, "h": 1},
    {"kind": "text", "topic": f"{TABLE}text", "x": 3, "y": 5, "h": 1},
    {"kind": "number", "topic": f"{TABLE}kP", "x": 3, "y": 6, "h": 1},
    {"kind": "number", "topic": f"{TABLE}nothing", "x": 6, "y": 4, "h": 1},
    {"kind": "power", "topic": f"{TABLE}Power", "x": 0, "y": 2},
    {"kind": "gyro", "topic": f"{TABLE}kP", "x": 9, "y": 2},
    {"kind": "slider", "topic": f"{TABLE}kP", "x": 6, "y": 5, "h": 1},
    {"kind": "color", "topic": f"{TABLE}colour", "x": 6, "y": 6, "h": 1},
    {"kind": "chooser", "topic": f"{TABLE}{CHOOSER}", "x": 3, "y": 7, "h": 1},
]


class Eyes:
    """Who looks at the states of a page. The test fails at its end, with all that was found.

    :param themes: those of the page; a light one is looked at for its contrast only
    """

    def __init__(self, page: Any, themes: tuple[str, ...] = ("dark", "light")) -> None:
        self._page, self._themes = page, themes
        self.found: list[str] = []

    def look(self, state: str, within: str = "html") -> None:
        """Look at the page as it is, or at a part of it."""
        for theme in self._themes:
            rules = ("color-contrast",) if theme == "light" else ()
            self._page.evaluate(THEME, theme)
            self.found += [f"{state}, {theme}: {each}" for each in barriers(self._page, within, rules)]

    def look_at_tabs(self, state: str) -> None:
        self.look(state)
        for name in self._page.locator(".tab:not(.active) > [role=tab]").all_inner_texts():
            self._page.get_by_role("tab", name=name, exact=True).click()
            self._page.locator(f".tabs[aria-label='{name}']").wait_for()
            self.look(f"{state}, {name}", f".tabs[aria-label='{name}']")

    def look_into(self, title: str) -> None:
        """Look at what the button with this name or tooltip opens."""
        page = self._page
        page.get_by_title(title, exact=True).or_(page.get_by_role("button", name=title, exact=True)).first.click()
        self.look(title, OPEN)
        page.keyboard.press("Escape")


def test_a_driver(person: Seen) -> None:
    page, eyes = person.page, Eyes(person.page)
    for menu in ("Layout", "Open and close panels", "Restart, save, end", "What is drawn", "Mark"):
        eyes.look_into(menu)
    eyes.look_at_tabs("disabled")
    person.button("Enable").click()
    person.state("Teleoperated enabled")
    eyes.look("enabled")
    person.tab("Console").click()
    page.locator(".lines").click()  # it can be scrolled by keys, and leaves the emergency stop as it is
    page.keyboard.press(" ")
    person.state("Emergency stopped")
    eyes.look("stopped")
    page.get_by_label("Timeline").click(position={"x": 30, "y": 10})
    page.locator(".state em", has_text="past").wait_for()
    eyes.look("past")
    assert eyes.found == []


def test_a_plot(person: Seen) -> None:
    page, eyes = person.page, Eyes(person.page)
    person.choose("Layout", "Tuning")
    plot = page.locator("[data-panel='plot:1']")
    for value in ("left motor", "kP", "flag", "range"):
        plot.get_by_role("button", name="Add value").click()
        page.get_by_label("Search all values").fill(value)
        if value == "kP":
            eyes.look("searching", OPEN)
        page.keyboard.press("Enter")
    plot.locator(".u-over").wait_for()
    eyes.look("plot")
    eyes.look_into("Settings of kP")
    eyes.look_into("Axes")
    person.button("Table").click()
    eyes.look("table")
    assert eyes.found == []


def test_two_runs_and_a_crash(person: Seen) -> None:
    page, eyes = person.page, Eyes(person.page)
    page.evaluate("module('js/plotting.js').then(({ addToPlot }) => addToPlot('pwm[0].value', 'plot:1'))")
    # One run that moved, and one that does not.
    person.simulation.enable()
    person.simulation.set_axis(0, 0, 0.5)
    person.until(lambda: person.value("pwm[0].value") == 0.5)
    person.pause()
    person.simulation.rewind(0.5)
    page.get_by_title("Compare with an earlier run").click()
    page.get_by_role("menuitemcheckbox", name="before").last.click()
    page.locator(".first-difference").wait_for()
    eyes.look("compared")
    person.choose("Compare with an earlier run", "What differs")
    page.locator(".differences").wait_for()
    eyes.look("differences")
    page.keyboard.press("F5")
    page.keyboard.press("Control+e")
    person.state("Teleoperated enabled")
    page.keyboard.down("5")
    page.get_by_role("alert").locator("strong", has_text="ZeroDivisionError").wait_for()
    page.keyboard.up("5")
    eyes.look("crash")
    page.get_by_text("Traceback", exact=True).click()
    person.tab("Console").click()
    eyes.look("traceback")
    assert eyes.found == []


def test_a_dashboard(file: Path, person: Seen) -> None:
    page, eyes = person.page, Eyes(person.page)
    person.choose("Layout", "Dashboard")
    person.button("New dashboard…").wait_for()
    eyes.look("no dashboard")
    with_widgets(file, *WIDGETS)
    person.simulation.write(PUBLISHED)
    shown(person, "power").get_by_text("Total").wait_for()
    shown(person, "gauge").get_by_role("img", name="doubled: 1 V").wait_for()
    eyes.look("dashboard")
    page.set_viewport_size({"width": 1000, "height": 420})  # all of it scrolls
    eyes.look("small")
    page.set_viewport_size({"width": 1366, "height": 768})
    eyes.look_into("Dashboards of this project")
    person.button("Full screen").click()
    eyes.look("full screen")
    person.button("Leave the full screen").click()
    file.write_text("[]", "utf-8")
    page.get_by_role("alert").get_by_text("The dashboard is the last one that could be read.").wait_for()
    eyes.look("a mistake in the file")
    with_widgets(file, *WIDGETS)
    page.get_by_role("alert").wait_for(state="detached")
    person.button("Arrange").click()
    page.locator(".grid.arranging").wait_for()
    eyes.look("arranging")
    for opened in ("Settings of kP", "Grid", "Add widget"):
        eyes.look_into(opened)
    assert eyes.found == []


def test_who_only_looks(browser: Any, server: Any, file: Path) -> None:
    """What cannot be changed cannot take the keyboard, and still scrolls by keys."""
    with_widgets(file, *WIDGETS)
    with page_of(browser, server, server.viewing_address) as person:
        eyes = Eyes(person.page, themes=("dark",))  # what is disabled needs no contrast
        person.simulation.write(PUBLISHED)
        person.choose("Layout", "Dashboard")
        shown(person, "power").get_by_text("Total").wait_for()
        person.page.set_viewport_size({"width": 1000, "height": 420})
        eyes.look_at_tabs("read only")
        assert eyes.found == []


def test_a_tablet(browser: Any, server: Any) -> None:
    with page_of(browser, server, has_touch=True) as person:
        person.page.set_viewport_size({"width": 768, "height": 1024})
        eyes = Eyes(person.page, themes=("dark",))  # its colours are those of other screens
        eyes.look_at_tabs("tablet")
        assert eyes.found == []


def test_a_log(browser: Any, tmp_path: Path) -> None:
    log = open_log(a_match().save(tmp_path / "match.wpilog"), 27.0)
    with served_source(LogSource(Project(tmp_path / "robot.py"), log)) as server:
        with opened_page(browser, server.address, 1366, 768) as page:
            page.locator(".recorded code", has_text="match.wpilog").wait_for()
            eyes = Eyes(page)
            eyes.look_at_tabs("log")
            eyes.look_into("Compare with another log")
        assert eyes.found == []
