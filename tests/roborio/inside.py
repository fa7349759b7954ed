"""The look-alike's first process: its SSH server, its robot program, its console. Run in its namespaces, by machine.py.

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
from pathlib import Path

ROOT = sys.argv[1]
SSH, *CONSOLES = (socket.socket(fileno=int(number)) for number in sys.argv[2:])
CHROOT = shutil.which("chroot", path="/usr/sbin:/usr/bin:/sbin:/bin") or "chroot"
LVUSER = ("--userspec=500:500", "--groups=")
# What the robot's own start script does: one line, run as lvuser.
PROGRAM = """
cd /home/lvuser
if [ -e /tmp/frcdebug ]; then file=robotDebugCommand; else file=robotCommand; fi
[ -e $file ] || exec sleep infinity
eval "exec $(head -n 1 $file)"
"""
PAUSE_BEFORE_RESTART = 1.0  # seconds, after a program that ended by itself


def set_up() -> int:
    """Mount what no power cycle survives; the pipe through which frcKillRobot.sh speaks to us."""
    for name, mode in (("tmp", "1777"), ("run", "755")):
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"mode={mode},size=64m", "tmpfs", f"{ROOT}/{name}"], check=True)
    Path(ROOT, "run/sshd").mkdir(0o755)
    with socket.socket() as any_socket:  # loopback up: ifreq with IFF_UP, by SIOCSIFFLAGS
        fcntl.ioctl(any_socket, 0x8914, struct.pack("16sH14x", b"lo", 1))
    os.mkfifo(f"{ROOT}/run/robot-program")
    Path(ROOT, "run/robot-program").chmod(0o666)
    return os.open(f"{ROOT}/run/robot-program", os.O_RDWR | os.O_NONBLOCK)


class Program:
    """The robot program: wanted or not, running or not."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[bytes] | None = None
        self.output = -1
        self.start_at: float | None = time.monotonic()

    def start(self) -> None:
        """Start it, if there is a start command; `output` is then its output's descriptor."""
        self.start_at = None
        self.output, its_end = os.pipe()
        self.process = subprocess.Popen(
            [CHROOT, *LVUSER, ROOT, "/bin/bash", "-c", PROGRAM],
            stdin=subprocess.DEVNULL,
            stdout=its_end,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            env={"HOME": "/home/lvuser", "USER": "lvuser", "PATH": "/usr/local/bin:/usr/bin:/bin"},
        )
        os.close(its_end)

    def stop(self) -> None:
        """Stop it, if it runs."""
        self.start_at = None
        if self.process is not None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)
            self.process = None


def framed(line: bytes, number: int) -> bytes:
    """A line of output as netconsole frames it."""
    body = struct.pack(">BfH", 12, time.monotonic() % 1e6, number % 65536) + line
    return struct.pack(">H", len(body)) + body


def main() -> None:
    control = set_up()
    CONSOLES.extend(socket.create_server(("0.0.0.0", port)) for port in (1740, 1741))
    for each in (SSH, *CONSOLES):
        each.setblocking(False)
    selector = selectors.DefaultSelector()
    selector.register(sys.stdin, selectors.EVENT_READ, "owner")
    selector.register(control, selectors.EVENT_READ, "control")
    selector.register(SSH, selectors.EVENT_READ, "ssh")
    for each in CONSOLES:
        selector.register(each, selectors.EVENT_READ, "console")
    listeners: list[socket.socket] = []
    program = Program()
    number, unfinished = 0, b""
    os.write(1, b"ready\n")
    while True:
        if program.start_at is not None and time.monotonic() >= program.start_at:
            program.start()
            selector.register(program.output, selectors.EVENT_READ, "output")
        for key, _ in selector.select(0.1):
            if key.data == "owner":
                return  # whoever started us is gone
            if key.data == "control":
                for words in os.read(control, 4096).split(b"\n"):
                    if b"stop" in words:
                        program.stop()
                    if b"start" in words:
                        program.stop()
                        program.start_at = time.monotonic()
            elif key.data == "ssh":
                connection, _ = SSH.accept()
                with connection:
                    connection.setblocking(True)
                    server = [CHROOT, ROOT, "/usr/sbin/sshd", "-i", "-E", "/var/sshd.log", "-f", "/etc/ssh/sshd_config"]
                    subprocess.Popen(server, stdin=connection, stdout=connection, stderr=subprocess.DEVNULL)
            elif key.data == "console":
                listeners.append(key.fileobj.accept()[0])
            elif key.data == "output":
                piece = os.read(key.fd, 8192)
                if not piece:
                    selector.unregister(key.fd)
                    os.close(key.fd)
                    if program.process is not None and program.output == key.fd:
                        program.process = None
                        program.start_at = time.monotonic() + PAUSE_BEFORE_RESTART
                    continue
                os.write(1, piece)
                *lines, unfinished = (unfinished + piece).split(b"\n")
                for line in lines:
                    number += 1
                    for listener in list(listeners):
                        try:
                            listener.sendall(framed(line, number))
                        except OSError:
                            listeners.remove(listener)
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass


main()
