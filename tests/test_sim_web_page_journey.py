"""One journey of a user on the page, in a real browser: the part of the browser's tests that runs by day.

What each panel does in detail, the other files with a browser show at night. The page's arithmetic is tested in
``tests/page``, without a browser; what the server sends and takes, in ``tests/test_sim_web.py``.
"""

from __future__ import annotations

import json
from typing import Any

import pytest
from browser_pages import HOSTILE, INJECTED, REFUSED, Seen, opened_page
from web_pages import served_source
from written_logs import a_match

from pyfrc_core.config.dashboards import DASHBOARDS
from pyfrc_core.project import Project
from pyfrc_core.sim.logs import open_log
from pyfrc_core.sim.logs.source import LogSource

pytestmark = pytest.mark.journey

#: All of this is one text for a person, and no element of the page.
ELEMENTS = "#app script, #app b:text-is('bold'), #app label img, #app .line-text > *"


def test_a_user_drives_looks_back_plots_makes_a_dashboard_and_opens_a_log(
    person: Seen, browser: Any, tmp_path: Any
) -> None:
    page, root = person.page, person.simulation.project.root
    sees_the_robots_texts(person)
    sets_a_sensor_and_a_value(person)
    end = drives(person)
    looks_back_and_goes_on(person, end)
    plots(person)
    makes_a_dashboard(person)
    widgets = json.loads((root / DASHBOARDS).read_text("utf-8"))["dashboards"]["Drive"]["widgets"]
    assert [(each["kind"], each["topic"]) for each in widgets] == [("number", "/SmartDashboard/kP")]
    sees_a_failure_and_restarts(person)
    assert page.locator(ELEMENTS).count() == 0
    assert "broken" not in page.title()
    assert not person.wrong
    assert page.evaluate(INJECTED) == REFUSED
    person.wrong.clear()  # the console has a line for each
    closes_the_page_while_driving(person)
    opens_a_log(browser, tmp_path)


def sees_the_robots_texts(person: Seen) -> None:
    person.page.locator(".line-text", has_text=HOSTILE).first.wait_for()
    person.page.locator(".pose b", has_text="10.00 ft").wait_for()


def sets_a_sensor_and_a_value(person: Seen) -> None:
    page = person.page
    page.get_by_label("Search devices").fill("range")
    page.locator("[data-path='pwm[0].value']").wait_for(state="detached")
    person.set_number(person.row("analog_in[2].voltage").locator("input.number"), "2,5")
    person.until(lambda: person.value("analog_in[2].voltage") == 2.5)
    page.get_by_label("Search devices").fill("")
    person.tab("NetworkTables").click()
    person.set_number(person.row("nt:/SmartDashboard/kP").locator("input"), "1.25")
    person.shows(person.row("nt:/SmartDashboard/doubled").locator("input"), "2.5")
    person.tab("Devices").click()


def drives(person: Seen) -> float:
    """Drive some feet, be stopped at once, and pause. Return the robot's x, in feet."""
    page = person.page
    person.button("Enable").click()
    person.state("Teleoperated enabled")
    page.keyboard.down("w")
    person.until(lambda: person.value("pwm[0].value") == 1)
    page.locator("[data-path='pwm[0].value'] .number", has_text="1.00").wait_for()
    person.until(lambda: person.simulation.snapshot.scene.robot.x > 12)
    page.keyboard.press(" ")  # the emergency stop, whatever else is held
    person.state("Emergency stopped")
    assert person.button("Enable").is_disabled()
    page.keyboard.up("w")
    person.until(lambda: person.value("pwm[0].value") == 0)
    person.pause()
    return float(person.simulation.snapshot.scene.robot.x)


def looks_back_and_goes_on(person: Seen, end: float) -> None:
    page, time = person.page, person.simulation.snapshot.time
    page.get_by_role("slider", name="Timeline").focus()
    page.keyboard.press("Home")
    page.locator(".clock", has_text="0:00.00").wait_for()
    page.locator(".state em", has_text="past").wait_for()
    page.locator(".pose b", has_text="10.00 ft").wait_for()
    assert person.simulation.snapshot.time == time  # nothing has changed
    person.button("Live").click()
    page.locator(".pose b", has_text=f"{end:.2f} ft").wait_for()
    # Back to before the emergency stop: from there, another run begins.
    page.get_by_role("slider", name="Timeline").focus()
    page.keyboard.press("Home")
    person.button("Drive on from here").click()
    person.until(lambda: person.simulation.snapshot is not None and person.simulation.snapshot.time < time)
    page.locator(".state em").wait_for(state="detached")
    page.locator(".pose b", has_text="10.00 ft").wait_for()


def plots(person: Seen) -> None:
    page = person.page
    person.choose("Layout", "Tuning")
    page.locator("[data-panel='plot:1']").get_by_role("button", name="Add value").click()
    page.get_by_label("Search all values").fill("left motor")
    page.keyboard.press("Enter")
    page.locator(".curve-name", has_text="left motor").wait_for()
    page.locator("[data-panel='plot:1'] .u-over").wait_for()
    page.reload()  # the arrangement stays
    page.locator(".curve-name", has_text="left motor").wait_for()


def makes_a_dashboard(person: Seen) -> None:
    page = person.page
    person.choose("Layout", "Dashboard")
    person.button("New dashboard…").click()
    page.keyboard.press("Enter")  # it is called "Drive"
    person.button("Add widget").click()
    page.get_by_label("Search all values").fill("kP")
    page.keyboard.press("Enter")
    page.locator(".widget[data-kind=number]").wait_for()
    person.button("Save").click()
    person.button("Arrange").wait_for()
    person.choose("Layout", "Driving")


def sees_a_failure_and_restarts(person: Seen) -> None:
    page = person.page
    if person.simulation.status.state == "paused":
        page.keyboard.press("F5")
    page.keyboard.press("Control+e")
    person.state("Teleoperated enabled")
    page.keyboard.down("5")
    alert = page.get_by_role("alert")
    alert.locator("strong", has_text="ZeroDivisionError").wait_for()
    page.keyboard.up("5")
    assert alert.locator("strong").inner_text().startswith("robot.py:")
    person.button("Restart").click()
    alert.wait_for(state="detached")
    person.state("Teleoperated disabled")


def closes_the_page_while_driving(person: Seen) -> None:
    simulation = person.simulation
    person.page.keyboard.press("Control+e")
    person.state("Teleoperated enabled")
    person.page.keyboard.down("w")
    person.until(lambda: person.value("pwm[0].value") == 1)
    person.page.close()
    person.until(lambda: not simulation.snapshot.enabled and person.value("pwm[0].value") == 0)


def opens_a_log(browser: Any, directory: Any) -> None:
    log = open_log(a_match().save(directory / "match.wpilog"), 27.0)
    with (
        served_source(LogSource(Project(directory / "robot.py"), log)) as server,
        opened_page(browser, server.address) as page,
    ):
        page.locator(".recorded code", has_text="match.wpilog").wait_for()
        assert page.get_by_role("button", name="Enable", exact=True).count() == 0
        box = page.locator(".timeline").bounding_box()
        page.mouse.click(box["x"] + box["width"] * 0.25, box["y"] + 12)
        page.locator(".state b", has_text="Autonomous enabled").wait_for()
        page.locator(".console", has_text="ValueError: it broke").wait_for()
