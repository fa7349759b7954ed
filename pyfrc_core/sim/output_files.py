"""The files that a simulation writes: its recording, WPILib's data log, a picture, a page."""

from __future__ import annotations

from pathlib import Path

from ..disk_space import check_disk_space
from ..errors import UsageError
from ..runtime.scripts.script import trace_beside
from ..text_files import check_writable
from .engine.simulation import Simulation
from .page_file import PageFile


class OutputFiles:
    """The files to write. They are checked before the simulation runs: an hour of driving must not be lost at the end.

    :raises UsageError: when one of them cannot be written
    """

    def __init__(
        self, record: Path | None, wpilog: Path | None, picture: Path | None, page: PageFile | None = None
    ) -> None:
        self._record, self._wpilog, self._picture, self._page = record, wpilog, picture, page
        if picture is not None:
            from .ui.picture import check_pictures

            check_pictures(picture)
        files = (
            ("--record", record),
            ("--wpilog", wpilog),
            ("--picture", picture),
            ("--page", None if page is None else page.file),
        )
        for option, file in files:
            check_writable(option, file)
        self._former_log = _stamp(wpilog)

    def write(self, simulation: Simulation) -> list[Path]:
        """Write the files, if the robot has started at all.

        :returns: every file that was written, including the data log of the robot's process
        :raises UsageError: when the disk was full
        """
        paged = [self._page.file] if self._page is not None and self._page.write(simulation) else []
        snapshot = simulation.snapshot
        if snapshot is None:
            return paged
        scripts = [] if self._record is None else simulation.save_all(self._record)
        traces = [trace for trace in map(trace_beside, scripts) if trace.is_file()]
        written = sorted([*scripts, *traces])
        if self._wpilog is not None and _stamp(self._wpilog) != self._former_log:
            if why := check_disk_space(self._wpilog):
                raise UsageError(f"{self._wpilog} is not complete: {why}", remedy="Make room on the disk.")
            written.append(self._wpilog)
        if self._picture is not None:
            from .ui.picture import draw_picture

            draw_picture(snapshot.scene, self._picture, simulation.status.former_trail)
            written.append(self._picture)
        return written + paged


def _stamp(file: Path | None) -> tuple[int, int] | None:
    """Return what changes when a file is written."""
    if file is None or not file.is_file():
        return None
    status = file.stat()
    return status.st_mtime_ns, status.st_size
