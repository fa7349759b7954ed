"""The first process of a SystemCore's look-alike: systemd. Run in its namespaces, by `machine`."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import sys
import time
from collections import deque
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))  # run without site-packages

from first_process import FirstProcess

#: So many starts within so many seconds. By default, systemd counts those within 10 s; a busy machine takes its time.
START_LIMIT, START_LIMIT_SECONDS = 5, 600.0
RESTART_SECONDS = 0.2  # from the end of a program to its next start
STOP_SECONDS = 2.0  # from SIGTERM to SIGKILL; 90 is the default


class Systemcore(FirstProcess):
    """``robot.service``: ``Type=simple``, ``Restart=always``."""

    def __init__(self, root: str, ssh: socket.socket) -> None:
        super().__init__(root, ssh, ("systemcore", 1000))
        for name in ("journal", "systemctl"):
            (self.root / "run" / name).mkdir(0o755)
        #: What the program prints; and the same with systemd's messages about it.
        self._output, self._journal = self.root / "run/journal/output", self.root / "run/journal/unit"
        for each in (self._output, self._journal):
            each.touch(0o644)
        self._failed = False
        self._starts: deque[float] = deque()
        self._restarts = 0
        self._unfinished = b""
        #: The reply to the one who waits for the program's end, and when it is killed.
        self._stopping: tuple[str, float] | None = None
        self.pipe("run/systemctl/requests", 0o600, self._handle)
        if (self.root / "etc/systemd/system/multi-user.target.wants/robot.service").is_symlink():
            self.start_at = time.monotonic()

    def begin(self) -> None:
        self._start()

    def _start(self) -> str:
        """Start the program; return an error, or nothing."""
        self.start_at = None
        if self.program is not None:
            return ""
        now = time.monotonic()
        while self._starts and now - self._starts[0] > START_LIMIT_SECONDS:
            self._starts.popleft()
        if len(self._starts) >= START_LIMIT:
            self._failed = True
            self._log("robot.service: Start request repeated too quickly.")
            return "Job for robot.service failed."
        self._starts.append(now)
        self._failed = False
        self._log("Started robot.service - robot.")
        self.start("/bin/sh", "-c", "cd /home/systemcore; exec /bin/bash /home/systemcore/robotCommand")
        return ""

    def turn(self) -> None:
        if self._stopping is not None and time.monotonic() >= self._stopping[1]:
            self.signal(signal.SIGKILL)

    def ended(self, status: int) -> None:
        if self._stopping is not None:
            self._answer(self._stopping[0])
            self._stopping = None
            return
        how = f"killed, status={-status}" if status < 0 else f"exited, status={status}/{'FAILURE' if status else 'OK'}"
        self._log(f"robot.service: Main process exited, code={how}")
        self._restarts += 1
        self._log(f"robot.service: Scheduled restart job, restart counter is at {self._restarts}.")
        self.start_at = time.monotonic() + RESTART_SECONDS

    def printed(self, piece: bytes) -> None:
        """Write complete lines to the journal."""
        *lines, self._unfinished = (self._unfinished + piece).split(b"\n")
        for file in (self._output, self._journal) if lines else ():
            with file.open("ab") as stream:
                stream.write(b"".join(line + b"\n" for line in lines))

    def _log(self, text: str) -> None:
        """Write a message of systemd."""
        with self._journal.open("a", encoding="utf-8") as stream:
            stream.write(f"{text}\n")

    def _handle(self, request: bytes) -> None:
        """Carry out a request of systemctl: a verb, and the pipe for the reply."""
        verb, _, reply = request.decode().partition(" ")
        if verb == "stop" and self.program is not None:
            self.start_at = None
            self._stopping = reply, time.monotonic() + STOP_SECONDS
            self.signal(signal.SIGTERM)
        elif verb == "stop":
            self.start_at = None
            self._answer(reply)
        elif verb == "start":
            self._answer(reply, self._start())
        elif verb == "reset-failed":
            self._starts.clear()
            self._restarts, self._failed = 0, False
            self._answer(reply)
        elif verb == "is-active":
            self._answer(reply, "" if self.program is not None else "failed" if self._failed else "inactive")

    def _answer(self, reply: str, error: str = "") -> None:
        """Let a systemctl end; with an error, it fails."""
        with contextlib.suppress(OSError):
            descriptor = os.open(f"{self.root}{reply}", os.O_WRONLY | os.O_NONBLOCK)
            os.write(descriptor, f"{error}\n".encode())
            os.close(descriptor)


Systemcore(sys.argv[1], socket.socket(fileno=int(sys.argv[2]))).serve()
