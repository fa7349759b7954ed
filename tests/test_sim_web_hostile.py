"""Whatever a page sends, it gets an answer, and neither the simulation nor the driver's terminal suffers from it."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator
from contextlib import ExitStack

import pytest
from conftest import sampled
from sim_robots import FILES
from web_pages import Page, Served, served
from websockets.exceptions import InvalidStatus

#: Values as JSON that no message should have, and some that are possible.
ODD = [
    "1" * 400, f"-{'9' * 5000}", "1e400", "-1e999", "NaN", "-Infinity", "1e308", "-1", "0.5", "2.0", "1e15", "true",
    "null", '"\\ud800"', '"\\udfff\\ud800"', '{"\\ud800": 1}', '"\\u0000"', f'"{"x" * 100_000}"', '""', '"../../x"',
    '"/etc/passwd"',
    "[" * 100_000 + "]" * 100_000, '{"a":' * 3000 + "1" + "}" * 3000, "[" * 60 + "]" * 60, "[]", "{}", '["\\ud800"]',
    '["sim.mode"]', '{"$": "NaN"}', '{"$": []}', "[[1, 2], {}]", '"é😀"',
]  # fmt: skip
TYPES = ("command", "layout", "values", "plot", "first_difference", "subscribe", "ping", "hello", "")
KEYS = ("id", "type", "t", "from", "to", "points", "paths", "branch", "layout", "name")
COMMANDS = (
    ("write", "values"), ("speed", "factor"), ("rewind", "t"), ("axis", "value"), ("axis", "stick"),
    ("button", "button"),
    ("pov", "angle"), ("step", "packets"), ("place", "x"), ("mark", "t"), ("mark", "text"), ("save", "file"),
    ("name_branch", "branch"), ("game_message", "text"), ("alliance", "station"), ("choose", "chooser"),
    ("reset_position", "start"),
)  # fmt: skip


def whole(**parts: str) -> str:
    """Return a message from parts that are JSON already."""
    return "{" + ", ".join(f"{json.dumps(key)}: {value}" for key, value in parts.items()) + "}"


def odd_messages() -> Iterator[str]:
    """Yield each odd value in each place of a message in which it differs."""
    yield from ODD
    yield from ("", "x", "{", '{"type": "ping"', "\ufeff{}", "\x00")
    for kind, key, odd in itertools.product(TYPES, KEYS, ODD):
        usual = {"t": "0", "from": "0", "to": "1", "paths": '["sim.mode"]'}
        if key in usual or key in ("id", "type"):
            yield whole(**{"type": json.dumps(kind), **usual, key: odd})
    for (name, key), odd in itertools.product(COMMANDS, ODD):
        usual = {"stick": "0", "axis": "0", "button": "1", "pressed": "true", "y": "1", "degrees": "0", "value": "0"}
        usual |= {"text": '"x"', "t": "0", "option": '"x"'}
        yield whole(**{"type": '"command"', "name": json.dumps(name), **usual, key: odd})


def send_all(page: Page, messages: list[str]) -> int:
    """Send messages, and return how many of them were refused."""
    refused = 0
    for number, message in enumerate(messages):
        page.socket.send(message)
        page.socket.send(json.dumps({"type": "ping", "id": f"ping {number}"}))
        while (answer := json.loads(page.socket.recv(timeout=60))).get("id") != f"ping {number}":
            refused += answer["type"] == "error"
            if answer["type"] == "error":
                assert len(answer["message"]) < 400, message[:200]
    return refused


@pytest.fixture(name="server", scope="module")
def one_server(make_shared_project) -> Iterator[Served]:
    with served(make_shared_project(FILES)) as server:
        yield server


@pytest.mark.parametrize("role", sampled(["view", "drive"], "drive"))
def test_odd_messages_change_nothing_and_print_nothing(role: str, server: Served, capfd, pytestconfig) -> None:
    messages = list(odd_messages())[:: 1 if pytestconfig.getoption("run_slow") else 4]  # by day, some of them
    assert len(messages) > 500
    address = server.viewing_address if role == "view" else server.address
    with server.page(address) as page:
        refused = send_all(page, messages)
        assert refused > len(messages) / 3
    with server.page() as page:
        if role == "view":
            assert page.status["starts"] == 1
        starts = page.status["starts"]
        page.command("restart")
        page.until(lambda: page.status["starts"] > starts and page.status["state"] == "paused" and page.time == 0)
        page.run_for(0.1)
    assert capfd.readouterr() == ("", "")
    outside = [file for file in server.simulation.project.root.parent.iterdir() if file.suffix == ".jsonl"]
    assert outside == []


def test_those_who_look_are_limited_and_drivers_are_not(server: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pyfrc_core.sim.ui.web.app._MOST_PAGES", 2)
    with ExitStack() as pages:
        for _ in range(2):
            pages.enter_context(server.page(server.viewing_address))
        with pytest.raises(InvalidStatus):
            pages.enter_context(server.page(server.viewing_address))
        pages.enter_context(server.page()).run_for(0.1)
