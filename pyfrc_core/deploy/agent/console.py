"""What the robot program prints, as the robot's console service sends it."""

from __future__ import annotations

import select
import socket
import struct
import time

from .virtual import virtual_robot

#: The console's ports: for listeners of any kind, and for the Driver Station.
PORTS = (1741, 1740)
#: Kinds of messages: the first byte of each.
ERROR, TEXT = 11, 12
#: An empty frame.
KEEP_ALIVE = b"\0\0"
_KEEP_ALIVE_SECONDS = 1.0
#: Seconds for which more output is waited for when some has come, so that each line costs no turn of its own.
_MORE = 0.02


class Console:
    """A listener to the console, as far as there is one."""

    def __init__(self) -> None:
        self._socket: socket.socket | None = None
        self._unread = b""
        self._keep_alive = 0.0

    def listen(self) -> None:
        """Connect; what is printed from now on is heard."""
        self.leave()
        virtual = virtual_robot()
        for port in PORTS if virtual is None else (virtual.console,):
            try:
                self._socket = socket.create_connection(("127.0.0.1", port), timeout=1.0)
            except OSError:
                continue
            self._socket.setblocking(False)
            return

    def leave(self) -> None:
        """Disconnect."""
        if self._socket is not None:
            self._socket.close()
        self._socket, self._unread = None, b""

    def hear(self, seconds: float) -> str:
        """Wait so long for output, and return what has come: whole lines."""
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
            time.sleep(min(_MORE, seconds))
            piece = self._socket.recv(1 << 18)
        except BlockingIOError:
            return ""
        except OSError:
            piece = b""
        messages, self._unread = split_frames(self._unread + piece)
        if not piece:
            self.leave()
        return "".join(map(console_text, messages))


def split_frames(received: bytes) -> tuple[list[bytes], bytes]:
    """Return the messages that are complete, and the bytes after them, which are no whole frame yet."""
    messages, start = [], 0
    while len(received) >= start + 2:
        end = start + 2 + int.from_bytes(received[start : start + 2], "big")
        if end > len(received):
            break
        messages.append(received[start + 2 : end])
        start = end
    return messages, received[start:]


def console_text(message: bytes) -> str:
    """What one message of the console says, a line; nothing, if it is of another kind."""
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
