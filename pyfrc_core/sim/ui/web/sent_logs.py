"""Logs that a person has dropped on a page: they become branches of what it shows."""

from __future__ import annotations

import asyncio
import tempfile
from contextlib import suppress
from dataclasses import replace
from itertools import count
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from starlette.requests import ClientDisconnect, Request

from ....errors import PyfrcError
from ....shell import quoted
from ....temporary import temporary_directory
from ...logs import OpenedLog, open_log
from ...logs.align import offset_of
from ...logs.source import LogSource
from ...logs.station import align

if TYPE_CHECKING:
    from ...engine.source import Source
    from .collector import Collector

#: The largest log that a page may send, and all of them together, in bytes.
_MOST, _MOST_TOGETHER = 1 << 30, 2 << 30
_LONGEST_NAME = 200


class SentLogs:
    """The logs that pages have sent, in files of their own as long as the page is served.

    :param source: what they are shown beside
    """

    def __init__(self, source: Source, collector: Collector) -> None:
        self._collector = collector
        self._log = source.log if isinstance(source, LogSource) else None
        self._directory: tempfile.TemporaryDirectory[str] | None = None
        self._count = self._size = 0

    def close(self) -> None:
        """Remove the files."""
        if self._directory is not None:
            with suppress(OSError):  # on Windows, one that is open
                self._directory.cleanup()

    async def take(self, request: Request) -> dict[str, Any]:
        """Read the log that a request has, and return what the page gets: the branch, and a text for the person."""
        name = Path(request.query_params.get("name", "").replace("\\", "/")).name[:_LONGEST_NAME] or "log"
        if self._directory is None:
            self._directory = temporary_directory("logs")
        self._count += 1
        file = Path(self._directory.name) / f"{self._count}"
        try:
            await self._save(request, file)
            return await asyncio.to_thread(self._open, file, name)
        except (PyfrcError, OSError, ClientDisconnect) as wrong:
            file.unlink(missing_ok=True)
            return {"text": " ".join(str(wrong).split()) or f"{name} did not arrive whole."}

    async def _save(self, request: Request, file: Path) -> None:
        size = 0
        with file.open("wb") as saved:
            async for piece in request.stream():
                size += len(piece)
                if size > _MOST or self._size + size > _MOST_TOGETHER:
                    raise PyfrcError("This log is too large to be dropped on the page.", remedy="pyfrc view opens it.")
                await asyncio.to_thread(saved.write, piece)
        self._size += size

    def _open(self, file: Path, name: str) -> dict[str, Any]:
        collector = self._collector
        name = _untaken(name, {branch.name for branch in collector.runs.branches})
        opened = open_log(file, collector.state.field.height, name)
        offset, how = self._alignment(opened)
        branch = collector.runs.add_branch(replace(opened.run, offset=offset or 0.0))
        problem = f" But {opened.problem}." if opened.problem else ""
        if opened.is_station and offset is not None:
            problem += f" For plots of both together, name both when you start: pyfrc view LOG {quoted(name)}"
        collector.announce(f"{name} is a branch, aligned {how}.")
        return {"branch": branch, "text": f"{name} is shown beside this, aligned {how}.{problem}"}

    def _alignment(self, opened: OpenedLog) -> tuple[float | None, str]:
        """Return what is added to a log's times, and where that puts it; as `pyfrc view` does, where it knows."""
        log = self._log
        if log is not None and log.is_station != opened.is_station:
            robot, station = (log, opened) if opened.is_station else (opened, log)
            offset, how = align(robot, station)
            if offset is None:
                return None, f"at their start: {how}"
            return offset if opened.is_station else -offset, f"so that both show the same moment: {how}"
        offset = offset_of(opened.run.histories["network"], self._collector.runs.network, "enabled")
        how = "where the robots were first enabled" if offset is not None else "at their start, since one says no mode"
        return offset, how


def _untaken(name: str, taken: set[str]) -> str:
    """Return a name, with a number if there is another log of that name: a browser does not tell the path."""
    path = PurePath(name)
    numbered = (f"{path.stem} ({number}){path.suffix}" for number in count(2))
    return name if name not in taken else next(each for each in numbered if each not in taken)
