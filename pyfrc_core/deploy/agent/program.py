"""The robot program: which processes it has, starting it again, and watching its start."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

from .console import Console
from .places import CODE, HOME, Places, Refusal
from .virtual import virtual_robot
from .watching import STARTING, StartMonitor
from .wire import Said, Wire

KILL_SCRIPT = "/usr/local/frc/bin/frcKillRobot.sh"
# Without them, scripts do not find NI's programs, nor FRC_ConsoleTee.
_PATHS = ("/etc/profile.d/frc-path.sh", "/etc/profile.d/natinst-path.sh")
_SHELLS = ("/bin/bash", "/bin/sh")  # the script is written for bash, and may have no first line that says so
_PLACES_OF_CODE = (f"{CODE}/".encode(), f"{HOME}/.pyfrc/releases/".encode())
_NATIVE_PROGRAM = f"{HOME}/frcUserProgram".encode()  # written in C++
_TURN = 0.1  # seconds between two looks at the program
_REPORT = 1.0  # seconds between two reports of a watch that goes on
#: Where NetworkTables 4 listens: WPILib opens it when the robot class is constructed, before `robotInit`.
_NETWORK_TABLES = 5810
_NOT_RUN = (126, 127)  # a shell's exit codes
_SWITCH_OFF = "Switch the robot off and on again: it starts the new program then."
_TIME_TO_STOP = 15.0  # seconds
_TIME_TO_END = 2.0  # seconds for the old program, after the script and after each signal


def processes() -> set[int]:
    """The processes of the robot program, which may be another language's."""
    virtual = virtual_robot()
    if virtual is not None:
        return virtual.processes()
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
            name = words[0].rpartition(b"/")[2]
            is_python = name.startswith(b"python") and any(word.startswith(_PLACES_OF_CODE) for word in words)
            is_java = name == b"java" and any(_is_jar(word) for word in words)
            if is_python or is_java or words[0] == _NATIVE_PROGRAM:
                found.add(int(entry.name))
    return found


def _is_jar(word: bytes) -> bool:
    return word.startswith(f"{HOME}/".encode()) and word.endswith(b".jar")


def is_running(process: int) -> bool:
    """Whether a process of the program still runs: much cheaper than looking for all of them."""
    virtual = virtual_robot()
    if virtual is not None:
        return process in virtual.processes()
    try:
        return bool(Path(f"/proc/{process}/cmdline").read_bytes())  # empty: it has ended, and is not yet waited for
    except OSError:
        return False


def state_of(process: int) -> Said:
    """What is seen of a process from outside: its processor time in seconds, and whether NetworkTables listens.

    Nothing where it has ended, and on systems without ``/proc``.
    """
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        state: Said = {"cpu": (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")}
        if virtual_robot() is None:  # of virtual robots, several on one computer, each has another port
            state["network_tables"] = _serves_network_tables(process)
    except (OSError, ValueError, IndexError):
        return {}
    return state


def _serves_network_tables(process: int) -> bool:
    sockets = {
        f"socket:[{row.split()[9]}]"
        for table in ("tcp", "tcp6")
        for row in Path(f"/proc/{process}/net/{table}").read_text().splitlines()[1:]
        if row.split()[1].endswith(f":{_NETWORK_TABLES:04X}") and row.split()[3] == "0A"
    }
    for each in Path(f"/proc/{process}/fd").iterdir() if sockets else ():
        with suppress(FileNotFoundError):  # it was closed meanwhile
            if str(each.readlink()) in sockets:
                return True
    return False


def _reports_start(main: Path) -> bool:
    """Return whether a program reports that `robotInit` is over: `magicbot.MagicRobot` has a loop that does not."""
    try:
        return b"magicbot" not in main.read_bytes()
    except OSError:
        return True


def age_of(found: Iterable[int]) -> float | None:
    """Return for how many seconds the oldest of these processes has run.

    None without one, and on systems without ``/proc``.
    """
    ages = []
    for process in found:
        with suppress(OSError, ValueError, IndexError):
            began = int(Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[19])
            uptime = float(Path("/proc/uptime").read_text().split()[0])
            ages.append(max(0.0, uptime - began / os.sysconf("SC_CLK_TCK")))
    return max(ages, default=None)


def stop(places: Places, *, start: bool, meanwhile: Callable[[], None] = lambda: None) -> bool:
    """Have the robot stop its program, and start it again if wanted; return when no process of before is left.

    The script may fail where nothing ran: whether the program has ended is seen.

    :param meanwhile: called again and again until that is done
    :return: whether the program survived the kill script, and was ended by a signal
    """
    virtual = virtual_robot()
    if virtual is not None:
        if start:
            virtual.restart()
        else:
            virtual.stop()
        return False
    before = processes()
    printed = _run_kill_script(places, ["-t", "-r"] if start else ["-t"], meanwhile)
    survivors = _left_of(before, meanwhile)
    survived = bool(survivors)
    for number in (signal.SIGTERM, signal.SIGKILL):
        for process in survivors:
            with suppress(ProcessLookupError):
                os.kill(process, number)
        survivors = survivors and _left_of(before, meanwhile)
    if survivors:
        raise Refusal(
            "restart",
            f"{KILL_SCRIPT} has not stopped the old program: {printed or 'it printed nothing'}",
            _SWITCH_OFF,
        )
    return survived


def _run_kill_script(places: Places, options: list[str], meanwhile: Callable[[], None]) -> str:
    """Return what it prints."""
    script = places.of(KILL_SCRIPT)
    if not script.exists():
        raise Refusal(
            "restart",
            f"there is no {KILL_SCRIPT} on the robot, so its program cannot be restarted",
            "Switch the robot off and on again; if that does not help, image it.",
        )
    shell = next((each for each in _SHELLS if os.access(each, os.X_OK)), _SHELLS[-1])
    paths = [str(places.of(path)) for path in _PATHS]
    sourcing = '[ ! -r "$1" ] || . "$1"; shift; ' * len(paths)
    give_up = time.monotonic() + _TIME_TO_STOP
    # A file and no pipe: what the script starts in the background keeps its output open, and is not waited for.
    with tempfile.TemporaryFile() as output:
        script_run = subprocess.Popen(
            [shell, "-c", sourcing + 'exec "$@"', shell, *paths, str(script), *options],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
        )
        while script_run.poll() is None and time.monotonic() < give_up:
            meanwhile()
            with suppress(subprocess.TimeoutExpired):
                script_run.wait(_TURN / 2)
        if script_run.poll() is None:
            script_run.kill()
            script_run.wait()
            return "it does not come to its end"
        output.seek(0)
        printed = output.read(4096).decode(errors="replace").strip()
    if script_run.returncode in _NOT_RUN:
        reason = printed.rpartition("\n")[2]  # bash gives it twice
        raise Refusal("restart", f"{KILL_SCRIPT} cannot be run: {reason}", _SWITCH_OFF)
    return printed


def _left_of(before: set[int], meanwhile: Callable[[], None]) -> set[int]:
    """Return those of the processes that are left after a while."""
    give_up = time.monotonic() + _TIME_TO_END
    while (left := before & processes()) and time.monotonic() < give_up:
        meanwhile()
        time.sleep(_TURN / 4)
    return left


class Program:
    """The program from a moment before its restart on."""

    def __init__(self, places: Places) -> None:
        self._places = places
        self._console = Console()
        self._monitor: StartMonitor | None = None
        #: When all processes are looked at next.
        self._all_at = 0.0
        #: What the new program has printed, and was not passed on yet.
        self._output = ""

    def restart(self, main: Path | None = None) -> bool:
        """Start it again, listening to the console from before; return when the old one has ended.

        :param main: the file that is started; none: unknown
        :return: whether it survived the kill script, and was ended by a signal
        """
        self._console.listen()
        self._output = ""
        self._monitor = monitor = StartMonitor(processes(), main is None or _reports_start(main))
        survived = stop(self._places, start=True, meanwhile=lambda: self._look(monitor))
        self._look(monitor)
        monitor.restarted(time.monotonic())
        return survived

    def watch(self, wire: Wire, seconds: float, unheard: float) -> Said:
        """Pass on what the new program prints, and now and then how it does, until there is a verdict.

        :param seconds: after which a program that is still starting is reported as slow
        :param unheard: after which a program with a silent console is judged by its process alone
        """
        monitor, self._monitor = self._monitor or StartMonitor(()), None
        begin = time.monotonic()
        if not monitor.is_restarted:
            monitor.restarted(begin)
        report = begin + _REPORT
        while True:
            left = monitor.trial_left(time.monotonic())
            self._look(monitor, 0.0 if not seconds else _TURN if left is None else min(_TURN, left))
            if self._output:
                wire.say(output=self._output)
                self._output = ""
            now = time.monotonic()
            verdict = monitor.verdict(now, seconds, unheard)
            if verdict is None and wire.pending():
                verdict = STARTING  # the laptop is gone, or wants something else
            if verdict is not None:
                self._console.leave()
                return {"verdict": verdict, **_state(monitor, now)}
            if now >= report:
                wire.say(watching=_state(monitor, now))
                report = now + _REPORT

    def _look(self, monitor: StartMonitor, seconds: float = 0.0) -> None:
        text = self._console.hear(seconds)
        process, now = monitor.process, time.monotonic()
        # Looking at all processes takes a roboRIO some hundredths of a second.
        if process is not None and now < self._all_at and is_running(process):
            found = {process}
        else:
            found, self._all_at = processes(), now + _REPORT
        if monitor.see(now, found, text):
            self._output += text


def _state(monitor: StartMonitor, now: float) -> Said:
    return {
        "seconds": monitor.seconds(now),
        "age": monitor.age(now),
        "lived": monitor.lived,
        "heard": monitor.heard,
        "seen": monitor.seen,
        **({} if monitor.process is None else state_of(monitor.process)),
    }
