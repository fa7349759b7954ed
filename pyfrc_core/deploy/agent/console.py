"""The output of the robot program, from the robot's console service or from a command such as ``journalctl``."""

from __future__ import annotations

import os
import select
import struct
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Union

if TYPE_CHECKING:
    import socket
    import subprocess

#: The console's ports: for any client, and for the Driver Station.
PORTS = (1741, 1740)
#: Kinds of messages, the first byte of each.
ERROR, TEXT = 11, 12
#: An empty frame.
KEEP_ALIVE = b"\0\0"
_KEEP_ALIVE_SECONDS = 1.0
#: Seconds to wait for more output after the first, so that several lines are read together.
_BATCH_SECONDS = 0.02


class ConsoleClient:
    """A connection to the console, if it can be reached.

    :param ports: loopback ports to try in turn
    """

    def __init__(self, ports: tuple[int, ...]) -> None:
        self._ports = ports
        self._socket: socket.socket | None = None
        self._unread = b""
        self._keep_alive = 0.0

    def connect(self) -> None:
        """Connect, to receive the output from now on."""
        import socket

        self.disconnect()
        for port in self._ports:
            try:
                self._socket = socket.create_connection(("127.0.0.1", port), timeout=1.0)
            except OSError:
                continue
            self._socket.setblocking(False)
            return

    def disconnect(self) -> None:
        """Disconnect."""
        if self._socket is not None:
            self._socket.close()
        self._socket, self._unread = None, b""

    def receive(self, seconds: float) -> str:
        """Wait up to `seconds` for output, and return the complete lines that have arrived."""
        if self._socket is None:
            time.sleep(seconds)
            return ""
        now = time.monotonic()
        try:
            if now >= self._keep_alive:
                self._socket.send(KEEP_ALIVE)
                self._keep_alive = now + _KEEP_ALIVE_SECONDS
            if not select.select([self._socket], [], [], seconds)[0]:
                return ""
            time.sleep(min(_BATCH_SECONDS, seconds))
            chunk = self._socket.recv(1 << 18)
        except BlockingIOError:
            return ""
        except OSError:
            chunk = b""
        messages, self._unread = split_frames(self._unread + chunk)
        if not chunk:
            self.disconnect()
        return "".join(map(console_text, messages))


class OutputCommand:
    """A command that prints the program's output, if it can be run. `ConsoleClient` has the same methods.

    :param command: prints the output from its start on, until it is killed
    """

    def __init__(self, command: Sequence[str]) -> None:
        self._command = command
        self._process: subprocess.Popen[bytes] | None = None
        self._unread = b""

    def connect(self) -> None:
        """Start the command, to receive the output from now on."""
        import subprocess

        self.disconnect()
        with suppress(OSError):
            self._process = subprocess.Popen(
                self._command,
                bufsize=0,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
            )

    def disconnect(self) -> None:
        """Stop the command."""
        if self._process is not None:
            assert self._process.stdout is not None
            self._process.kill()
            self._process.wait()
            self._process.stdout.close()
        self._process, self._unread = None, b""

    def receive(self, seconds: float) -> str:
        """Wait up to `seconds` for output, and return the complete lines that have arrived."""
        if self._process is None:
            time.sleep(seconds)
            return ""
        assert self._process.stdout is not None
        pipe = self._process.stdout.fileno()
        if not select.select([pipe], [], [], seconds)[0]:
            return ""
        time.sleep(min(_BATCH_SECONDS, seconds))
        chunk = os.read(pipe, 1 << 16)
        if not chunk:
            self.disconnect()
            return ""
        lines, newline, self._unread = (self._unread + chunk).rpartition(b"\n")
        return (lines + newline).decode(errors="replace")


Console = Union[ConsoleClient, OutputCommand]  # noqa: UP007 - the agent runs on Python 3.9, too


def split_frames(received: bytes) -> tuple[list[bytes], bytes]:
    """Return the complete messages, and the remaining bytes of an incomplete frame."""
    messages, start = [], 0
    while len(received) >= start + 2:
        end = start + 2 + int.from_bytes(received[start : start + 2], "big")
        if end > len(received):
            break
        messages.append(received[start + 2 : end])
        start = end
    return messages, received[start:]


def console_text(message: bytes) -> str:
    """Return the text of a console message as one line; empty for other kinds of messages."""
    if message[:1] == bytes([TEXT]):
        line = message[1 + 4 + 2 :].decode(errors="replace")
        return line if line.endswith("\n") else line + "\n"
    if message[:1] == bytes([ERROR]):
        parts, rest = [], message[1 + 4 + 2 + 2 + 4 + 1 :]
        while len(rest) >= 2:
            (length,) = struct.unpack_from(">H", rest)
            parts.append(rest[2 : 2 + length].decode(errors="replace"))
            rest = rest[2 + length :]
        return " ".join(part for part in parts if part) + "\n"
    return ""
