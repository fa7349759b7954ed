"""The first process of a look-alike: its SSH server, and the robot program. `inside.py` of a controller adds the rest.

It runs in the look-alike's namespaces, but not inside its root folder, so that it may use this machine's Python; what
it starts is inside.
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
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

_CHROOT = shutil.which("chroot", path="/usr/sbin:/usr/bin:/sbin:/bin") or "chroot"
_SSHD = ("/usr/sbin/sshd", "-i", "-E", "/run/sshd.log", "-f", "/etc/ssh/sshd_config")
_TURN_SECONDS = 0.05


class FirstProcess:
    """What all controllers have. Ends with the parent process.

    :param root: the root folder
    :param ssh:  a socket that listens
    :param user: who runs the program, and the user's number
    """

    def __init__(self, root: str, ssh: socket.socket, user: tuple[str, int]) -> None:
        self.root = Path(root)
        self.program: subprocess.Popen[bytes] | None = None
        #: When the program is started next.
        self.start_at: float | None = None
        self._user, number = user
        self._chroot = (_CHROOT, f"--userspec={number}:{number}", "--groups=", root)
        self._selector = selectors.DefaultSelector()
        self._set_up()
        self.listen(ssh, partial(self._serve, ssh))

    def _set_up(self) -> None:
        """Mount what no power cycle survives."""
        for name, mode in (("tmp", "1777"), ("run", "755")):
            size = f"mode={mode},size=64m"
            subprocess.run(["mount", "-t", "tmpfs", "-o", size, "tmpfs", self.root / name], check=True)
        (self.root / "run/sshd").mkdir(0o755)
        with socket.socket() as any_socket:  # loopback up: ifreq with IFF_UP, by SIOCSIFFLAGS
            fcntl.ioctl(any_socket, 0x8914, struct.pack("16sH14x", b"lo", 1))

    def listen(self, source: socket.socket | int, act: Callable[[], object]) -> None:
        """Call a function whenever something has arrived."""
        if isinstance(source, socket.socket):
            source.setblocking(False)
        self._selector.register(source, selectors.EVENT_READ, act)

    def pipe(self, name: str, mode: int, act: Callable[[bytes], object]) -> None:
        """Make a pipe in the root folder, through which its programs speak to this process.

        :param act: called with each line
        """
        pipe = self.root / name
        os.mkfifo(pipe)
        pipe.chmod(mode)
        descriptor = os.open(pipe, os.O_RDWR | os.O_NONBLOCK)
        self.listen(descriptor, lambda: [act(line) for line in os.read(descriptor, 4096).splitlines() if line])

    def inside(self, *command: str, **how: Any) -> subprocess.Popen[bytes]:
        """Start a command inside, as the program's user."""
        return subprocess.Popen([*self._chroot, *command], **how)

    def start(self, *command: str) -> None:
        """Start the robot program. What it prints goes to the parent process, too."""
        self.start_at = None
        output, its_end = os.pipe()
        self.program = self.inside(
            *command,
            stdin=subprocess.DEVNULL,
            stdout=its_end,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            env={"HOME": f"/home/{self._user}", "USER": self._user, "PATH": "/usr/local/bin:/usr/bin:/bin"},
        )
        os.close(its_end)
        self.listen(output, partial(self._read, output))

    def signal(self, number: int) -> None:
        """Send a signal to all processes of the program, if it runs."""
        if self.program is not None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.program.pid, number)

    def stop(self) -> None:
        """Kill the program, if it runs."""
        self.start_at = None
        self.signal(signal.SIGKILL)
        self.program = None

    def serve(self) -> None:
        """Go on until the parent process has ended."""
        over: list[bool] = []
        self._selector.register(sys.stdin, selectors.EVENT_READ, lambda: over.append(True))
        os.write(1, b"ready\n")
        while not over:
            if self.start_at is not None and time.monotonic() >= self.start_at:
                self.begin()
            self.turn()
            for key, _ in self._selector.select(_TURN_SECONDS):
                key.data()
            with contextlib.suppress(ChildProcessError):
                while (state := os.waitpid(-1, os.WNOHANG))[0] != 0:
                    if self.program is not None and state[0] == self.program.pid:
                        self.signal(signal.SIGKILL)
                        self.program = None
                        self.ended(os.waitstatus_to_exitcode(state[1]))
                    else:
                        self.other_ended(state[0])

    def _read(self, output: int) -> None:
        piece = os.read(output, 8192)
        if piece:
            os.write(1, piece)
            self.printed(piece)
        else:
            self._selector.unregister(output)
            os.close(output)

    def _serve(self, ssh: socket.socket) -> None:
        connection, _ = ssh.accept()
        with connection:
            connection.setblocking(True)
            command = [_CHROOT, str(self.root), *_SSHD]
            subprocess.Popen(command, stdin=connection, stdout=connection, stderr=subprocess.DEVNULL)

    # -- what differs -------------------------------------------------------------------------------------------------

    def begin(self) -> None:
        """Start the program that is on the disk."""
        raise NotImplementedError

    def ended(self, status: int) -> None:
        """Do what the supervisor does when the program has ended by itself."""
        raise NotImplementedError

    def printed(self, piece: bytes) -> None:
        """Pass on what the program has printed."""
        raise NotImplementedError

    def other_ended(self, process: int) -> None:
        """Do what is due when another process has ended."""

    def turn(self) -> None:
        """Do what is due, a few times each second."""
