"""A page that is gone, or a moment that is left, releases what was held there; a robot without a driver is disabled.

What is not seen is not driven: while the panels show the past, nothing is, and what is not possible is said.
"""

from __future__ import annotations

import socket
from typing import Any
from urllib.parse import urlsplit

import pytest
from browser_pages import Seen
from sim_robots import FILES, PATIENCE
from web_pages import Served, served

PAST = "The panels show the past. Choose “Live” to drive the robot, or “Drive on from here”."


def motor(served_or_seen: Any) -> float:
    snapshot = served_or_seen.simulation.snapshot
    return 0.0 if snapshot is None else float(snapshot.values.get("pwm[0].value", 0.0))


def until(server: Served, condition: Any) -> None:
    simulation = server.simulation
    assert simulation.wait_for(condition, PATIENCE), (simulation.status, simulation.snapshot)


@pytest.fixture
def driving(person: Seen) -> Seen:
    """A person who holds W, and whose robot drives."""
    person.button("Enable").click()
    person.state("Teleoperated")
    person.page.keyboard.down("w")
    person.until(lambda: motor(person) == 1)
    return person


def is_alone_and_off(person: Seen) -> bool:
    simulation = person.simulation
    snapshot = simulation.snapshot
    return not snapshot.enabled and motor(person) == 0 and not any(snapshot.values["joysticks[0].axes"])


def test_a_page_that_is_loaded_again_leaves_no_driving_robot(driving: Seen) -> None:
    """One that is closed: see the journey."""
    driving.page.reload()
    driving.until(lambda: is_alone_and_off(driving))
    driving.page.locator(".state.disabled").wait_for()


def test_a_moment_that_was_driven_is_gone_on_from_without_its_keys(driving: Seen) -> None:
    since = driving.simulation.snapshot.time
    driving.until(lambda: driving.simulation.snapshot.time > since + 0.6)
    driving.page.keyboard.up("w")
    driving.until(lambda: motor(driving) == 0)
    driving.simulation.rewind(since + 0.4)
    driving.until(lambda: driving.simulation.status.starts > 1 and driving.simulation.status.state == "running")
    now = driving.simulation.snapshot.time
    driving.until(lambda: driving.simulation.snapshot.time > now + 0.2)
    assert driving.simulation.snapshot.enabled
    assert motor(driving) == 0


def test_a_key_that_is_held_drives_on_in_another_run(driving: Seen) -> None:
    since, starts = driving.simulation.snapshot.time, driving.simulation.status.starts
    driving.until(lambda: driving.simulation.snapshot.time > since + 0.5)
    driving.simulation.rewind(since + 0.3)
    driving.until(lambda: driving.simulation.status.starts > starts and driving.simulation.status.state == "running")
    driving.until(lambda: motor(driving) == 1)
    driving.page.keyboard.up("w")
    driving.until(lambda: motor(driving) == 0)


@pytest.mark.parametrize("name", ["Left stick", "button"])
def test_a_control_that_loses_the_keyboard_is_released(name: str, person: Seen) -> None:
    person.button("Enable").click()
    person.tab("Touch sticks").click()
    control = (
        person.page.get_by_label(name).first if name != "button" else person.page.locator(".touch-buttons button").first
    )
    path, key = ("joysticks[0].axes", "ArrowUp") if name != "button" else ("joysticks[0].buttons", "Enter")
    control.focus()
    person.page.keyboard.down(key)
    person.until(lambda: any(person.value(path)))
    control.blur()
    person.until(lambda: not any(person.value(path)))


def look_back(person: Seen) -> None:
    person.page.get_by_role("slider", name="Timeline").focus()
    person.page.keyboard.press("Home")
    person.page.locator(".state em", has_text="past").wait_for()
    person.page.evaluate("document.activeElement.blur()")


def said(person: Seen) -> None:
    """Wait until the page says that this is the past, and hide it."""
    person.page.locator(".notice", has_text=PAST).wait_for()
    person.page.get_by_label("Hide this message").click()
    person.page.locator(".notice").wait_for(state="detached")


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


def test_a_branch_that_is_longer_than_the_present_is_shown_whole(person: Seen) -> None:
    from playwright.sync_api import expect

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


def test_of_two_pages_each_releases_what_it_held(make_project: Any) -> None:
    with served(make_project(FILES), speed=1, paused=False) as server, server.page() as stays:
        with server.page() as goes, server.page(server.viewing_address):
            goes.command("enable")
            goes.command("axis", stick=0, axis=1, value=-1.0)
            stays.command("button", stick=0, button=2, pressed=True)
            until(server, lambda: motor(server) == 1)
        until(server, lambda: motor(server) == 0)
        snapshot = server.simulation.snapshot
        assert snapshot.enabled
        assert snapshot.values["joysticks[0].buttons"][2]


def test_those_who_look_are_no_drivers(make_project: Any) -> None:
    with served(make_project(FILES), speed=1, paused=False) as server, server.page(server.viewing_address):
        with server.page() as driver:
            driver.command("practice")
            until(server, lambda: server.simulation.snapshot.enabled)
        until(server, lambda: not server.simulation.snapshot.enabled)
        assert server.simulation.snapshot.practice_since is None


@pytest.mark.slow
def test_a_page_that_does_not_respond_counts_as_gone(make_project: Any) -> None:
    """As after a computer went to sleep, or its network was lost: nothing ends the connection."""
    with served(make_project(FILES), speed=1, paused=False) as server:
        parts = urlsplit(server.address)
        with socket.create_connection((parts.hostname, parts.port), PATIENCE) as silent:
            silent.sendall(
                f"GET /ws?{parts.query} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\n"
                "Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                "Sec-WebSocket-Version: 13\r\n\r\n".encode()
            )
            assert silent.recv(12) == b"HTTP/1.1 101"
            for text in (
                '{"type":"command","name":"enable"}',
                '{"type":"command","name":"axis","stick":0,"axis":1,"value":-1}',
            ):
                silent.sendall(bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text.encode())
            until(server, lambda: motor(server) == 1)
            until(server, lambda: motor(server) == 0 and not server.simulation.snapshot.enabled)
