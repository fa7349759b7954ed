"""A disk that loses what was not flushed and synced, and that writes names in any order between two syncs.

The agent works on a directory of this machine. Before each of its steps there, the names below it are noted, and at
each sync what is certain from then on. So it is known afterwards what a power cut at any step may have left.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from pyfrc_core.deploy.agent import disk as agent_disk

_STEPS = {"os.rename", "os.link", "os.symlink", "os.mkdir", "os.remove", "os.rmdir", "ctypes.dlsym"}
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT
#: Names that may be lost alone, of those since the last sync: the latest ones matter.
_LOST_ALONE = 8


class Entry(NamedTuple):
    """What a name stands for: a directory, a link with its target, or a file, whose inode has its content."""

    kind: str
    target: str = ""
    inode: int = 0
    mode: int = 0


Names = dict[str, Entry]
#: Names in the order of their changes since a sync; None: removed.
Change = tuple[tuple[str, "Entry | None"], ...]


class State(NamedTuple):
    """What a power cut leaves: names, and the contents of files by inode."""

    names: frozenset[tuple[str, Entry]]
    contents: frozenset[tuple[int, bytes]]

    def write(self, root: Path) -> None:
        """Make a directory of it."""
        shutil.rmtree(root, ignore_errors=True)
        contents, written = dict(self.contents), dict[int, Path]()
        for name, entry in sorted(self.names):
            path = root / name
            if entry.kind == "directory":
                path.mkdir(parents=True, exist_ok=True)
            elif entry.kind == "link":
                path.symlink_to(entry.target)
            elif entry.inode in written:
                os.link(written[entry.inode], path)
            else:
                path.write_bytes(contents.get(entry.inode, b""))
                path.chmod(entry.mode)
                written[entry.inode] = path


class LossyDisk:
    """Notes what an agent does below a directory."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._certain: Names = {}
        self._contents: dict[int, bytes] = {}
        self._changes: list[Change] = []
        self._last: Names = {}
        #: All that a power cut may have left, at any step.
        self.states: dict[State, None] = {}
        self.sync()

    def step(self) -> None:
        """Note the names as they are before the next step."""
        names = self._names()
        changed = [
            (path, names.get(path)) for path in {**self._last, **names} if self._last.get(path) != names.get(path)
        ]
        if changed:
            self._changes.append(tuple(changed))
            self._last = names
        everything = range(len(self._changes))
        for kept in (everything, (), everything[-1:], *self._without_one(everything)):
            self._add(kept)

    @staticmethod
    def _without_one(everything: range) -> Iterator[list[int]]:
        for lost in everything[-_LOST_ALONE:]:
            yield [each for each in everything if each != lost]

    def _add(self, kept: Any) -> None:
        names = dict(self._certain)
        for number in kept:
            for path, entry in self._changes[number]:
                if entry is None:
                    names.pop(path, None)
                else:
                    names[path] = entry
        reachable = {path: entry for path, entry in names.items() if self._is_reachable(path, names)}
        inodes = {entry.inode for entry in reachable.values() if entry.kind == "file"}
        contents = {inode: self._contents.get(inode, b"") for inode in inodes}
        self.states[State(frozenset(reachable.items()), frozenset(contents.items()))] = None

    @staticmethod
    def _is_reachable(path: str, names: Names) -> bool:
        while above := path.rpartition("/")[0]:
            if above not in names or names[above].kind != "directory":
                return False
            path = above
        return True

    def sync_file(self, descriptor: int) -> None:
        """A file's content is certain from now on, as far as it was given to the system."""
        about = os.fstat(descriptor)
        for name, entry in self._names().items():
            if entry.inode == about.st_ino:
                self._contents[about.st_ino] = (self._root / name).read_bytes()
                return

    def sync(self) -> None:
        """All is certain from now on."""
        self._last = self._certain = self._names()
        self._contents = {e.inode: (self._root / name).read_bytes() for name, e in self._certain.items() if e.inode}
        self._changes = []
        self._add(())

    def _names(self) -> Names:
        found: Names = {}
        for path in self._root.rglob("*"):
            try:
                about, name = path.lstat(), path.relative_to(self._root).as_posix()
                if path.is_symlink():
                    found[name] = Entry("link", str(path.readlink()))
                elif path.is_dir():
                    found[name] = Entry("directory")
                else:
                    found[name] = Entry("file", "", about.st_ino, about.st_mode & 0o777)
            except FileNotFoundError:
                continue
        return found


_active: LossyDisk | None = None


def _hook(event: str, args: Any) -> None:
    global _active
    disk = _active
    if disk is not None and (event in _STEPS or (event == "open" and (args[2] or 0) & _WRITING)):
        _active = None  # what is read meanwhile is no step
        try:
            disk.step()
        finally:
            _active = disk


sys.addaudithook(_hook)


@contextmanager
def noted(root: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[LossyDisk]:
    """Note what the code within does below a directory."""
    global _active
    disk = LossyDisk(root)
    fsync = os.fsync

    def quietly(call: Callable[..., None], *args: Any) -> None:
        global _active
        _active = None
        try:
            disk.step()
            call(*args)
        finally:
            _active = disk

    def sync_file(file: Any) -> None:
        fsync(file)
        quietly(disk.sync_file, file if isinstance(file, int) else file.fileno())

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", sync_file)
        patch.delattr(os, "fork")  # the agent compiles by itself then
        patch.setattr(agent_disk, "flush", lambda directory: quietly(disk.sync))
        _active = disk
        try:
            yield disk
        finally:
            _active = None
            disk.step()
