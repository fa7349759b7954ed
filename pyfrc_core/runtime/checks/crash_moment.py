"""The moment of a crash: robot time and mode, kept where they survive the end of the process."""

from __future__ import annotations

from ...processes.crash_report import CrashLog
from ...wpi import station
from ..robot import RobotRun


class CrashMoment:
    """Keeps the robot time and the mode of a run up to date in the crash log of its process.

    :param run: a run that is open
    """

    def __init__(self, log: CrashLog, run: RobotRun) -> None:
        if log.time_us is None:
            return
        self._log, self._run = log, run
        self._note_mode()
        log.time_us[0] = run.clock.now_us
        run.clock.moment = log.time_us
        self._listening: object = station.when_mode_changes(self._note_mode)
        run.at_close(self._stop)
        run.connection.when_connected.append(self._note_mode)

    def _stop(self) -> None:
        self._listening = None  # or the HAL would hold on to the run

    def _note_mode(self, name: str = "", value: object = None) -> None:
        # Before its first packet, a robot is disabled whatever mode is asked for.
        self._log.set_mode(station.mode_name() if self._run.connection.connected else "disabled")
