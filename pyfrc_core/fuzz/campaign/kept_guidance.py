"""Keep what guides a campaign in ``.pyfrc/fuzz/corpus``, so that a later campaign goes on where this one ended.

The goals that were reached are valid for the same code only. After a change of the code, the matches that are worth
continuing are played again: those that reach nothing are dropped.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path

from ...passes.memory import hash_of_file
from ...project import Project
from ...project.walk import python_files
from ...text_files import keep_out_of_version_control, write_whole
from .stream import Shard, Stream

DIRECTORY = Path(".pyfrc", "fuzz", "corpus")


class KeptGuidance:
    """The file of one campaign.

    :param streams: the campaign's streams that this machine plays
    """

    def __init__(self, project: Project, seed: int, shard: Shard, count: int, streams: Sequence[Stream]) -> None:
        self._root = project.root
        self._fingerprint = fingerprint(project)
        self._streams = streams
        part = f"-part-{shard.number}-of-{shard.count}" if shard.count > 1 else ""
        self._file = project.root / DIRECTORY / f"seed-{seed}-streams-{count}{part}.json"

    def restore(self) -> bool:
        """Restore the streams; return whether the robot's code has changed since. Without a valid file, do nothing."""
        try:
            kept = json.loads(self._file.read_text("utf-8"))
            for stream, state in zip(self._streams, kept["streams"], strict=True):
                stream.restore(state)
        except FileNotFoundError:
            return False
        except (OSError, ValueError, KeyError, TypeError):
            for stream in self._streams:
                stream.clear()
            return False
        return bool(kept["project"] != self._fingerprint)

    def snapshot(self) -> str:
        """Return the text of the file for this moment."""
        states = [stream.state() for stream in self._streams]
        return json.dumps({"project": self._fingerprint, "streams": states})

    def write(self, text: str) -> None:
        """Write the file. If it cannot be written, the next campaign begins anew."""
        with suppress(OSError):
            self._file.parent.mkdir(parents=True, exist_ok=True)
            keep_out_of_version_control(self._root / DIRECTORY.parts[0])
            write_whole(self._file, [text])


def fingerprint(project: Project) -> str:
    """Return a text that changes with everything that the goals of a campaign depend on."""
    digest = hashlib.sha256()
    names = ("pyfrc", "wpilib")
    digest.update(repr((sys.version_info[:2], [version(name) for name in names], project.settings)).encode())
    root = project.main_file.parent
    for file in python_files(root):
        if "tests" in file.relative_to(root).parts:
            continue
        digest.update(f"{file.relative_to(root).as_posix()}\0".encode())
        digest.update(hash_of_file(file).encode())
    return digest.hexdigest()
