"""The front end of `pyfrc sim` without `--ui`: the page, unless no person would see it."""

from __future__ import annotations

import os
import sys
import webbrowser
from types import SimpleNamespace

import pytest
from browsers import NO_BROWSER
from sim_robots import FILES

from pyfrc_core import browser
from pyfrc_core.browser import open_in_browser, why_no_browser
from pyfrc_core.sim.ui import choose

pytestmark = pytest.mark.bare

SSH = {"SSH_CONNECTION": "10.0.0.2 50000 10.0.0.3 22"}
DESKTOP = {"DISPLAY": ":0"}


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch):
    """Make this machine another one, by its environment."""

    def change(platform: str = "linux", terminal: bool = True, **variables: str) -> None:
        for name, value in (NO_BROWSER | variables).items():
            monkeypatch.setenv(name, value)
        monkeypatch.setattr("pyfrc_core.display.sys", SimpleNamespace(platform=platform))
        monkeypatch.setattr(choose, "has_terminal", lambda: terminal)

    return change


@pytest.mark.parametrize(
    ("platform", "variables", "why"),
    [
        ("linux", {}, "there is no display"),
        ("linux", DESKTOP, ""),
        ("linux", {"WAYLAND_DISPLAY": "wayland-0"}, ""),
        ("linux", {**SSH, "DISPLAY": "localhost:10.0"}, "this is an SSH session"),
        # VS Code sets it over SSH, in containers and Codespaces; ChromeOS in its Linux container.
        ("linux", {**SSH, "BROWSER": "/vscode/bin/helpers/browser.sh"}, ""),
        ("linux", {"BROWSER": "/usr/bin/garcon-url-handler"}, ""),
        ("linux", {**DESKTOP, "CI": "true"}, "CI is set"),
        ("linux", {"BROWSER": "firefox", "CI": "1"}, "CI is set"),
        ("linux", {**DESKTOP, "CI": "false"}, ""),
        ("darwin", {}, ""),
        ("darwin", SSH, "this is an SSH session"),
        ("win32", {}, ""),
        ("win32", {"SSH_TTY": "windows-pty"}, "this is an SSH session"),
    ],
)
def test_whether_a_browser_can_be_opened(machine, platform: str, variables: dict[str, str], why: str) -> None:
    machine(platform, **variables)
    assert why_no_browser() == why


@pytest.mark.parametrize(
    ("variables", "terminal", "chosen"),
    [
        (DESKTOP, True, ("web", "")),
        (DESKTOP, False, ("web", "")),  # an icon on the desktop, an editor's "Run"
        ({}, True, ("web", "")),  # its address is printed
        (SSH, True, ("web", "")),
        ({}, False, ("none", "there is no display, and no terminal")),
        (SSH, False, ("none", "this is an SSH session, and no terminal")),
        ({**DESKTOP, "CI": "true"}, True, ("none", "CI is set")),
    ],
)
def test_the_default(machine, variables: dict[str, str], terminal: bool, chosen: tuple[str, str]) -> None:
    machine(terminal=terminal, **variables)
    assert choose.default_name() == chosen


def test_a_text_browser_does_not_take_over_the_terminal(machine, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda address: opened.append(address) is None)
    monkeypatch.setattr(webbrowser, "get", lambda: webbrowser.GenericBrowser("w3m"))
    machine(**DESKTOP)
    assert not open_in_browser("http://127.0.0.1:1/")
    assert opened == []
    machine(BROWSER="w3m")  # the user's own choice
    assert open_in_browser("http://127.0.0.1:1/")
    monkeypatch.setattr(webbrowser, "get", lambda: webbrowser.BackgroundBrowser("xdg-open"))
    machine(**DESKTOP)
    assert open_in_browser("http://127.0.0.1:2/")
    assert opened == ["http://127.0.0.1:1/", "http://127.0.0.1:2/"]

    def none() -> None:
        raise webbrowser.Error("could not locate runnable browser")

    monkeypatch.setattr(webbrowser, "get", none)
    assert not browser.open_in_browser("http://127.0.0.1:3/")


def test_a_script_without_a_person_gets_no_page(make_project) -> None:
    """It would wait for a person forever."""
    made = make_project(FILES)
    done = made.run("sim", "--seconds", "0.1", env=NO_BROWSER)
    assert done.code == 0, done.output
    assert "No page: there is no display, and no terminal. This is --ui none." in done.stdout
    assert "simulated 0.1" in done.stdout


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo-terminals")
def test_a_person_without_a_browser_gets_the_address(make_project) -> None:
    import pty

    made = make_project(FILES)
    own, terminal = pty.openpty()
    with made.start("sim", "--nt-port", "0", env={**NO_BROWSER, **SSH}, stdin=terminal) as running:
        try:
            assert "this is an SSH session" in running.until("^No browser is opened")
            assert running.read.startswith("The simulator is at http://127.0.0.1:"), running.read
            assert running.poll() is None
        finally:
            os.close(own)
            os.close(terminal)
