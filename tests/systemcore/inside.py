"""The look-alike's first process: its SSH server and its systemd. Run in its namespaces, by machine.py.

It is not run inside its root folder, so that it may use this machine's Python; what it starts is.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import selectors
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time
from collections import deque
from pathlib import Path

ROOT, RESTART_SECONDS = sys.argv[1], float(sys.argv[2])
SSH = socket.socket(fileno=int(sys.argv[3]))
CHROOT = shutil.which("chroot", path="/usr/sbin:/usr/bin:/sbin:/bin") or "chroot"
SYSTEMCORE = ("--userspec=1000:1000", "--groups=")
HOME = "/home/systemcore"
ENABLED = Path(ROOT, "etc/systemd/system/multi-user.target.wants/robot.service")
#: What the program prints; and the same with systemd's messages about it.
OUTPUT, JOURNAL = Path(ROOT, "run/journal/output"), Path(ROOT, "run/journal/unit")
#: So many starts within so many seconds. By default, systemd counts those within 10 s; a busy machine takes its time.
START_LIMIT, START_LIMIT_SECONDS = 5, 600.0
STOP_SECONDS = 2.0  # from SIGTERM to SIGKILL; 90 is the default


def set_up() -> int:
    """Mount what no power cycle survives; return the pipe through which systemctl speaks to us."""
    for name, mode in (("tmp", "1777"), ("run", "755")):
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"mode={mode},size=64m", "tmpfs", f"{ROOT}/{name}"], check=True)
    for name in ("sshd", "journal", "systemctl"):
        Path(ROOT, "run", name).mkdir(0o755)
    for each in (OUTPUT, JOURNAL):
        each.touch(0o644)
    with socket.socket() as any_socket:  # loopback up: ifreq with IFF_UP, by SIOCSIFFLAGS
        fcntl.ioctl(any_socket, 0x8914, struct.pack("16sH14x", b"lo", 1))
    os.mkfifo(f"{ROOT}/run/systemctl/requests", 0o600)
    return os.open(f"{ROOT}/run/systemctl/requests", os.O_RDWR | os.O_NONBLOCK)


class Service:
    """``robot.service``: ``Type=simple``, ``Restart=always``."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[bytes] | None = None
        #: The descriptor of its output that is not watched yet; -1: none.
        self.output = -1
        self.start_at: float | None = None
        self.failed = False
        self._starts: deque[float] = deque()
        self._restarts = 0
        self._unfinished = b""
        #: The reply to the one who waits for its end, and when it is killed.
        self.stopping: tuple[str, float] | None = None

    def start(self) -> str:
        """Start it; return an error, or nothing."""
        self.start_at = None
        if self.process is not None:
            return ""
        now = time.monotonic()
        while self._starts and now - self._starts[0] > START_LIMIT_SECONDS:
            self._starts.popleft()
        if len(self._starts) >= START_LIMIT:
            self.failed = True
            self.log("robot.service: Start request repeated too quickly.")
            return "Job for robot.service failed."
        self._starts.append(now)
        self.failed = False
        self.output, its_end = os.pipe()
        self.log("Started robot.service - robot.")
        self.process = subprocess.Popen(
            [CHROOT, *SYSTEMCORE, ROOT, "/bin/sh", "-c", f"cd {HOME}; exec /bin/bash {HOME}/robotCommand"],
            stdin=subprocess.DEVNULL,
            stdout=its_end,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            env={"HOME": HOME, "USER": "systemcore", "PATH": "/usr/local/bin:/usr/bin:/bin"},
        )
        os.close(its_end)
        return ""

    def stop(self, reply: str) -> None:
        """Begin to stop it; the reply is due at its end."""
        self.start_at = None
        if self.process is None:
            answer(reply)
            return
        self.stopping = reply, time.monotonic() + STOP_SECONDS
        self.signal(signal.SIGTERM)

    def signal(self, number: int) -> None:
        """Send a signal to all of its processes."""
        if self.process is not None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.process.pid, number)

    def ended(self, status: int) -> None:
        """Restart it, unless it was to be stopped."""
        self.signal(signal.SIGKILL)
        self.process = None
        if self.stopping is not None:
            answer(self.stopping[0])
            self.stopping = None
            return
        how = f"killed, status={-status}" if status < 0 else f"exited, status={status}/{'FAILURE' if status else 'OK'}"
        self.log(f"robot.service: Main process exited, code={how}")
        self._restarts += 1
        self.log(f"robot.service: Scheduled restart job, restart counter is at {self._restarts}.")
        self.start_at = time.monotonic() + RESTART_SECONDS

    def forget_failures(self) -> None:
        """Do what ``systemctl reset-failed`` does."""
        self._starts.clear()
        self._restarts, self.failed = 0, False

    def printed(self, piece: bytes) -> None:
        """Write complete lines to the journal."""
        *lines, self._unfinished = (self._unfinished + piece).split(b"\n")
        for file in (OUTPUT, JOURNAL) if lines else ():
            with file.open("ab") as stream:
                stream.write(b"".join(line + b"\n" for line in lines))

    def log(self, text: str) -> None:
        """Write a message of systemd."""
        with JOURNAL.open("a", encoding="utf-8") as stream:
            stream.write(f"{text}\n")


def answer(reply: str, error: str = "") -> None:
    """Let a systemctl end; with an error, it fails."""
    with contextlib.suppress(OSError):
        descriptor = os.open(f"{ROOT}{reply}", os.O_WRONLY | os.O_NONBLOCK)
        os.write(descriptor, f"{error}\n".encode())
        os.close(descriptor)


def handle(service: Service, request: str) -> None:
    """Carry out a request of systemctl: a verb, and the pipe for the reply."""
    verb, _, reply = request.partition(" ")
    if verb == "stop":
        service.stop(reply)
    elif verb == "start":
        answer(reply, service.start())
    elif verb == "reset-failed":
        service.forget_failures()
        answer(reply)
    elif verb == "is-active":
        answer(reply, "" if service.process is not None else "failed" if service.failed else "inactive")


def main() -> None:
    control = set_up()
    service = Service()
    selector = selectors.DefaultSelector()
    selector.register(sys.stdin, selectors.EVENT_READ, "owner")
    selector.register(control, selectors.EVENT_READ, "control")
    selector.register(SSH, selectors.EVENT_READ, "ssh")
    SSH.setblocking(False)
    if ENABLED.is_symlink():
        service.start_at = time.monotonic()
    os.write(1, b"ready\n")
    while True:
        now = time.monotonic()
        if service.start_at is not None and now >= service.start_at:
            service.start()
        if service.stopping is not None and now >= service.stopping[1]:
            service.signal(signal.SIGKILL)
        if service.output != -1:
            selector.register(service.output, selectors.EVENT_READ, "output")
            service.output = -1
        for key, _ in selector.select(0.05):
            if key.data == "owner":
                return  # the parent process has ended
            if key.data == "control":
                for request in os.read(control, 4096).decode().splitlines():
                    handle(service, request)
            elif key.data == "ssh":
                connection, _ = SSH.accept()
                with connection:
                    connection.setblocking(True)
                    server = [CHROOT, ROOT, "/usr/sbin/sshd", "-i", "-E", "/run/sshd.log", "-f", "/etc/ssh/sshd_config"]
                    subprocess.Popen(server, stdin=connection, stdout=connection, stderr=subprocess.DEVNULL)
            elif key.data == "output":
                piece = os.read(key.fd, 8192)
                if piece:
                    os.write(1, piece)
                    service.printed(piece)
                else:
                    selector.unregister(key.fd)
                    os.close(key.fd)
        with contextlib.suppress(ChildProcessError):
            while (state := os.waitpid(-1, os.WNOHANG))[0] != 0:
                if service.process is not None and state[0] == service.process.pid:
                    service.ended(os.waitstatus_to_exitcode(state[1]))


main()
