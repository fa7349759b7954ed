"""The first process of a roboRIO's look-alike: `lvrt`, and the console. Run in its namespaces, by `machine`."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))  # run without site-packages
sys.path.insert(0, str(Path(__file__).parents[2]))

from first_process import FirstProcess

from pyfrc_core.deploy.agent.console import text_frame

# What the robot's own start script does: one line, run as lvuser.
PROGRAM = """
cd /home/lvuser
if [ -e /tmp/frcdebug ]; then file=robotDebugCommand; else file=robotCommand; fi
[ -e $file ] || exec sleep infinity
eval "exec $(head -n 1 $file)"
"""


class Roborio(FirstProcess):
    """Starts a program that has ended again at once, as lvrt does unless its settings say otherwise.

    Its console is heard, as with a Driver Station.
    """

    def __init__(self, root: str, ssh: socket.socket, *consoles: socket.socket) -> None:
        super().__init__(root, ssh, ("lvuser", 500))
        self._pid_file = self.root / "run/natinst/FRC_UserProgram.pid"
        self._pid_file.parent.mkdir(0o755)
        os.chown(self._pid_file.parent, 500, 500)  # scripts that run as lvuser remove the file
        self._clients: list[socket.socket] = []
        self._number, self._unfinished = 0, b""
        for each in (*consoles, *(socket.create_server(("0.0.0.0", port)) for port in (1740, 1741))):
            self.listen(each, partial(self._accept, each))
        self.pipe("run/robot-program", 0o666, self._control)
        self._lvrt = self._start_lvrt()
        self._start_soon()

    def _start_lvrt(self) -> subprocess.Popen[bytes]:
        """Start a process of this name: scripts end it to have it start the program again."""
        nothing = subprocess.DEVNULL
        return self.inside("/usr/local/natinst/bin/lvrt", stdin=subprocess.PIPE, stdout=nothing, stderr=nothing)

    def _start_soon(self) -> None:
        """Start the program, unless the supervisor's settings say otherwise; scripts change them with nirtcfg."""
        settings = self.root / "etc/natinst/share/lvrt.conf"
        lines = settings.read_text(encoding="utf-8").splitlines() if settings.exists() else []
        if "RTTarget.LaunchAppAtBoot=False" not in lines:
            self.start_at = time.monotonic()

    def begin(self) -> None:
        self.start("/bin/bash", "-c", PROGRAM)
        assert self.program is not None
        self._pid_file.write_text(f"{self.program.pid}\n", encoding="utf-8")

    def ended(self, status: int) -> None:
        self._pid_file.unlink(missing_ok=True)
        self._start_soon()

    def other_ended(self, process: int) -> None:
        if process == self._lvrt.pid:
            self._lvrt = self._start_lvrt()
            if self.program is None:
                self._start_soon()

    def _control(self, words: bytes) -> None:
        if b"stop" in words:
            self.stop()
        if b"forget" in words:  # the program runs without supervision
            self.start_at = self.program = None
        if b"start" in words:
            self.start_at = time.monotonic()

    def _accept(self, console: socket.socket) -> None:
        self._clients.append(console.accept()[0])

    def printed(self, piece: bytes) -> None:
        *lines, self._unfinished = (self._unfinished + piece).split(b"\n")
        for line in lines:
            self._number += 1
            for client in list(self._clients):
                try:
                    client.sendall(text_frame(line, self._number))
                except OSError:
                    self._clients.remove(client)


Roborio(sys.argv[1], *(socket.socket(fileno=int(number)) for number in sys.argv[2:])).serve()
