"""The virtual robot's disk: a directory with the same layout as a robot's root directory."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from ..deploy.agent.disk import text_of, write_whole
from ..deploy.agent.layout import Layout
from ..deploy.agent.robot_paths import RobotPaths
from ..deploy.agent.system import lock
from ..errors import PyfrcError, UsageError

if TYPE_CHECKING:
    import paramiko


class RobotDisk:
    """A directory with the files of one virtual robot, locked until the end of the ``with`` block.

    :param directory: created if it does not exist
    :param layout:    the controller that it stands for
    :param fresh:     remove the robot's programs first; its SSH key stays
    :raises UsageError: if the directory has other files
    :raises PyfrcError: if a virtual robot is using it, or it cannot be written
    """

    def __init__(self, directory: Path, layout: Layout, fresh: bool = False) -> None:
        self.directory = directory
        self.paths = RobotPaths(layout, str(directory / "root"))
        self._key_file = directory / "host_key"
        self._port_file = directory / "port"
        with _storing_in(directory):
            if directory.is_dir() and any(directory.iterdir()) and not self._key_file.exists():
                raise UsageError(
                    "this directory has files that are not from a virtual robot",
                    where=directory,
                    remedy="Choose a new or empty directory with --directory DIR.",
                )
            directory.mkdir(parents=True, exist_ok=True)
            self._lock = (directory / "lock").open("a+", encoding="utf-8")
            try:
                self._take_lock()
                self.key = self._host_key()
                if fresh:
                    shutil.rmtree(self.paths.root, ignore_errors=True)
                self._create()
            except BaseException:
                self._lock.close()
                raise

    def __enter__(self) -> RobotDisk:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._lock.truncate(0)
        self._lock.close()

    def last_port(self) -> int | None:
        """Return the port of the last start."""
        text = text_of(self._port_file) or ""
        return int(text) if text.isdecimal() else None

    def write_address(self, address: str, port: int) -> None:
        """Store the port for the next start, and the address for the error message of a second start."""
        with _storing_in(self.directory):
            write_whole(self._port_file, str(port))
            self._lock.truncate(0)
            self._lock.write(json.dumps({"address": address}))
            self._lock.flush()

    def _take_lock(self) -> None:
        try:
            lock(self._lock)
        except OSError:
            self._lock.seek(0)
            raise PyfrcError(
                f"a virtual robot is already running here{_at(self._lock.read())}",
                where=self.directory,
                remedy="Deploy to it, stop it with Ctrl-C, or start another one with --directory DIR.",
            ) from None

    def _host_key(self) -> paramiko.PKey:
        import paramiko

        if not self._key_file.exists():
            # Written atomically: an incomplete key file would prevent all later starts.
            beside = self._key_file.with_suffix(".new")
            paramiko.ECDSAKey.generate().write_private_key_file(str(beside))
            beside.replace(self._key_file)
        try:
            return paramiko.ECDSAKey.from_private_key_file(str(self._key_file))
        except (paramiko.SSHException, ValueError) as error:  # ValueError: it is not text
            raise PyfrcError(
                f"this is not an SSH key: {error}",
                where=self._key_file,
                remedy="Remove the directory; the virtual robot then starts without programs, and with a new key.",
            ) from error

    def _create(self) -> None:
        temporary = self.paths.of("/tmp")
        shutil.rmtree(temporary, ignore_errors=True)  # as on a robot, at each start
        for each in (self.paths.home, temporary):
            each.mkdir(parents=True, exist_ok=True)


@contextmanager
def _storing_in(directory: Path) -> Iterator[None]:
    """Name the directory in errors of the operating system, of which some name no file, as that of a full disk."""
    try:
        yield
    except OSError as error:
        raise PyfrcError(
            f"cannot store the virtual robot's files here: {(error.strerror or str(error)).lower()}",
            where=directory,
            remedy="Choose a writable directory with --directory DIR.",
        ) from error


def _at(text: str) -> str:
    try:
        return f", at {json.loads(text)['address']}"
    except (ValueError, KeyError, TypeError):
        return ""
