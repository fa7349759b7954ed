"""Watching the start of the robot program."""

from __future__ import annotations

import re
import time
from contextlib import suppress
from functools import cache, partial
from pathlib import Path

from .disk import files_below
from .host import Host, cpu_seconds
from .start_monitor import STARTING, StartMonitor
from .wire import Message, Wire

_POLL_SECONDS = 0.1
_REPORT_SECONDS = 1.0  # between two reports of a watch
#: Characters of output in one message: the laptop limits a message's size, and the commas and brackets in it.
_PIECE = 50_000
#: Characters of output that are kept until the watch begins.
_KEPT_OUTPUT = 1 << 16
_LEFT_OUT = "[pyfrc has left out earlier output]\n"
#: A robot class that inherits WPILib's loop, which reports the end of `robotInit`.
_WPILIBS_LOOP = re.compile(
    rb"^[ \t]*class[ \t]+\w+[ \t]*\([^)#]*\b(?:Timed|TimedCommand|Timeslice|OpMode)Robot\b", re.MULTILINE
)
#: A main loop of the program's own, which does not.
_OWN_LOOP = re.compile(
    rb"^[ \t]*(?:def[ \t]+start(?:C|_c)ompetition\b|[^#\n]*\bobserve(?:UserProgramS|_user_program_s)tarting\b"
    rb"|(?:from|import)\b[^#\n]*\bmagicbot\b)",
    re.MULTILINE,
)


class Program:
    """The robot program, from just before its restart to the end of the watch.

    :param host: the robot that runs it
    """

    def __init__(self, host: Host) -> None:
        self._host = host
        self._console = host.console()
        self._monitor: StartMonitor | None = None
        #: When all processes are listed next.
        self._next_listing = 0.0
        #: Output of the new program that was not sent yet.
        self._output = ""
        #: The program's process at the end of the watch, if it was seen.
        self.process: int | None = None

    def restart(self, main: Path | None = None) -> bool:
        """Restart the program; return when the old one has ended. The console is connected before.

        :param main: the program's main file, if known
        :return: whether the old program survived the stop command and was ended by a signal
        """
        with suppress(OSError):  # without a console, its process decides
            self._console.connect()
        self._output = ""
        reports = cache(partial(_reports_start, main))
        self._monitor = monitor = StartMonitor(self._host.processes(), reports)
        survived = self._host.stop(start=True, meanwhile=lambda: self._poll(monitor))
        self._poll(monitor)
        monitor.restarted(time.monotonic())
        return survived

    def close(self) -> None:
        """Read no more of its output: a watch may have ended by an error, or may never have begun."""
        self._console.disconnect()

    def watch(self, wire: Wire, seconds: float, unheard: float) -> Message:
        """Send the program's output and state to the laptop until there is a verdict.

        :param seconds: time limit, after which a program that is still starting is reported as slow
        :param unheard: time after which a program with a silent console is judged by its process alone
        """
        monitor, self._monitor = self._monitor or StartMonitor(()), None
        begin = time.monotonic()
        if not monitor.is_restarted:
            monitor.restarted(begin)
        report = begin + _REPORT_SECONDS
        while True:
            left = monitor.trial_left(time.monotonic())
            self._poll(monitor, 0.0 if not seconds else _POLL_SECONDS if left is None else min(_POLL_SECONDS, left))
            for start in range(0, len(self._output), _PIECE):
                wire.send(output=self._output[start : start + _PIECE])
            self._output = ""
            now = time.monotonic()
            verdict = monitor.verdict(now, seconds, unheard)
            if verdict is None and wire.has_input():
                verdict = STARTING  # the laptop has disconnected, or sent another request
            if verdict is not None:
                self._console.disconnect()
                self.process = monitor.process
                return {"verdict": verdict, **self._state(monitor, now)}
            if now >= report:
                wire.send(watching=self._state(monitor, now))
                report = now + _REPORT_SECONDS

    def _poll(self, monitor: StartMonitor, seconds: float = 0.0) -> None:
        text = self._console.receive(seconds)
        process, now = monitor.process, time.monotonic()
        # Listing all processes takes a slow robot some hundredths of a second.
        if process is not None and now < self._next_listing and self._host.is_running(process):
            found = {process}
        else:
            found, self._next_listing = self._host.processes(), now + _REPORT_SECONDS
        if monitor.observe(now, found, text):
            self._output += text
            if not monitor.is_restarted and len(self._output) > _KEPT_OUTPUT:
                self._output = _LEFT_OUT + self._output[-_KEPT_OUTPUT:].partition("\n")[2]

    def _state(self, monitor: StartMonitor, now: float) -> Message:
        return {
            "seconds": monitor.seconds(now),
            "age": monitor.age(now),
            "lived": monitor.lived,
            "heard": monitor.has_output,
            "seen": monitor.seen,
            **({} if monitor.process is None else process_state(self._host, monitor.process)),
        }


def process_state(host: Host, process: int) -> Message:
    """Return what is known of a running process: its processor time in seconds, and whether it serves NetworkTables.

    The result is empty if the process has ended, and on systems without ``/proc``.
    """
    try:
        return {"cpu": cpu_seconds(process), "network_tables": host.serves_network_tables(process)}
    except (OSError, ValueError, IndexError):
        return {}


def _reports_start(main: Path | None) -> bool:
    """Return whether a program reports the end of `robotInit`: whether WPILib's loop runs it.

    The loop of `magicbot.MagicRobot` does not report it, nor does one of the program's own or of another library.
    The base class of the robot may be in any module of the program.

    :param main: the program's main file, if known
    """
    if main is None:
        return True
    found = False
    for name, entry in files_below(main.parent):
        if name.endswith(".py") and not name.startswith("tests/"):
            with suppress(OSError), open(entry.path, "rb") as source:  # noqa: PTH123
                text = source.read()
                if _OWN_LOOP.search(text):
                    return False
                found = found or _WPILIBS_LOOP.search(text) is not None
    return found
