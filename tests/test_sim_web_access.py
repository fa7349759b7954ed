"""Who can see and drive a simulation in a browser: only those who have its key, from its own page."""

from __future__ import annotations

import os
import re
import socket
from collections.abc import Iterator
from urllib.parse import urlsplit

import pytest
from conftest import MakeProject
from loops import for_each
from recorded_pages import run_in
from sim_robots import FILES
from web_pages import PATIENCE, Served, served
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from pyfrc_core.config.pictures import field_picture
from pyfrc_core.errors import UsageError
from pyfrc_core.sim.ui.web.access import allowed_origins

QUIET = {
    "robot.py": """
        import wpilib


        class MyRobot(wpilib.TimedRobot):
            pass
    """,
    "sim/config.json": '{"pyfrc": {"field": {"image": "field.png"}}}',
    "sim/field.png": "<svg xmlns='http://www.w3.org/2000/svg'/>",
}


@pytest.fixture(scope="module")
def quiet(make_shared_project: MakeProject) -> Iterator[Served]:
    """The server of a robot that does nothing, at the address of this computer only."""
    with served(make_shared_project(QUIET)) as server:
        yield server


def refused(server: Served, path: str, **options: str | None) -> int:
    """The status with which a WebSocket is refused."""
    parts = urlsplit(server.address)
    given = {"origin": f"http://{parts.netloc}", **options}
    with pytest.raises(InvalidStatus) as refusal, connect(f"ws://{parts.netloc}{path}", **given):
        pass
    return refusal.value.response.status_code


def test_a_wrong_token_is_refused(quiet: Served) -> None:
    token = urlsplit(quiet.address).query.removeprefix("token=")
    assert len(token) >= 32
    for path in ("/", "/field-image"):
        assert quiet.get(f"{path}?token={token}")[0] == 200
        for wrong in ("", "?token=", "?token=x", f"?token={token[:-1]}", f"?token={token}x", "?token=%C3%A9"):
            status, headers, content = quiet.get(path + wrong)
            assert (status, headers["content-type"]) == (403, "text/plain; charset=utf-8")
            assert token.encode() not in content
    for wrong in ("/ws", "/ws?token=", f"/ws?token={token[:-1]}", f"/ws?token={token}x"):
        assert refused(quiet, wrong) == 403


def test_a_page_of_another_origin_can_neither_read_nor_drive(quiet: Served) -> None:
    parts = urlsplit(quiet.address)
    for origin in ("http://evil.example", "http://127.0.0.1:1", f"https://{parts.netloc}", "null"):
        assert refused(quiet, f"/ws?{parts.query}", origin=origin) == 403
        for path in (f"/?{parts.query}", "/static/index.html"):
            status, headers, _ = quiet.get(path, {"Origin": origin})
            assert status == 403
            assert "access-control-allow-origin" not in headers


def test_a_name_that_leads_here_is_refused(quiet: Served) -> None:
    """DNS rebinding: a page's own name is resolved to this computer."""
    parts = urlsplit(quiet.address)
    for host in ("evil.example", f"evil.example:{parts.port}", "127.0.0.1.evil.example", "", "192.168.1.7"):
        for path in (f"/?{parts.query}", "/static/index.html", f"/ws?{parts.query}"):
            assert quiet.get(path, {"Host": host})[0] == 403, host
    assert quiet.get(f"/?{parts.query}", {"Host": f"localhost:{parts.port}"})[0] == 200


def opened(server: Served, host: str, origin: str, token: str = "") -> int:
    """The status that a browser gets for a WebSocket, whose request comes to this computer with this host."""
    parts = urlsplit(server.address)
    query = f"token={token}" if token else parts.query
    connection = socket.create_connection(("127.0.0.1", parts.port or 0), PATIENCE)
    try:
        with connect(f"ws://{host}/ws?{query}", sock=connection, origin=origin):
            return 101
    except InvalidStatus as refusal:
        return refusal.response.status_code


@pytest.mark.slow
def test_a_forwarded_port_of_another_number(quiet: Served) -> None:
    """`ssh -L 9999:127.0.0.1:PORT`, and VS Code: the browser's own computer has another port."""
    assert quiet.get(f"/?{urlsplit(quiet.address).query}", {"Host": "localhost:9999"})[0] == 200
    assert opened(quiet, "localhost:9999", "http://localhost:9999") == 101
    assert opened(quiet, "localhost:9999", "http://localhost:8888") == 403
    assert opened(quiet, "localhost:9999", "http://localhost:9999", token="x") == 403


def test_a_codespace_serves_the_name_at_which_its_port_is_forwarded(
    make_project, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CODESPACE_NAME", "Cuddly-Robot-x7")
    monkeypatch.setenv("GITHUB_CODESPACES_PORT_FORWARDING_DOMAIN", "app.github.dev")
    with served(make_project(QUIET)) as server:
        port, query = urlsplit(server.address).port, urlsplit(server.address).query
        name, local = f"cuddly-robot-x7-{port}.app.github.dev", f"localhost:{port}"
        assert server.printed[0] == f"The simulator is at https://{name}/?{query}\n"
        assert f"On this computer: {server.address}\n" in server.printed
        status, headers, _ = server.get(f"/?{query}", {"Host": name})
        assert status == 200
        assert f"wss://{name}" in headers["content-security-policy"]
        # As it comes from the browser, and as GitHub changes it on the way.
        for host in (name, local):
            for origin in (f"https://{name}", f"https://{host}", f"http://{host}"):
                assert opened(server, host, origin) == 101
                assert opened(server, host, origin, token="x") == 403
        # Another Codespace, also another port of this one, is another page.
        other = f"evil-robot-{port}.app.github.dev"
        for wrong in (other, "cuddly-robot-x7-1.app.github.dev", "app.github.dev", f"x{name}", f"{name}.evil.example"):
            assert server.get(f"/?{query}", {"Host": wrong})[0] == 403, wrong
            assert opened(server, wrong, f"https://{wrong}") == 403, wrong
            assert opened(server, name, f"https://{wrong}") == 403, wrong
            assert opened(server, local, f"https://{wrong}") == 403, wrong
        assert opened(server, local, "null") == 403


def test_a_host_that_the_user_allows(make_project, quiet: Served) -> None:
    hosts = ("Pit.example", "http://cart.local:8080", "[fd00::7]:9000")
    with served(make_project(QUIET), allowed_hosts=hosts) as server:
        addresses = (quiet.address, quiet.viewing_address, server.address, server.viewing_address)
        assert len({urlsplit(address).query for address in addresses}) == 4, "they differ from start to start"
        query = urlsplit(server.address).query
        origins = ("https://pit.example", "http://cart.local:8080", "https://[fd00::7]:9000")
        for origin in origins:
            host = urlsplit(origin).netloc
            assert f"The simulator is at {origin}/?{query}\n" in server.printed
            assert server.get(f"/?{query}", {"Host": host})[0] == 200
            assert server.get("/?token=x", {"Host": host})[0] == 403
            assert opened(server, host, origin) == 101
            assert opened(server, host, origin, token="x") == 403
            assert opened(server, host, "https://evil.example") == 403
        assert server.get(f"/?{query}", {"Host": "evil.example"})[0] == 403
        assert opened(server, "pit.example", "https://pit.example:444") == 403


@for_each(
    "host", ["", "*", "*.example", "ftp://pit.example", "pit.example/page", "pit.example:x", "a b", "user@pit.example"]
)
def test_what_is_no_host(host: str) -> None:
    with pytest.raises(UsageError, match="this is no host"):
        allowed_origins([host])


def test_a_second_user_on_the_network_is_refused(quiet: Served) -> None:
    """The server does not even listen at this computer's address on the network."""
    assert quiet.front_end.server is not None
    other = urlsplit(quiet.front_end.server.network_address()).hostname
    if other is None or other.startswith("127."):
        pytest.skip("the network: needs an address besides 127.0.0.1")
    with pytest.raises(OSError), socket.create_connection((other, urlsplit(quiet.address).port), 2):  # noqa: PT011
        pass


def test_the_page_may_load_its_own_files_only(quiet: Served) -> None:
    for path in (f"/?{urlsplit(quiet.address).query}", "/static/index.html", "/nothing"):
        headers = quiet.get(path)[1]
        rules = dict(rule.strip().split(" ", 1) for rule in headers["content-security-policy"].split(";"))
        assert rules["default-src"] == "'none'"
        assert re.fullmatch(r"'self' 'sha256-[\w+/]{43}='", rules["script-src"])  # of the import map
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


@pytest.mark.filterwarnings("ignore::pyfrc_core.config.findings.SettingsWarning")
def test_no_file_but_a_picture_of_the_project_is_handed_out(make_project) -> None:
    """What is none: `tests/core/test_projects_and_settings.py`."""
    made = make_project(FILES)
    outside = made.path.parent / "outside.svg"
    outside.write_text("<svg>SECRET</svg>")
    (made.path / "sim/link.png").symlink_to(outside)
    if hasattr(os, "mkfifo"):
        os.mkfifo(made.path / "sim/pipe")
        assert field_picture(made.path, "pipe") == (None, "there is no such file")  # it is not opened
    (made.path / "sim/config.json").write_text('{"pyfrc": {"field": {"image": "link.png"}}}')
    with served(made) as server, server.page(server.viewing_address) as page:
        assert page.parts["field"]["image"] is None
        page.until(lambda: any("field.image" in line["text"] for line in page.console))
        query = urlsplit(server.viewing_address).query
        assert server.get(f"/field-image?{query}")[0] == 404
    result = made.run("sim", "--ui", "none", "--seconds", "0.1", "--page", "run.html")
    assert result.code == 0, result.output
    written = made.path / "run.html"
    assert run_in(written)["hello"]["field"]["image"] is None
    assert "SECRET" not in written.read_text("utf-8")


@pytest.mark.slow
def test_a_picture_that_becomes_a_link_is_not_handed_out(make_project) -> None:
    made = make_project(QUIET)
    outside = made.path.parent / "outside.svg"
    outside.write_text("<svg>SECRET</svg>")
    with served(made) as server:
        address = f"/field-image?{urlsplit(server.address).query}"
        status, headers, _ = server.get(address)
        assert (status, headers["content-type"].partition(";")[0]) == (200, "image/svg+xml")
        (made.path / "sim/field.png").unlink()
        (made.path / "sim/field.png").symlink_to(outside)
        assert server.get(address)[0] == 404


def test_a_layout_that_is_a_link_is_not_handed_out(make_project) -> None:
    made = make_project(FILES)
    outside = made.path.parent / "outside.json"
    outside.write_text('{"secret": 1}')
    (made.path / ".pyfrc").mkdir()
    (made.path / ".pyfrc/sim-layout.json").symlink_to(outside)
    with served(made) as server, server.page(server.viewing_address) as page:
        assert page.hello["layout"] is None
