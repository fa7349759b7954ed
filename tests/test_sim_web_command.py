"""`pyfrc sim` with its page, as a user runs it: what it prints, what it opens, how it ends; with robots that fail."""

from __future__ import annotations

import os
import re
import signal
import socket
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from browsers import NO_BROWSER
from conftest import RobotProject, sampled
from sim_robots import FILES, PATIENCE
from started_commands import StartedCommand
from web_pages import Page, served
from websockets.sync.client import connect

ADDRESS = re.compile(r"The simulator is at (http://127\.0\.0\.1:\d+/\?token=\S+)")


class Running:
    """A `pyfrc sim` with a page, which goes on."""

    def __init__(self, command: StartedCommand) -> None:
        self.command = command
        found = ADDRESS.search(command.until(ADDRESS.pattern))
        assert found is not None
        self.address = found[1]

    @contextmanager
    def page(self) -> Iterator[Page]:
        parts = urlsplit(self.address)
        with connect(f"ws://{parts.netloc}/ws?{parts.query}", max_size=None, origin=f"http://{parts.netloc}") as opened:
            yield Page(opened)

    def ended(self) -> int:
        """Wait for the end, and return the exit code."""
        self.command.rest(PATIENCE)
        return self.command.wait()


@contextmanager
def simulating(made: RobotProject, *arguments: str, environment: Mapping[str, str] | None = None) -> Iterator[Running]:
    given = {**NO_BROWSER, **(environment or {})}
    with made.start("sim", "--nt-port", "0", *arguments, env=given) as command:
        yield Running(command)


@pytest.mark.parametrize("name", sampled(["SIGINT", "SIGTERM"], "SIGTERM"))
def test_it_prints_its_address_and_ends_by_a_signal(make_project, name: str) -> None:
    with simulating(make_project(FILES), "--ui", "web") as running:
        running.command.until("No browser is opened: there is no display.")
        with running.page() as page:
            page.until(lambda: page.status["state"] == "running")
            page.command("enable")
            page.until(lambda: page.station.get("enabled"))
            running.command.send_signal(getattr(signal, name))
            assert running.ended() == 128 + getattr(signal, name)
        assert "the robot is there" in running.command.read
        assert "Traceback" not in running.command.read
        with pytest.raises(OSError), socket.create_connection(("127.0.0.1", urlsplit(running.address).port), 2):  # noqa: PT011
            pass


def test_it_ends_by_the_page_and_writes_its_files(make_project) -> None:
    made = make_project(FILES)
    with simulating(made, "--ui", "web", "--record", "drive.jsonl") as running:
        with running.page() as page:
            page.until(lambda: page.time > 0.1)
            page.quit()
            assert running.ended() == 0
        assert "wrote drive.jsonl" in running.command.read
    assert (made.path / "drive.jsonl").is_file()


def test_it_opens_the_page_in_a_browser_where_there_is_one(make_project) -> None:
    """That is the default."""
    made = make_project({**FILES, "browser.py": "import sys; open('opened.txt', 'w').write(sys.argv[1])"})
    browser = f"{sys.executable} {made.path / 'browser.py'} %s"
    with simulating(made, environment={"BROWSER": browser}) as running:
        end = time.monotonic() + PATIENCE
        opened = made.path / "opened.txt"
        while not (opened.is_file() and opened.read_text()) and time.monotonic() < end:
            time.sleep(0.05)
        assert opened.read_text() == running.address


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere no program on the path is the browser")
def test_the_key_stands_in_no_command_line(make_project) -> None:
    """All users of the computer could read it there."""
    made = make_project(FILES)
    browser = made.path.parent / "bin" / "xdg-open"
    browser.parent.mkdir()
    browser.write_text(
        f'#!/bin/sh\necho "$*" > {made.path}/part.txt && mv {made.path}/part.txt {made.path}/opened.txt\n'
    )
    browser.chmod(0o755)
    environment = {"DISPLAY": ":77", "PATH": f"{browser.parent}:{os.environ['PATH']}"}
    with simulating(made, environment=environment) as running:
        end = time.monotonic() + PATIENCE
        opened = made.path / "opened.txt"
        while not opened.is_file() and time.monotonic() < end:
            time.sleep(0.05)
        arguments = opened.read_text()
        assert urlsplit(running.address).query.removeprefix("token=") not in arguments
        file = Path(urlsplit(arguments.strip()).path)
        assert file.stat().st_mode & 0o777 == 0o600
        assert f'url={running.address}"' in file.read_text(encoding="utf-8")
        with running.page() as page:
            page.quit()
            assert running.ended() == 0
    assert not file.exists()


def test_new_code_comes_with_a_saved_file(make_project) -> None:
    made = make_project(FILES)
    with simulating(made, "--ui", "web", "--watch") as running, running.page() as page:
        assert page.hello["options"]["watch"] is True
        page.until(lambda: page.status["state"] == "running")  # a page may come before the robot has started
        page.command("enable")
        page.command("axis", stick=0, axis=1, value=-1.0)
        page.until(lambda: page.values.get("pwm[0].value") == 1)
        robot = made.path / "robot.py"
        robot.write_text(robot.read_text().replace("SPEED = 1.0", "SPEED = 0.5"))
        page.until(lambda: page.values.get("pwm[0].value") == pytest.approx(0.5, abs=0.01))
        page.until(lambda: any(line["text"] == "saved: robot.py" for line in page.console))
        assert page.status["starts"] == 2
        page.until(lambda: page.parts["branches"] or page.parts["run"]["number"] == 2)
        page.quit()
        assert running.ended() == 0


def test_a_robot_that_ends_leaves_the_page_alive(make_project) -> None:
    with served(make_project(FILES)) as server, server.page() as page:
        page.run_for(0.1)
        page.command("enable")
        page.command("button", stick=0, button=7, pressed=True)
        page.command("step", packets=5)
        page.until(lambda: page.status["state"] == "failed")
        assert re.search("exit|ended", page.status["failure"]["headline"])
        assert page.ask(type="values", t=0.05)["values"]["sim.mode"] == "disabled"
        page.command("restart")
        page.until(lambda: page.status["state"] == "paused" and page.status["starts"] == 2)


def test_its_options_belong_to_it(make_project) -> None:
    made = make_project(FILES)
    for option in (["--share"], ["--port", "7777"], ["--allow-host", "cart.example"]):
        result = made.run_here("sim", "--ui", "none", "--seconds", "1", *option)
        assert result.code == 2
        assert "Add --ui web" in result.output
    unshared = made.run_here("sim", "--ui", "none", "--seconds", "1", "--share", "drive")
    assert unshared.code == 2
    assert "Add --nt-port 5810" in unshared.output
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        result = made.run_here("sim", "--ui", "web", "--port", str(taken.getsockname()[1]))
        assert result.code == 2
        assert "Choose another --port" in result.output
    assert made.run_here("sim", "--ui", "web", "--mode", "auto").code == 2
    result = made.run_here("sim", "--allow-host", "*.example")
    assert (result.code, result.first_error) == (2, "--allow-host *.example: this is no host")
