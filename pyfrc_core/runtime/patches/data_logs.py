"""Data logs that robot code starts: `wpilib.DataLogManager`, and log writers of its own.

WPILib writes them on a C++ thread, a quarter of a second of wall time later. At our speed that is minutes of robot
time, and the processes that robots run in often end before. Here, each log is a `DataLogWriter`, which is
flushed on the robot's own thread, in robot time, and completed when the run ends. A flush leaves up to 4 KB in C++: a
process that a signal ends loses those.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime, timezone
from functools import cached_property
from itertools import count
from pathlib import Path
from typing import Any

from ...disk_space import check_disk_space
from ...passes.written import note_written
from ...processes.exit import before_sudden_exit
from ...processes.lent_streams import print_error
from ...text_files import keep_out_of_version_control
from ...wording import from_here
from ...wpi import logs, robots
from ..clock import KICKOFF, OBSERVE, PACKET_US, Clock, to_us

#: Where logs are kept, in the robot project; those of tests are in its subdirectory.
LOGS = Path(".pyfrc", "logs")
TEST_LOGS = LOGS / "test"

#: So many of the newest logs are kept in `LOGS`; in `TEST_LOGS`, where each test has its own.
_KEPT, _KEPT_OF_TESTS = 10, 200

#: Names of topics with which WPILib's own manager logs the time of day, every five seconds.
_SYSTEM_TIME = ("systemTime", '{"source":"DataLogManager","format":"time_t_us"}')
_SYSTEM_TIME_US = 5_000_000

#: An event for `sys.audit`: pyfrc creates a file as robot code does, by a name that it has chosen.
ROBOT_FILE = "pyfrc.robot_file"

#: WPILib's driver station and NetworkTables hold on to logs in C++ for as long as the process lives.
_EVERY_LOG: list[logs.DataLog] = []

#: What robots' modules have given to `DataLogManager.start` while they were imported: before there is a run to log.
started_at_import: list[tuple[tuple[Any, ...], dict[str, Any]]] = []


@dataclass(frozen=True)
class LogPlace:
    """Where the logs of one run are written, unless robot code names a directory.

    :param directory: an absolute path
    :param name: of the file, without its suffix; None: the time of day, as on a robot
    :param kept: how many files stay in the directory
    """

    directory: Path
    name: str | None = None
    kept: int = _KEPT

    @classmethod
    def of_run(cls, project: Path) -> LogPlace:
        """Return the place for a run of the simulator, or a replay."""
        return cls(project / LOGS)

    @classmethod
    def of_test(cls, project: Path, name: str) -> LogPlace:
        """Return the place for a test: its log replaces that of the same test's last run."""
        return cls(project / TEST_LOGS, name, _KEPT_OF_TESTS)

    def make_room(self) -> None:
        """Create the directory, out of version control, and delete its oldest logs.

        :raises OSError: when the directory cannot be created
        """
        self.directory.mkdir(parents=True, exist_ok=True)
        for parent in self.directory.parents:
            if parent.name == LOGS.parts[0]:
                keep_out_of_version_control(parent)
                break
        # Other processes, of tests that run at the same time, do the same.
        found = []
        for file in self.directory.glob("*.wpilog"):
            with suppress(OSError):
                found.append((file.stat().st_mtime_ns, file))
        for _, file in sorted(found, reverse=True)[self.kept - 1 :]:
            with suppress(OSError):
                file.unlink()


@dataclass
class _Log:
    """:param renamed: the name that robot code has given it meanwhile"""

    writer: logs.RealWriter
    file: Path
    renamed: str = ""


class DataLogs:
    """The data logs of one run.

    :param place: None: they are not kept
    """

    def __init__(self, clock: Clock, place: LogPlace | None) -> None:
        self._clock = clock
        self._place = place
        self._logs: list[_Log] = []
        #: The directories and inodes of the empty files in place of logs that are not kept.
        self._places_held: list[tuple[Path, int]] = []
        self._directory = ""
        self._manager: logs.DataLog | None = None
        self._network: Callable[[], None] | None = None
        self._next_system_time_us = 0

    def start_as_at_import(self) -> None:
        """Start the manager's log where a robot's module has done that while it was imported."""
        for args, kwargs in started_at_import[:1]:
            self.start(*args, **kwargs)

    # -- what robot code calls, by WPILib's `DataLogManager` ---------------------------------------------------------

    def start(self, dir: str = "", filename: str = "", period: float = 0.25) -> None:
        """Start the manager's log, if it has not been started."""
        if self._manager is not None:
            return
        self._manager = self.open(dir, filename, period)
        self._directory = str(self._logs[-1].file.parent) if self._logs else dir
        self.log_network_tables(True)

    def get_log(self) -> logs.DataLog:
        """Return the manager's log."""
        self.start()
        assert self._manager is not None
        return self._manager

    def get_log_dir(self) -> str:
        """Return the directory of the manager's log."""
        self.start()
        return self._directory

    def log(self, message: str) -> None:
        """Write a message into the manager's log, and print it."""
        self.start()
        self._messages.append(message)
        print(message)

    def log_network_tables(self, enabled: bool) -> None:
        """Log all changes of NetworkTables, or no more."""
        log = self.get_log()
        if enabled and self._network is None:
            self._network = logs.log_network(log)
        elif not enabled and self._network is not None:
            self._stop_network()

    def log_console_output(self, enabled: bool) -> None:
        """Do nothing: WPILib reads the console of a roboRIO only."""

    def stop(self) -> None:
        """Stop the manager's log."""
        for log in self._logs:
            if log.writer is self._manager:
                self._close(log)

    # -- log writers ------------------------------------------------------------------------------------------------

    def open(self, directory: str, filename: str, period: float = 0.25, header: str = "") -> logs.RealWriter:
        """Open a log that is flushed every `period` seconds of robot time.

        :param directory: "": where the run keeps its logs
        :param filename: "": one that follows from the run
        """
        file = self._file(directory, filename)
        return self._keep(self._writer(file, header), file, period)

    def open_file(self, filename: str, header: str = "") -> logs.RealWriter:
        """Open a log in this file.

        :raises RuntimeError: when it cannot be written
        """
        file = Path(filename)
        if self._place is None:
            self._hold_place(file.absolute())
            file = Path(os.devnull)
        return self._keep(logs.RealWriter(str(file), header), file, 0.25)

    def _hold_place(self, file: Path) -> None:
        """Create an empty file for a log that is not kept, because robot code may rename it or look at it."""
        sys.audit(ROBOT_FILE)
        with suppress(OSError), file.open("xb") as made:
            self._places_held.append((file.parent, os.fstat(made.fileno()).st_ino))

    def _keep(self, writer: logs.RealWriter, file: Path, period: float) -> logs.RealWriter:
        _EVERY_LOG.append(writer)
        log = _Log(writer, file)
        self._logs.append(log)
        before_sudden_exit["data logs"] = self.close
        period_us = max(PACKET_US, to_us(period))

        def flush() -> None:
            if writer is self._manager and self._clock.now_us >= self._next_system_time_us:
                self._next_system_time_us += _SYSTEM_TIME_US
                self._system_time.append(KICKOFF * 1_000_000 + self._clock.now_us)
            if log in self._logs:
                writer.flush()

        self._clock.every(period_us, OBSERVE, flush)
        return writer

    def rename(self, writer: logs.DataLog, name: str) -> None:
        """Have a log be in a file of this name, in its directory, when it is complete."""
        for log in self._logs:
            if log.writer is writer:
                log.renamed = name

    def close(self) -> None:
        """Complete all logs. What is logged later is dropped."""
        if self._network is not None:
            self._stop_network()
        for log in self._logs.copy():
            self._close(log)
        for directory, number in self._places_held:
            with suppress(OSError):
                for file in directory.iterdir():  # whatever its name is now
                    if (found := file.stat()).st_ino == number and not found.st_size:
                        file.unlink()
        self._places_held.clear()

    def _close(self, log: _Log) -> None:
        self._logs.remove(log)
        log.writer.flush()
        if log.file == Path(os.devnull):
            return
        if why := check_disk_space(log.file):
            # WPILib would end the process when it closes the file.
            print_error(f"data log: {log.file} is not complete: {why}")
            return
        log.writer.stop()
        note_written(log.file)
        if log.renamed:
            with suppress(OSError):
                note_written(log.file.replace(log.file.with_name(log.renamed)))

    def _stop_network(self) -> None:
        assert self._network is not None
        self._network()
        self._network = None

    def _writer(self, file: Path, header: str) -> logs.RealWriter:
        try:
            writer = logs.RealWriter(str(file), header)
        except RuntimeError as error:
            print_error(f"data log: {from_here(file)} cannot be written: {error}. It is not kept.")
            writer = logs.RealWriter(os.devnull, header)
        else:
            if file != Path(os.devnull):
                print_error(f"data log: {from_here(file)}")
        return writer

    def _file(self, directory: str, filename: str) -> Path:
        place = self._place
        if place is None:
            return Path(os.devnull)
        if directory:
            chosen = Path(robots.operating_directory(), directory)
            with suppress(OSError):
                chosen.mkdir(parents=True, exist_ok=True)
        else:
            chosen = place.directory
            with suppress(OSError):  # reported when the file cannot be opened
                place.make_room()
        name = filename.removesuffix(".wpilog")
        if place.name is not None and not (name and directory):
            name = f"{place.name}.{name}" if name else place.name
        if name:
            return self._free_file(chosen, name, replace=True)
        return self._free_file(chosen, f"FRC_{datetime.now(timezone.utc):%Y%m%d_%H%M%S}", replace=False)

    def _free_file(self, directory: Path, name: str, replace: bool) -> Path:
        """Return a file that no other log of this run has.

        :param replace: whether to delete the log of another run. That run may still write it, into the deleted file.
        """
        taken = {log.file for log in self._logs}
        for number in count(1):
            file = directory / (f"{name}.wpilog" if number == 1 else f"{name}-{number}.wpilog")
            if file in taken or (file.exists() and not replace):
                continue
            with suppress(OSError):
                file.unlink(missing_ok=True)
            if not file.exists():  # else it is open, on Windows
                return file
        raise AssertionError

    @cached_property
    def _messages(self) -> logs.StringLogEntry:
        return logs.StringLogEntry(self.get_log(), "messages")

    @cached_property
    def _system_time(self) -> logs.IntegerLogEntry:
        return logs.IntegerLogEntry(self.get_log(), *_SYSTEM_TIME)


class StandsFor(type):
    """A class whose instances are made otherwise. WPILib's own cannot be subclassed."""

    def __new__(cls, name: str, real: tuple[type, ...], make: Callable[..., object]) -> StandsFor:
        return super().__new__(cls, name, (), {"__doc__": real[0].__doc__, "__module__": real[0].__module__})

    def __init__(cls, name: str, real: tuple[type, ...], make: Callable[..., object]) -> None:
        super().__init__(name, (), {})
        cls._real, cls._make = real, make

    def __call__(cls, *args: object, **kwargs: object) -> Any:
        return cls._make(*args, **kwargs)

    def __instancecheck__(cls, instance: object) -> bool:
        return isinstance(instance, cls._real)

    def __getattr__(cls, name: str) -> Any:
        return getattr(cls._real[0], name)
