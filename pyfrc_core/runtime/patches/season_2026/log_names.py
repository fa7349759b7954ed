"""WPILib's names for data logs: `wpilib.DataLogManager`, and log writers of robot code's own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import wpilib
import wpiutil
from wpiutil.log import DataLog

from ....patch_table import Patch
from ....wpi.season_2026.logs import RealWriter
from ..active_run import active_run
from ..data_logs import DataLogs, StandsFor, started_at_import

_RealWriter, _RealBackgroundWriter = RealWriter, wpiutil.DataLogBackgroundWriter

#: What of `DataLogs` stands for the functions of `wpilib.DataLogManager`.
_OF_THE_MANAGER: dict[str, Callable[..., Any]] = {
    "start": DataLogs.start,
    "stop": DataLogs.stop,
    "log": DataLogs.log,
    "getLog": DataLogs.get_log,
    "getLogDir": DataLogs.get_log_dir,
    "logNetworkTables": DataLogs.log_network_tables,
    "logConsoleOutput": DataLogs.log_console_output,
}


def patches() -> list[Patch]:
    """Return the names of WPILib's to replace."""

    def current() -> DataLogs | None:
        return None if active_run.run is None else active_run.run.data_logs

    def manager_call(name: str, ours: Callable[..., Any]) -> Patch:
        real = getattr(wpilib.DataLogManager, name)

        def call(*args: object, **kwargs: object) -> Any:
            logs = current()
            if logs is None and name == "start":
                started_at_import.append((args, kwargs))
                return None
            return real(*args, **kwargs) if logs is None else ours(logs, *args, **kwargs)

        return Patch(wpilib.DataLogManager, name, staticmethod(call))

    def writer(filename: str, extraHeader: str = "") -> DataLog:
        logs = current()
        return _RealWriter(filename, extraHeader) if logs is None else logs.open_file(filename, extraHeader)

    def background_writer(*args: Any, **kwargs: Any) -> DataLog:
        logs = current()
        if logs is None or "write" in kwargs or (args and callable(args[0])):
            return _RealBackgroundWriter(*args, **kwargs)
        return _open_like_background_writer(logs, *args, **kwargs)

    def set_filename(writer: DataLog, filename: str) -> None:
        logs = current()
        if logs is not None:
            logs.rename(writer, filename)

    return [
        *(manager_call(name, ours) for name, ours in _OF_THE_MANAGER.items()),
        Patch(wpiutil, "DataLogWriter", StandsFor("DataLogWriter", (_RealWriter,), writer)),
        Patch(
            wpiutil,
            "DataLogBackgroundWriter",
            StandsFor("DataLogBackgroundWriter", (_RealBackgroundWriter, _RealWriter), background_writer),
        ),
        Patch(_RealWriter, "setFilename", set_filename),
    ]


def _open_like_background_writer(
    logs: DataLogs, dir: str = "", filename: str = "", period: float = 0.25, extraHeader: str = ""
) -> DataLog:
    return logs.open(dir, filename, period, extraHeader)
