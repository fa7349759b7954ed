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

sys.path.insert(0, str(Path(__file__).parents[2]))  # run without site-packages

from pyfrc_core.deploy.agent.console import text_frame

ROOT = sys.argv[1]
HAS_DRIVER_STATION = sys.argv[2] == "driver-station"  # connected all the time
SSH, DRIVER_STATION, *CONSOLES = (socket.socket(fileno=int(number)) for number in sys.argv[3:])
CHROOT = shutil.which("chroot", path="/usr/sbin:/usr/bin:/sbin:/bin") or "chroot"
LVUSER = ("--userspec=500:500", "--groups=")
# What the robot's own start script does: one line, run as lvuser.
PID_FILE = Path(ROOT, "run/natinst/FRC_UserProgram.pid")
SUPERVISOR_SETTINGS = Path(ROOT, "etc/natinst/share/lvrt.conf")
DRIVER_STATION_LOST = 10.0  # seconds without a packet of its: more than a busy machine keeps a sender waiting
PROGRAM = """
cd /home/lvuser
if [ -e /tmp/frcdebug ]; then file=robotDebugCommand; else file=robotCommand; fi
[ -e $file ] || exec sleep infinity
eval "exec $(head -n 1 $file)"
"""


def set_up() -> int:
    """Mount what no power cycle survives; the pipe through which frcKillRobot.sh speaks to us."""
    for name, mode in (("tmp", "1777"), ("run", "755")):
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"mode={mode},size=64m", "tmpfs", f"{ROOT}/{name}"], check=True)
    Path(ROOT, "run/sshd").mkdir(0o755)
    PID_FILE.parent.mkdir(0o755)
    os.chown(PID_FILE.parent, 500, 500)  # scripts that run as lvuser remove the file
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
        self.start_at: float | None = time.monotonic() if starts_programs() else None

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
        PID_FILE.write_text(f"{self.process.pid}\n", encoding="utf-8")

    def ended(self) -> None:
        """Start it again at once, as lvrt does unless its settings say otherwise."""
        self.process = None
        PID_FILE.unlink(missing_ok=True)
        if starts_programs():
            self.start_at = time.monotonic()

    def forget(self) -> None:
        """Let the program run without supervision."""
        self.start_at = None
        self.process = None

    def stop(self) -> None:
        """Stop it, if it runs."""
        self.start_at = None
        if self.process is not None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)
            self.process = None


def starts_programs() -> bool:
    """Whether the supervisor's settings have it start programs; scripts change them with nirtcfg."""
    try:
        return "RTTarget.LaunchAppAtBoot=False" not in SUPERVISOR_SETTINGS.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return True


def supervisor() -> subprocess.Popen[bytes]:
    """A process called lvrt: scripts end it to have it start the program again."""
    command = [CHROOT, *LVUSER, ROOT, "/usr/local/natinst/bin/lvrt"]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def main() -> None:
    control = set_up()
    CONSOLES.extend(socket.create_server(("0.0.0.0", port)) for port in (1740, 1741))
    for each in (DRIVER_STATION, SSH, *CONSOLES):
        each.setblocking(False)
    selector = selectors.DefaultSelector()
    selector.register(sys.stdin, selectors.EVENT_READ, "owner")
    selector.register(control, selectors.EVENT_READ, "control")
    selector.register(DRIVER_STATION, selectors.EVENT_READ, "driver station")
    selector.register(SSH, selectors.EVENT_READ, "ssh")
    for each in CONSOLES:
        selector.register(each, selectors.EVENT_READ, "console")
    listeners: list[socket.socket] = []
    program, lvrt = Program(), supervisor()
    number, unfinished, packet_at = 0, b"", float("-inf")
    os.write(1, b"ready\n")
    while True:
        if program.start_at is not None and time.monotonic() >= program.start_at:
            program.start()
            selector.register(program.output, selectors.EVENT_READ, "output")
        for key, _ in selector.select(0.1):
            if key.data == "owner":
                return  # the parent process has ended
            if key.data == "control":
                for words in os.read(control, 4096).split(b"\n"):
                    if b"stop" in words:
                        program.stop()
                    if b"forget" in words:
                        program.forget()
                    if b"start" in words:
                        program.start_at = time.monotonic()
            elif key.data == "driver station":
                DRIVER_STATION.recv(1024)
                packet_at = time.monotonic()
            elif key.data == "ssh":
                connection, _ = SSH.accept()
                with connection:
                    connection.setblocking(True)
                    server = [CHROOT, ROOT, "/usr/sbin/sshd", "-i", "-E", "/run/sshd.log", "-f", "/etc/ssh/sshd_config"]
                    subprocess.Popen(server, stdin=connection, stdout=connection, stderr=subprocess.DEVNULL)
            elif key.data == "console":
                listeners.append(key.fileobj.accept()[0])
            elif key.data == "output":
                piece = os.read(key.fd, 8192)
                if not piece:
                    selector.unregister(key.fd)
                    os.close(key.fd)
                    if program.process is not None and program.output == key.fd:
                        program.ended()
                    continue
                os.write(1, piece)
                *lines, unfinished = (unfinished + piece).split(b"\n")
                if not HAS_DRIVER_STATION and time.monotonic() - packet_at > DRIVER_STATION_LOST:
                    continue
                for line in lines:
                    number += 1
                    for listener in list(listeners):
                        try:
                            listener.sendall(text_frame(line, number))
                        except OSError:
                            listeners.remove(listener)
        with contextlib.suppress(ChildProcessError):
            while (ended := os.waitpid(-1, os.WNOHANG)[0]) != 0:
                if ended == lvrt.pid:
                    lvrt = supervisor()
                    if program.process is None and starts_programs():
                        program.start_at = time.monotonic()


main()
