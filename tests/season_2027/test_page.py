"""The page of `pyfrc sim` in a real browser, with a robot of 2027: opmodes, tunables and joysticks."""

from __future__ import annotations

import re
from typing import Any

from browser_pages import Seen
from conftest import MakeProject
from playwright.sync_api import Browser, expect
from web_pages import served

from .test_dashboards import ROBOT as TUNABLE
from .test_simulator import MOTOR, ROBOT


def opened(browser: Browser, server: Any) -> Seen:
    return Seen(browser.new_page(viewport={"width": 1366, "height": 768}), server).open()


def test_opmodes_are_chosen_by_mouse_and_keys(make_project: MakeProject, browser: Browser) -> None:
    with served(make_project(ROBOT), speed=1, paused=False) as server:
        person = opened(browser, server)
        page, chooser = person.page, person.page.get_by_label("Opmode")
        expect(page.get_by_role("radio", name="Utility")).to_be_visible()
        expect(chooser).to_have_value("Drive")
        page.get_by_role("radio", name="Auto").click()
        expect(chooser).to_have_value("Forward")
        assert chooser.locator("optgroup").get_attribute("label") == "Turns"
        chooser.select_option("Left")
        person.button("Enable").click()
        person.until(lambda: person.value(MOTOR) == -0.5)
        chooser.focus()
        page.keyboard.press("F")  # the first opmode with this letter: the robot is disabled
        person.state("Autonomous disabled")
        expect(chooser).to_have_value("Forward")
        person.button("Practice").click()
        person.until(lambda: person.value(MOTOR) == 0.25)
        assert person.simulation.snapshot is not None
        assert person.simulation.snapshot.practice_since is not None
        assert not person.wrong


def test_a_robot_without_opmodes_has_no_chooser_and_values_are_tuned(
    make_project: MakeProject, browser: Browser
) -> None:
    with served(make_project(TUNABLE), speed=1, paused=False) as server:
        person = opened(browser, server)
        expect(person.page.get_by_label("Opmode")).to_have_count(0)
        person.tab("NetworkTables").click()
        for folder in ("Drive", "Arm", "limit"):
            person.button(folder).click()
        total = person.row("nt:/Telemetry/sum").locator(".nt-value")
        person.shows(total, "11")
        person.set_number(person.row("nt:/Tunables/Drive/kP").locator("input"), "10")
        person.set_number(person.row("nt:/Tunables/Arm/limit/value").locator("input"), "100")
        person.shows(total, "118")
        person.page.get_by_label("Auto", exact=True).select_option("Forward")
        person.until(lambda: person.simulation.snapshot.choosers[0].active == "Forward")
        person.set_number(person.row("nt:/Tunables/fixed").locator("input"), "1")
        expect(person.page.get_by_text(re.compile("published this with mutable=False")).first).to_be_visible()
        assert not person.wrong
