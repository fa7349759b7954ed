"""WPILib's names for data logs: `wpilib.DataLogManager`, and log writers of robot code's own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import wpilib
import wpilog
from wpilog import DataLog

from ....patch_table import Patch
from ....wpi.season_2027.logs import RealWriter
from ..active_run import active_run
from ..data_logs import DataLogs, StandsFor, started_at_import

_RealWriter, _RealBackgroundWriter = RealWriter, wpilog.DataLogBackgroundWriter

#: What of `DataLogs` stands for the functions of `wpilib.DataLogManager`.
_OF_THE_MANAGER: dict[str, Callable[..., Any]] = {
    "start": DataLogs.start,
    "stop": DataLogs.stop,
    "log": DataLogs.log,
    "get_log": DataLogs.get_log,
    "get_log_dir": DataLogs.get_log_dir,
    "log_network_tables": DataLogs.log_network_tables,
    "log_console_output": DataLogs.log_console_output,
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

    def writer(filename: str, extra_header: str = "") -> DataLog:
        logs = current()
        return _RealWriter(filename, extra_header) if logs is None else logs.open_file(filename, extra_header)

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
        Patch(wpilog, "DataLogWriter", StandsFor("DataLogWriter", (_RealWriter,), writer)),
        Patch(
            wpilog,
            "DataLogBackgroundWriter",
            StandsFor("DataLogBackgroundWriter", (_RealBackgroundWriter, _RealWriter), background_writer),
        ),
        Patch(_RealWriter, "set_filename", set_filename),
    ]


def _open_like_background_writer(
    logs: DataLogs, dir: str = "", filename: str = "", period: float = 0.25, extra_header: str = ""
) -> DataLog:
    log: DataLog = logs.open(dir, filename, period, extra_header)
    return log
