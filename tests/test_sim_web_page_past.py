"""The page of `pyfrc sim`: nothing is driven unseen, and what is not possible is said."""

from __future__ import annotations

import pytest
from browser_pages import (  # noqa: F401 - `person`, `browser`, `server`
    Seen,
    missing_browser,
    person_at_page,
    shared_browser,
    shared_server,
)
from playwright.sync_api import expect
from skips import require

require("the page of pyfrc sim in a browser", missing_browser())

PAST = "The panels show the past. Choose “Live” to drive the robot, or “Drive on from here”."


def look_back(person: Seen) -> None:
    person.page.get_by_role("slider", name="Timeline").focus()
    person.page.keyboard.press("Home")
    person.page.locator(".state em", has_text="past").wait_for()
    person.page.evaluate("document.activeElement.blur()")


def said(person: Seen) -> None:
    """Wait until the page says that this is the past, and hide it."""
    person.page.locator(".notice", has_text=PAST).wait_for()
    person.page.get_by_label("Hide this message").click()


def test_nothing_drives_while_the_panels_show_the_past(person: Seen) -> None:
    page = person.page
    person.button("Enable").click()
    page.keyboard.down("w")
    person.until(lambda: person.value("pwm[0].value") == 1)
    look_back(person)  # the key that is held is released
    person.until(lambda: person.value("pwm[0].value") == 0)
    steps = len(person.simulation.script().steps)
    page.keyboard.up("w")
    for key in ("w", "5"):
        page.keyboard.press(key)
        said(person)
    switch = person.row("dio[3].value").locator("input")
    checked = switch.is_checked()
    switch.click(force=True)
    said(person)
    assert switch.is_checked() is checked
    page.locator(".stick-button", has_text="Trigger").click()
    said(person)
    assert len(person.simulation.script().steps) == steps
    assert person.simulation.snapshot.enabled
    person.button("Live").click()
    page.keyboard.down("w")
    person.until(lambda: person.value("pwm[0].value") == 1)
    page.keyboard.up("w")


@pytest.mark.parametrize("key", ["Enter", "Space"])
def test_a_robot_is_stopped_from_the_past_and_seen(person: Seen, key: str) -> None:
    person.button("Enable").click()
    person.until(lambda: person.simulation.snapshot.enabled)
    look_back(person)
    person.page.keyboard.press("Control+e")
    said(person)
    person.page.keyboard.press(key)
    person.state("Emergency stopped" if key == "Space" else "Teleoperated disabled")
    person.page.locator(".state em").wait_for(state="detached")


def test_a_key_steps_through_the_past_and_not_the_present(person: Seen) -> None:
    person.until(lambda: person.simulation.snapshot.time > 0.5)
    person.pause()
    look_back(person)
    time = person.simulation.snapshot.time
    person.page.keyboard.press("F6")
    person.page.locator(".clock", has_text="0:00.02").wait_for()
    assert person.simulation.snapshot.time == time


@pytest.mark.slow
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
    present, end = page.evaluate(shown)
    assert (present, end) == (pytest.approx(1.0), pytest.approx(long))
    # The pointer is at a moment that only the branch has, and the plot's own curve has no value there.
    page.locator("[data-panel='plot:1'] .u-over").hover(position={"x": 200, "y": 20})
    expect(page.locator("[data-panel='plot:1'] .legend b")).to_have_text("\N{EN DASH}")


def test_a_key_with_another_use_cannot_drive(person: Seen) -> None:
    page = person.page
    person.tab("Keys").click()
    box = page.get_by_label("Key", exact=True)
    for key, reason in {
        "Space": "Space is the emergency stop. Choose another key.",
        "Enter": "Enter disables the robot. Choose another key.",
        "F9": "F9 restarts the robot. Choose another key.",
        "F11": "F11 belongs to the browser or the system. Choose another key.",
        "Shift": "makes driving gentle",
        "[": "BracketLeft enables the robot, with two others.",
    }.items():
        box.press(key)
        page.locator(".notice", has_text=reason).wait_for()
        assert person.button("Add").is_disabled()
    box.press("n")
    page.locator(".notice").wait_for(state="detached")
    page.get_by_role("spinbutton", name="joystick").fill("9")
    person.button("Add").click()  # the browser says why not
    assert page.get_by_role("spinbutton", name="joystick").evaluate("box => box.validationMessage")
    assert page.locator("td", has_text="joystick 9").count() == 0
    assert not person.simulation.snapshot.emergency_stopped
