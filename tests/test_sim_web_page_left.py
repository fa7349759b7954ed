"""A page that is gone releases what was held there; a robot without a driver is disabled."""

from __future__ import annotations

import socket
from typing import Any
from urllib.parse import urlsplit

import pytest
from sim_robots import FILES, PATIENCE
from web_pages import Served, served


def motor(server: Served) -> float:
    snapshot = server.simulation.snapshot
    return 0.0 if snapshot is None else float(snapshot.values.get("pwm[0].value", 0.0))


def until(server: Served, condition: Any) -> None:
    simulation = server.simulation
    assert simulation.wait_for(condition, PATIENCE), (simulation.status, simulation.snapshot)


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
