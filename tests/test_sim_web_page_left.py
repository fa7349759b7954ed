"""A page that is gone, or a moment that is left, releases what was held there; a robot without a driver is disabled."""

from __future__ import annotations

import socket
from typing import Any
from urllib.parse import urlsplit

import pytest
from browser_pages import (  # noqa: F401 - `person`, `browser`
    Seen,
    missing_browser,
    page_of,
    person_at_page,
    shared_browser,
    shared_server,
)
from sim_robots import FILES, PATIENCE
from skips import requires
from web_pages import Served, served

BROWSER = requires("the page of pyfrc sim in a browser", missing_browser())


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


@BROWSER
@pytest.mark.parametrize("way", ["close", "reload", "leave"])
def test_a_page_that_goes_away_leaves_no_driving_robot(way: str, driving: Seen) -> None:
    act = {
        "close": driving.page.close,
        "reload": driving.page.reload,
        "leave": lambda: driving.page.goto("about:blank"),
    }
    act[way]()
    driving.until(lambda: is_alone_and_off(driving))
    if way == "reload":
        driving.page.locator(".state.disabled").wait_for()


@BROWSER
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


@BROWSER
def test_a_key_that_is_held_drives_on_in_another_run(driving: Seen) -> None:
    since, starts = driving.simulation.snapshot.time, driving.simulation.status.starts
    driving.until(lambda: driving.simulation.snapshot.time > since + 0.5)
    driving.simulation.rewind(since + 0.3)
    driving.until(lambda: driving.simulation.status.starts > starts and driving.simulation.status.state == "running")
    driving.until(lambda: motor(driving) == 1)
    driving.page.keyboard.up("w")
    driving.until(lambda: motor(driving) == 0)


@BROWSER
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
