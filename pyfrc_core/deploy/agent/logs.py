"""The logs that robot programs write: which there are, their contents, and their removal."""

from __future__ import annotations

import hashlib
import time
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

from .activity import Activity
from .disk import BLOCK, files_below
from .robot_paths import Refusal, RobotPaths
from .wire import Message

_SUFFIXES = (".wpilog", ".wpilogxz", ".rlog", ".hoot", ".revlog")
#: The most logs that are named: the newest ones.
_MOST = 2000
#: Seconds without a change after which a log counts as complete. WPILib writes the time of day every five seconds.
_COMPLETE_SECONDS = 30.0


class RobotLogs:
    """The logs in the layout's directories."""

    def __init__(self, paths: RobotPaths, activity: Activity) -> None:
        self._paths = paths
        self._activity = activity

    def named(self) -> Message:
        """Return the logs, the newest first, and how many older ones are not named."""
        found: dict[tuple[int, int], Message] = {}
        for directory in self._paths.layout.logs:
            for name, entry in files_below(self._paths.of(directory)):
                with suppress(OSError):  # renamed by the program meanwhile
                    state = entry.stat(follow_symlinks=False)
                    if name.lower().endswith(_SUFFIXES):
                        found[state.st_dev, state.st_ino] = {
                            "path": f"{directory}/{name}",
                            "name": name,
                            "size": state.st_size,
                            "modified": max(state.st_mtime, 0.0),
                            "usb": not directory.startswith(self._paths.layout.home),
                            "written": self._is_written(state.st_mtime),
                        }
        logs = sorted(found.values(), key=lambda log: log["modified"], reverse=True)
        return {"logs": logs[:_MOST], "older": len(logs[_MOST:])}

    def piece(self, request: Message) -> bytes:
        """Return a piece of a log, ``count`` bytes from ``offset`` on; fewer at its end."""
        with self._opened(request) as stream:
            stream.seek(request["offset"])
            return stream.read(request["count"])

    def hashed(self, request: Message) -> Message:
        """Return the SHA-256 of a log's first ``size`` bytes, and how many it has now."""
        digest, left = hashlib.sha256(), request["size"]
        self._activity.begin("hash")
        with self._opened(request) as stream:
            while left and (block := stream.read(min(left, BLOCK))):
                digest.update(block)
                left -= len(block)
                self._activity.step()
        return {"sha256": digest.hexdigest(), "size": self._file(request).stat().st_size}

    def remove(self, request: Message) -> Message:
        """Remove a log of ``size`` bytes.

        :raises Refusal: if it has another size now, or the program may still write it
        """
        with self._opened(request):  # it is there
            state = self._file(request).stat()
        if state.st_size != request["size"] or self._is_written(state.st_mtime):
            raise Refusal("log", f"{request['path']} has just been written on the robot, so it was not removed")
        self._file(request).unlink()
        return {}

    def _is_written(self, modified: float) -> bool:
        return abs(time.time() - modified) < _COMPLETE_SECONDS

    def _file(self, request: Message) -> Path:
        path = str(request["path"])
        inside = path.startswith(tuple(f"{each}/" for each in self._paths.layout.logs)) and ".." not in path.split("/")
        if not inside or not path.lower().endswith(_SUFFIXES):
            raise Refusal("log", f"{path} is none of the robot's logs")
        return self._paths.of(path)

    def _opened(self, request: Message) -> BinaryIO:
        try:
            return self._file(request).open("rb")
        except FileNotFoundError:
            what = f"{request['path']} is no longer on the robot: its program has renamed or removed it"
            raise Refusal("log", what, "See what it is called now: pyfrc logs") from None
