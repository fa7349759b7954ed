"""What publishes NetworkTables in another process, as a robot does, and a link to it that can be cut.

This file is also the program of that process: it reads commands as JSON lines, and replies to each.
"""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from time import monotonic, sleep
from typing import Any

WORD = "/FMSInfo/FMSControlData"
#: Values of the control word: a driver station is attached; also enabled in autonomous, and in teleoperated.
DISABLED, AUTONOMOUS, TELEOP = 32, 35, 33


class NetworkRobot:
    """A program with NetworkTables.

    :param directory: where it may write
    """

    def __init__(self, directory: Path, port: int) -> None:
        self._directory, self.port = directory, port
        self._start()

    def _start(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, __file__, str(self.port)],
            cwd=self._directory,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )
        self._ask("count")
        self.set("/FMSInfo/.type", "string", "FMSInfo")
        self.set(WORD, "int", DISABLED)

    def _ask(self, command: str, *arguments: Any) -> Any:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps([command, *arguments]) + "\n")
        self._process.stdin.flush()
        return json.loads(self._process.stdout.readline())

    def set(self, name: str, type_name: str, value: Any) -> None:
        """Publish a value."""
        self._ask("set", name, type_name, value)

    def set_data(self, name: str, type_name: str, data: bytes) -> None:
        """Publish bytes, such as a struct or a schema."""
        self._ask("data", name, type_name, data.hex())

    def get(self, name: str) -> Any:
        """Return a value, which others may have set."""
        return self._ask("get", name)

    def until(self, name: str, value: Any) -> None:
        """Wait until another program has set a value."""
        self._ask("until", name, value)

    def remove(self, name: str) -> None:
        """Publish a value no longer."""
        self._ask("remove", name)

    def flood(self, topics: int, changes: int, seconds: float) -> int:
        """Change topics in turn, this many times a second; return at the end how often they were changed."""
        return int(self._ask("flood", topics, changes, seconds))

    def end(self) -> None:
        """End the program, as a crash does."""
        self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                with suppress(OSError):
                    stream.close()

    def restart(self) -> None:
        """End the program, and start it again."""
        self.end()
        self._start()


@contextmanager
def network_robot(directory: Path, port: int) -> Iterator[NetworkRobot]:
    """Start a program with NetworkTables, and end it."""
    robot = NetworkRobot(directory, port)
    try:
        yield robot
    finally:
        robot.end()


class Link:
    """A TCP connection to a port of this computer through a port of its own, which can be cut."""

    def __init__(self, to: int) -> None:
        self._to = to
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listening.getsockname()[1]
        self._is_cut = self._is_over = False
        self._open: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self) -> None:
        """Close what is open, and accept nothing."""
        self._is_cut = True
        self._close_open()

    def mend(self) -> None:
        """Accept again."""
        self._is_cut = False

    def close(self) -> None:
        self._is_over = True
        self._listening.close()
        self._close_open()

    def _close_open(self) -> None:
        for each in self._open:
            with suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)
            each.close()
        self._open.clear()

    def _accept(self) -> None:
        while not self._is_over:
            try:
                client, _ = self._listening.accept()
            except OSError:
                return
            try:
                if self._is_cut:
                    raise OSError("cut")
                server = socket.create_connection(("127.0.0.1", self._to))
            except OSError:
                client.close()
                continue
            self._open += (client, server)
            for one, other in ((client, server), (server, client)):
                threading.Thread(target=self._pass_on, args=(one, other), daemon=True).start()

    @staticmethod
    def _pass_on(one: socket.socket, other: socket.socket) -> None:
        with suppress(OSError):
            while data := one.recv(1 << 16):
                other.sendall(data)
        for each in (one, other):
            with suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)


@contextmanager
def link_to(port: int) -> Iterator[Link]:
    """Open a link, and close it."""
    link = Link(port)
    try:
        yield link
    finally:
        link.close()


def _flood(topics: int, changes: int, seconds: float) -> int:
    from pyfrc_core.wpi import network

    entries = [network.Entry(f"/flood/{number}") for number in range(topics)]
    began, count = monotonic(), 0
    while (passed := monotonic() - began) < seconds:
        while count < passed * changes:
            entries[count % topics].write(float(count), "double")
            count += 1
        sleep(0.005)
    return count


def _main() -> None:
    from pyfrc_core.wpi import network

    network.serve_this_computer(int(sys.argv[1]))
    entries: dict[str, Any] = {}
    for line in sys.stdin:
        command, *arguments = json.loads(line)
        reply: Any = None
        match command:
            case "set":
                name, type_name, value = arguments
                entries.setdefault(name, network.Entry(name)).write(value, type_name)
            case "data":
                name, type_name, digits = arguments
                if name not in entries:
                    entries[name] = network.DataEntry(name, type_name)
                entries[name].write(bytes.fromhex(digits))
            case "get":
                reply = network.value_of(arguments[0])
            case "until":
                while network.value_of(arguments[0]) != arguments[1]:
                    sleep(0.005)
            case "remove":
                entries.pop(arguments[0]).unpublish()
            case "flood":
                reply = _flood(*arguments)
            case "count":
                reply = network.count_entries()
        print(json.dumps(reply), flush=True)


if __name__ == "__main__":
    _main()
