"""A virtual display of a test's own, and a user at it: real X events, sent by `xdotool`."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from skips import missing_programs, missing_tkinter, require

#: What the tests of the window are about.
WINDOW = "the simulator's window"


def require_window() -> None:
    """Skip the test, or at the top of a module all of its tests, where no window can be tested."""
    if sys.platform != "linux":
        require(WINDOW, ["Linux"])  # elsewhere, Tk draws on no X server
    require(WINDOW, [*missing_programs("Xvfb", "xdotool"), *missing_tkinter()])


class VirtualDisplay:
    """A screen that nobody sees.

    :param name: such as ``:7``
    :param server: the process that shows it
    """

    def __init__(self, name: str, server: subprocess.Popen[bytes]) -> None:
        self.name = name
        self._server = server
        self.variable = {"DISPLAY": name}

    def end(self) -> None:
        """Let the display vanish, as when a session ends or a container's window is closed."""
        self._server.kill()
        self._server.wait()

    def do(self, *words: str | int) -> str:
        """One command of `xdotool`, or several; answers what it prints."""
        environment = {**os.environ, **self.variable}
        done = subprocess.run(
            ["xdotool", *map(str, words)], env=environment, capture_output=True, text=True, check=True, timeout=240
        )
        return done.stdout.strip()


@contextmanager
def virtual_display(width: int = 1366, height: int = 768, dpi: int = 96) -> Iterator[VirtualDisplay]:
    """A display of its own number, which the server chooses: others may be made at the same time.

    Where there can be none, the test that asks for it is skipped.
    """
    require_window()
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24", "-dpi", str(dpi)]
    server = subprocess.Popen(
        [*command, "-nolisten", "tcp"], pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    os.close(write)
    try:
        with os.fdopen(read) as numbers:
            number = numbers.readline().strip()  # it is ready when it tells
        assert number, "Xvfb has not started"
        yield VirtualDisplay(f":{number}", server)
    finally:
        server.terminate()
        server.wait()
