"""The robot program: whether it runs, starting it again, and listening to what it prints."""

from __future__ import annotations

import os
import select
import socket
import struct
import subprocess
import time
from pathlib import Path

from .places import CODE, HOME, Places, Refusal
from .wire import Said, Wire

KILL_SCRIPT = "/usr/local/frc/bin/frcKillRobot.sh"
_PATHS = "/etc/profile.d/natinst-path.sh"
#: The console's ports: for listeners of any kind, and for the Driver Station.
_CONSOLES = (1741, 1740)
_ERROR, _TEXT = 11, 12
_PLACES_OF_CODE = (f"{CODE}/".encode(), f"{HOME}/.pyfrc/releases/".encode())
_KEEP_ALIVE = b"\0\0"
_STARTED = "Robot program startup complete"
_TURN = 0.1  # seconds between two looks at the program
_LAST_WORDS = 0.5  # seconds in which a dead program's output may still come
_NOT_RUN = (126, 127)  # a shell's exit codes
_SWITCH_OFF = "Switch the robot off and on again: it starts the new program then."
_TIME_TO_STOP = 15.0  # seconds


def processes() -> set[int]:
    """The processes that run code of the robot program's directory."""
    found = set()
    for entry in os.scandir("/proc"):
        if entry.name.isdigit() and int(entry.name) != os.getpid():
            try:
                if entry.stat().st_uid != os.geteuid():
                    continue
                words = Path(entry.path, "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            # Not whoever looks at a file there, by tail -f or an editor.
            is_python = words[0].rpartition(b"/")[2].startswith(b"python")
            if is_python and any(word.startswith(_PLACES_OF_CODE) for word in words):
                found.add(int(entry.name))
    return found


def stop(places: Places, *, start: bool) -> set[int]:
    """Have the robot stop its program, and start it again if wanted; the processes of before, of which none is left.

    The script may fail where nothing ran: whether the program has ended is seen.
    """
    before = processes()
    script = places.of(KILL_SCRIPT)
    if not script.exists():
        raise Refusal(
            "restart",
            f"there is no {KILL_SCRIPT} on the robot, so its program cannot be restarted",
            "Switch the robot off and on again; if that does not help, image it.",
        )
    words = ['[ ! -r "$1" ] || . "$1"; shift; exec "$@"', "sh", str(places.of(_PATHS)), str(script), "-t"]
    give_up = time.monotonic() + _TIME_TO_STOP
    try:
        done = subprocess.run(
            ["/bin/sh", "-c", *words, *(["-r"] if start else [])],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=_TIME_TO_STOP,
            check=False,
        )
        said = done.stdout.decode(errors="replace").strip()
        if done.returncode in _NOT_RUN:
            raise Refusal("restart", f"{KILL_SCRIPT} cannot be run: {said}", _SWITCH_OFF)
    except subprocess.TimeoutExpired:
        said = "it does not come to its end"
    while before & processes():
        if time.monotonic() > give_up:
            raise Refusal(
                "restart",
                f"{KILL_SCRIPT} has not stopped the old program: {said or 'it says nothing'}",
                _SWITCH_OFF,
            )
        time.sleep(_TURN / 4)
    return before


class Program:
    """The program from a moment before its restart on."""

    def __init__(self, places: Places) -> None:
        self._places = places
        self._before: set[int] = set()
        self._console: socket.socket | None = None
        self._unread = b""

    def restart(self) -> None:
        """Start it again, listening to the console from before; return when the old one has ended."""
        self.listen()
        self._before = stop(self._places, start=True)

    def listen(self) -> None:
        """Listen to the console, as far as there is one."""
        self.leave()
        for port in _CONSOLES:
            try:
                self._console = socket.create_connection(("127.0.0.1", port), timeout=1.0)
            except OSError:
                continue
            return

    def leave(self) -> None:
        """Listen no more."""
        if self._console is not None:
            self._console.close()
        self._console, self._unread = None, b""

    def watch(self, wire: Wire, seconds: float) -> Said:
        """Pass on what the new program prints, until it says that it has started, ends, or the time is over."""
        now = time.monotonic()
        end, keep_alive, seen = now + seconds, now, False
        printed, dead_since = "", None
        while True:
            now = time.monotonic()
            if now >= keep_alive:
                self._keep_alive()
                keep_alive = now + 1.0
            text = self._hear(_TURN)
            if text:
                printed = (printed + text)[-65536:]
                wire.say(output=text)
            alive = bool(processes() - self._before)
            seen = seen or alive
            if _STARTED in printed and alive:
                return {"alive": True, "started": True, "heard": True}
            if alive or not (seen or "Traceback (most recent call last)" in printed):
                dead_since = None
            elif dead_since is None:
                dead_since = now
            over = now >= end or wire.pending()
            if over or (dead_since is not None and now - dead_since >= _LAST_WORDS):
                return {"alive": alive, "started": _STARTED in printed, "heard": bool(printed)}

    def _keep_alive(self) -> None:
        if self._console is not None:
            try:
                self._console.sendall(_KEEP_ALIVE)
            except OSError:
                self.leave()

    def _hear(self, seconds: float) -> str:
        if self._console is None:
            time.sleep(seconds)
            return ""
        if not select.select([self._console], [], [], seconds)[0]:
            return ""
        try:
            piece = self._console.recv(65536)
        except OSError:
            piece = b""
        if not piece:
            self.leave()
        self._unread += piece
        texts = []
        while len(self._unread) >= 2:
            (length,) = struct.unpack_from(">H", self._unread)
            if len(self._unread) < 2 + length:
                break
            texts.append(console_text(self._unread[2 : 2 + length]))
            self._unread = self._unread[2 + length :]
        return "".join(texts)


def console_text(message: bytes) -> str:
    """What one message of the console says, a line; nothing, if it is of another kind."""
    if message[:1] == bytes([_TEXT]):
        line = message[1 + 4 + 2 :].decode(errors="replace")
        return line if line.endswith("\n") else line + "\n"
    if message[:1] == bytes([_ERROR]):
        parts, rest = [], message[1 + 4 + 2 + 2 + 4 + 1 :]
        while len(rest) >= 2:
            (length,) = struct.unpack_from(">H", rest)
            parts.append(rest[2 : 2 + length].decode(errors="replace"))
            rest = rest[2 + length :]
        return " ".join(part for part in parts if part) + "\n"
    return ""
