"""Who can see and drive a simulation in a browser: only those who have its key, from its own page."""

from __future__ import annotations

import socket
from urllib.parse import urlsplit

import pytest
from sim_robots import FILES
from web_pages import PATIENCE, Served, served
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

QUIET = {
    "robot.py": """
        import wpilib


        class MyRobot(wpilib.TimedRobot):
            pass
    """,
    "sim/config.json": '{"pyfrc": {"field": {"image": "field.png"}}}',
    "sim/field.png": "not really a picture",
}


def refused(server: Served, path: str, **options: str | None) -> int:
    """The status with which a WebSocket is refused."""
    parts = urlsplit(server.address)
    given = {"origin": f"http://{parts.netloc}", **options}
    with pytest.raises(InvalidStatus) as refusal, connect(f"ws://{parts.netloc}{path}", **given):
        pass
    return refusal.value.response.status_code


def test_a_wrong_token_is_refused(make_project) -> None:
    with served(make_project(QUIET)) as server:
        token = urlsplit(server.address).query.removeprefix("token=")
        assert len(token) >= 32
        for path in ("/", "/field-image"):
            assert server.get(f"{path}?token={token}")[0] == 200
            for wrong in ("", "?token=", "?token=x", f"?token={token[:-1]}", f"?token={token}x", "?token=%C3%A9"):
                status, headers, content = server.get(path + wrong)
                assert (status, headers["content-type"]) == (403, "text/plain; charset=utf-8")
                assert token.encode() not in content
        for wrong in ("/ws", "/ws?token=", f"/ws?token={token[:-1]}", f"/ws?token={token}x"):
            assert refused(server, wrong) == 403


def test_a_page_of_another_origin_can_neither_read_nor_drive(make_project) -> None:
    with served(make_project(QUIET)) as server:
        parts = urlsplit(server.address)
        for origin in ("http://evil.example", "http://127.0.0.1:1", f"https://{parts.netloc}", "null"):
            assert refused(server, f"/ws?{parts.query}", origin=origin) == 403
            for path in (f"/?{parts.query}", "/static/index.html"):
                status, headers, _ = server.get(path, {"Origin": origin})
                assert status == 403
                assert "access-control-allow-origin" not in headers


def test_a_name_that_leads_here_is_refused(make_project) -> None:
    """DNS rebinding: a page's own name is resolved to this computer."""
    with served(make_project(QUIET)) as server:
        parts = urlsplit(server.address)
        for host in ("evil.example", f"evil.example:{parts.port}", "127.0.0.1.evil.example", "", "192.168.1.7"):
            for path in (f"/?{parts.query}", "/static/index.html", f"/ws?{parts.query}"):
                assert server.get(path, {"Host": host})[0] == 403, host
        assert server.get(f"/?{parts.query}", {"Host": f"localhost:{parts.port}"})[0] == 200


def test_a_second_user_on_the_network_is_refused(make_project) -> None:
    """The server does not even listen at this computer's address on the network."""
    with served(make_project(QUIET)) as server:
        assert server.front_end.server is not None
        other = urlsplit(server.front_end.server.network_address()).hostname
        if other is None or other.startswith("127."):
            pytest.skip("the network: needs an address besides 127.0.0.1")
        with pytest.raises(OSError), socket.create_connection((other, urlsplit(server.address).port), 2):  # noqa: PT011
            pass


def test_the_page_may_load_its_own_files_only(make_project) -> None:
    with served(make_project(QUIET)) as server:
        for path in (f"/?{urlsplit(server.address).query}", "/static/index.html", "/nothing"):
            headers = server.get(path)[1]
            rules = dict(rule.strip().split(" ", 1) for rule in headers["content-security-policy"].split(";"))
            assert rules["default-src"] == "'none'"
            assert rules["script-src"] == "'self'"
            assert rules["style-src"] == "'self'"
            assert "unsafe" not in headers["content-security-policy"]
            assert rules["frame-ancestors"] == "'none'"
            assert headers["x-content-type-options"] == "nosniff"
            assert headers["referrer-policy"] == "no-referrer"


def test_a_page_with_the_viewing_address_sees_and_cannot_drive(make_project) -> None:
    with served(make_project(FILES)) as server, server.page(server.viewing_address) as viewer, server.page() as driver:
        assert viewer.hello["readonly"] is True
        for message in (
            {"type": "command", "name": "enable"},
            {"type": "command", "name": "write", "values": {"nt:/x": 1}},
            {"type": "command", "name": "quit"},
            {"type": "layout", "layout": {}},
        ):
            assert viewer.ask(**message)["type"] == "error"
        driver.run_for(0.2)
        viewer.until(lambda: viewer.time == driver.time)
        assert viewer.values == driver.values
        assert not viewer.station["enabled"]
        assert viewer.ask(type="values", t=0.1)["values"]["sim.mode"] == "disabled"


def test_share_serves_the_network_read_only_and_says_so(make_project) -> None:
    with served(make_project(FILES), share="view") as server:
        assert server.front_end.server is not None
        text = "".join(server.printed)
        viewing = server.front_end.server.network_address()
        assert viewing in text
        assert "can only look" in text
        host = urlsplit(viewing).netloc
        drive = urlsplit(server.address).query
        if host.startswith("127."):
            pytest.skip("the network: needs an address besides 127.0.0.1")
        with server.page(viewing) as page:
            assert page.hello["readonly"] is True
        # With the key that drives, and from another computer: the server sees its address, and not this computer's.
        with pytest.raises(InvalidStatus), connect(f"ws://{host}/ws?{drive}", origin=f"http://{host}"):
            pass
        with server.page() as page:
            assert page.hello["readonly"] is False


def test_share_to_drive_is_asked_for(make_project) -> None:
    with served(make_project(FILES), share="drive") as server:
        assert server.front_end.server is not None
        address = server.front_end.server.network_address(drive=True)
        assert address in "".join(server.printed)
        assert "can drive the robot" in "".join(server.printed)
        with server.page(address) as page:
            assert page.hello["readonly"] is False
            page.command("enable")


def test_a_message_that_is_too_large_ends_its_page_only(make_project) -> None:
    with served(make_project(FILES)) as server, server.page() as page:
        with server.page() as other, pytest.raises(Exception, match=r"(?i)closed|1009|reset|broken"):  # noqa: PT012
            other.socket.send("x" * (2 << 20))
            while True:
                other.socket.recv(timeout=PATIENCE)
        page.run_for(0.1)


def test_addresses_differ_from_start_to_start(make_project) -> None:
    made = make_project(QUIET)
    with served(made) as first:
        one = first.address, first.viewing_address
    with served(made) as second:
        two = second.address, second.viewing_address
    tokens = {urlsplit(address).query for address in (*one, *two)}
    assert len(tokens) == 4
