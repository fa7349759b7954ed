"""The changes of one session: those of `hal_data`, and those of NetworkTables."""

from __future__ import annotations

import threading

from ...errors import UsageError
from .changes import ChangeCursor, RunChanges
from .messages import Update
from .recording import Recording


class ChangeStreams:
    """Both streams of changes, which begin their runs together.

    :param recording: the recording of the first run
    :param lock: held while anything is added
    :param network: whether changes of NetworkTables are reported
    """

    def __init__(self, recording: Recording, lock: threading.Condition, network: bool) -> None:
        self._lock = lock
        self._hal = RunChanges(0, recording.lines)
        self._network = RunChanges(0, recording.network_lines) if network else None

    def begin_run(self, number: int, recording: Recording) -> None:
        """Note that another process of the robot was launched."""
        hal = RunChanges(number, recording.lines)
        self._hal.next = hal
        self._hal = hal
        if self._network is not None:
            network = RunChanges(number, recording.network_lines)
            self._network.next = network
            self._network = network

    def begin_anew(self) -> None:
        """Note that the run begins at its start, with other code: its changes have everything."""
        self._hal.begin(0.0, {}, new_code=True)
        if self._network is not None:
            self._network.begin(0.0, {}, new_code=True)

    def begin(self, update: Update) -> None:
        """Note what the run begins with, if this update is its first."""
        if update.base is None:
            return
        now = update.time_us / 1_000_000
        # Where changes came before the base, they begin with a change that holds all values.
        self._hal.begin(*((0.0, {}) if update.lines else (now, update.base)))
        if self._network is not None:
            self._network.begin(*((0.0, {}) if update.network_lines else (now, update.network_base)))

    def cursor(self) -> ChangeCursor:
        """Return a reader of the changes of `hal_data`."""
        return ChangeCursor(self._hal, self._lock)

    def network_cursor(self) -> ChangeCursor:
        """Return a reader of the changes of NetworkTables.

        :raises UsageError: when they are not reported
        """
        if self._network is None:
            raise UsageError("this simulation does not report NetworkTables", remedy="Set SimOptions.network_values.")
        return ChangeCursor(self._network, self._lock)
