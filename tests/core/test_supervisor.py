"""The supervisor of a virtual robot's program, with a program that runs until it is stopped."""

from __future__ import annotations

import os
import queue
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.virtual_robot import supervisor
from pyfrc_core.virtual_robot.supervisor import Supervisor

PROGRAM = "import os, sys; print(os.getpid(), flush=True); sys.stdin.read()"


class Watched(Supervisor):
    """A supervisor whose program says its process id."""

    def __init__(self, directory: Path) -> None:
        self.lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self.ends: list[str] = []
        paths = RobotPaths(ROBORIO.layout, str(directory))
        paths.home.mkdir(parents=True)
        (paths.home / ROBORIO.layout.command).write_text("python3", encoding="utf-8")
        super().__init__(paths, self.lines.put, self.ends.append)


@pytest.fixture
def watched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Watched]:
    monkeypatch.setattr(supervisor, "program_words", lambda command, paths: [sys.executable, "-c", PROGRAM])
    watched = Watched(tmp_path)
    watched.start()
    yield watched
    watched.close()


def test_a_program_that_is_stopped_has_ended_and_is_not_started_again(watched: Watched) -> None:
    first = int(watched.lines.get())
    assert watched.processes() == [first]
    watched.stop()
    assert watched.processes() == []
    with pytest.raises(ProcessLookupError):
        os.kill(first, 0)
    watched.restart()
    assert int(watched.lines.get()) != first
    assert watched.ends == []


def test_a_program_that_ends_by_itself_is_started_again(watched: Watched) -> None:
    first = int(watched.lines.get())
    os.kill(first, 9)
    assert int(watched.lines.get()) != first
    assert watched.ends == ["the robot program has ended (signal 9); restarting it"]
