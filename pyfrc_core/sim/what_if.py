"""What "What would my code have done?" of `pyfrc view` starts: a simulation that a log drives, in another process."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from ..errors import PyfrcError
from ..project import Project

_ADDRESS = re.compile(r"^The simulator is at (\S+)$")
#: How long the simulation may take to end, in seconds.
_ENDING_SECONDS = 10.0
#: How long `WhatIf.start` waits for the address, in seconds: the page has no other answer until then.
_WAITING_SECONDS = 0.5
#: The last lines of a simulation that did not start that are its reason.
_LINES = 3


class WhatIf:
    """Starts ``pyfrc sim --log`` when a person asks for it, and ends it with `close`.

    :param file: the log
    :param say: prints what the simulation prints
    """

    def __init__(self, project: Project, file: Path, say: Callable[[str], object]) -> None:
        self._project, self._file, self._say = project, file.resolve(), say
        self._process: subprocess.Popen[str] | None = None
        self._address = ""
        self._lines: list[str] = []
        self._known = threading.Event()

    def start(self) -> str:
        """Start the simulation, unless it runs, and return the address of its page; empty while it is not yet served.

        :raises PyfrcError: when the simulation does not start
        """
        if self._process is None or self._process.poll() is not None:
            self._known.clear()
            self._address, self._lines = "", []
            command = [sys.executable, "-m", "pyfrc", "sim", "--ui", "web", "--main", self._project.main_file.name]
            self._process = subprocess.Popen(
                [*command, "--log", str(self._file)],
                cwd=self._project.root,
                env={**os.environ, "BROWSER": "", "PYTHONUNBUFFERED": "1"},  # this page goes there itself
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                encoding="utf-8",
                errors="replace",
            )
            threading.Thread(target=self._read, args=(self._process,), name="pyfrc view: what if", daemon=True).start()
        if not self._known.wait(_WAITING_SECONDS):
            return ""
        if not self._address:
            raise PyfrcError("The simulation did not start: " + " ".join(self._lines[-_LINES:]).strip())
        return self._address

    def _read(self, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        with process.stdout as lines:
            for line in lines:
                with suppress(OSError):  # the terminal has gone
                    self._say(line)
                self._lines = [*self._lines[-_LINES:], line.strip()]
                if not self._address and (found := _ADDRESS.match(line)) is not None:
                    self._address = found[1]
                    self._known.set()
        self._known.set()

    def close(self) -> None:
        """End the simulation."""
        if self._process is None:
            return
        self._process.terminate()
        try:
            self._process.wait(_ENDING_SECONDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
