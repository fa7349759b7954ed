"""The robot program's output, with `pyfrc console` and after a deploy."""

from __future__ import annotations

import contextlib
import random
import re
import signal
import socket
import struct
import threading
from collections.abc import Callable, Iterator

import pytest
from loops import for_each
from ports import address_without_servers, refusing_port
from roborio import PATIENCE, Roborio
from roborio.fixtures import roborio  # noqa: F401 - `robot`
from started_commands import StartedCommand

import pyfrc_core.deploy.console
from pyfrc_core.deploy.console import imitated_driver_station
from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.errors import NoConsoleError

Follow = Callable[..., NoConsoleError]

ROBOT = """
import wpilib

class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        print("the words of our robot")
"""


@contextlib.contextmanager
def running(project, *args: str) -> Iterator[StartedCommand]:
    """The command, ended by Ctrl-C at the end."""
    with project.start(*args) as it:
        try:
            yield it
        finally:
            it.send_signal(signal.SIGINT)
            it.rest()


def wait_for(command: StartedCommand, text: str) -> None:
    shown = []
    for line in command.stdout:
        shown.append(line)
        if text in line:
            return
    raise AssertionError(f"{text!r} was not printed, but:\n{''.join(shown)}")


def test_the_console_shows_what_the_program_prints_and_connects_again(robot: Roborio, make_project) -> None:
    project = make_project({"robot.py": ROBOT})
    with running(project, "console", "--robot", robot.where) as console:
        wait_for(console, "connected to")
        assert project.run("deploy", "--skip-tests", "--robot", robot.where).code == 0
        wait_for(console, "the words of our robot")
        robot.power_off()
        wait_for(console, "the connection was lost")
        robot.power_on()
        wait_for(console, "connected to")
    assert console.wait() == 130


def test_outside_of_a_project_the_console_waits_for_a_robot_that_is_not_there_yet(make_project) -> None:
    project = make_project({})
    host = address_without_servers()
    for option in ([], ["--nc-ds"]):
        with running(project, "console", "--robot", host, *option) as console:
            port = 1740 if option else 1741
            wait_for(console, f"{host}:{port} refuses the connection: check the address, and that the robot is on")
        assert console.wait() == 130


class ConsoleServer:
    """A local stand-in for a robot's console; an SSH greeting names its port, as a virtual robot's does.

    :param connections: what each connection sends, in order; None: its port is closed. The connection is closed then
    """

    def __init__(self, *connections: bytes | None) -> None:
        self._connections = connections
        self._ssh = socket.create_server(("127.0.0.1", 0))
        self.address = Address("127.0.0.1", self._ssh.getsockname()[1])
        self._thread = threading.Thread(target=self._serve)

    def __enter__(self) -> ConsoleServer:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._thread.join(PATIENCE)
        self._ssh.close()
        assert not self._thread.is_alive()

    def _serve(self) -> None:
        with refusing_port() as refusing:
            for content in self._connections:
                with socket.create_server(("127.0.0.1", 0)) as console:
                    port = refusing if content is None else console.getsockname()[1]
                    asked, _ = self._ssh.accept()
                    with asked:
                        asked.sendall(b"SSH-2.0-pyfrc_virtual_robot console=%d\r\n" % port)
                    if content is not None:
                        listener, _ = console.accept()
                        with listener, contextlib.suppress(OSError):
                            self._send(listener, content)

    def _send(self, listener: socket.socket, content: bytes) -> None:
        listener.sendall(content)
        listener.shutdown(socket.SHUT_WR)
        while listener.recv(1 << 16):
            pass


def framed(body: bytes) -> bytes:
    return struct.pack(">H", len(body)) + body


def info(text: str) -> bytes:
    return framed(struct.pack(">BfH", 12, 1.5, 7) + text.encode())


def error(*parts: str) -> bytes:
    texts = b"".join(framed(part.encode()) for part in parts)
    return framed(struct.pack(">BfHHiB", 11, 2.5, 8, 1, -44, 0) + texts)


EMPTY_INFO = b"\0\x01\x0c"


@pytest.fixture
def follow(monkeypatch: pytest.MonkeyPatch) -> Follow:
    monkeypatch.setattr(pyfrc_core.deploy.console, "_SECONDS_BETWEEN_TRIES", 0.0)

    def follow_to_nonsense(*connections: bytes | None, quiet: bool = False) -> NoConsoleError:
        with ConsoleServer(*connections) as server, pytest.raises(NoConsoleError) as caught:
            pyfrc_core.deploy.console.follow_console(server.address, quiet=quiet)
        return caught.value

    return follow_to_nonsense


@for_each(
    "content",
    [
        framed(b"\x0b" + bytes(13) + b"\xff\xffshort"),
        b"HTTP/1.1 400 Bad Request\r\nConnection: close\r\n\r\n",
        random.Random(1).randbytes(1 << 20),
    ],
)
def test_what_is_no_console_is_named_in_one_sentence(content: bytes, follow: Follow) -> None:
    error = follow(info("before") + content)
    assert error.exit_code == 1
    assert re.match(r"127\.0\.0\.1:\d+: the server is not a robot's console: .+\n  \S", str(error)), str(error)


def test_the_command_ends_with_exit_code_1_and_no_traceback(make_project) -> None:
    with ConsoleServer(EMPTY_INFO) as server:
        result = make_project({}).run_here("console", "--robot", str(server.address))
    assert result.code == 1
    assert "error: 127.0.0.1:" in result.stderr
    assert "is not a robot's console: it sends a text message of 1 bytes" in result.stderr
    assert "Traceback" not in result.output


def test_frames_are_lines_whatever_else_comes(follow: Follow, capsys: pytest.CaptureFixture[str]) -> None:
    hello = info("Größe\u202e")
    follow(b"\0\0" + hello + framed(b"\x0dother") + bytes(200) + error("wrong", "here", "") + EMPTY_INFO)
    assert capsys.readouterr().out == "[1.50] Größe\\u202e\n[2.50] -44 wrong here \n"


def test_after_a_loss_it_connects_again(follow: Follow, capsys: pytest.CaptureFixture[str]) -> None:
    follow(info("one") + info("cut")[:-1], None, None, None, info("two"), EMPTY_INFO)
    printed = capsys.readouterr()
    assert printed.out == "[1.50] one\n[1.50] two\n"
    assert printed.err.count(" refuses the connection: ") == 1
    assert printed.err.count("the connection was lost") == 2


def test_connections_that_end_at_once_are_not_reported_each(follow: Follow, capsys: pytest.CaptureFixture[str]) -> None:
    follow(*[b""] * 20, EMPTY_INFO)
    assert len(capsys.readouterr().err.splitlines()) == 2


def test_a_quiet_console_shows_only_what_the_program_prints(follow: Follow, capsys: pytest.CaptureFixture[str]) -> None:
    follow(None, info("one"), info("two"), EMPTY_INFO, quiet=True)
    assert capsys.readouterr() == ("[1.50] one\n[1.50] two\n", "")


def test_options_about_keys_are_not_taken(make_project) -> None:
    listed = make_project({}).run_here("console", "--help").stdout
    assert "--robot HOST" in listed
    assert not [each for each in ("--accept-host-key", "--robot-name") if each in listed]


def test_the_imitated_driver_station_stays_disabled_and_survives_a_closed_connection() -> None:
    with (
        socket.create_server(("127.0.0.1", 0)) as tcp,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as udp,
    ):
        udp.bind(("127.0.0.1", 0))
        udp.settimeout(PATIENCE)
        with imitated_driver_station("127.0.0.1", tcp.getsockname()[1], udp.getsockname()[1]):
            robot, _ = tcp.accept()
            robot.close()
            packets = [udp.recv(100) for _ in range(5)]
    assert packets == [bytes([number, 0, 1, 0, 0, 0]) for number in range(1, 6)]


def test_a_deploy_may_end_in_the_console(robot: Roborio, make_project) -> None:
    project = make_project({"robot.py": ROBOT})
    with running(project, "deploy", "--skip-tests", "--robot", robot.where, "--nc-ds") as deploying:
        wait_for(deploying, "Deployed.")
        wait_for(deploying, "connected to")
        robot.run("/usr/local/frc/bin/frcKillRobot.sh", "-t", "-r")
        wait_for(deploying, "the words of our robot")
    assert deploying.wait() == 130
