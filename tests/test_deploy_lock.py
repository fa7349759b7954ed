"""The lock on the robot: an undeploy removes its file without releasing the lock."""

from __future__ import annotations

import fcntl
import io
import os
from pathlib import Path
from typing import Any

import pytest
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import LocalRobot

from pyfrc_core.deploy.agent import releases, robot_paths, serve, wire
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.robot_paths import Lock, Refusal, RobotPaths
from pyfrc_core.deploy.targets.roborio import ROBORIO


def is_held(lock: Path) -> bool:
    with lock.open(encoding="utf-8") as stream:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return True
    return False


def test_a_lock_that_is_removed_while_it_is_waited_for(robot: LocalRobot, monkeypatch: pytest.MonkeyPatch) -> None:
    there = RobotPaths(ROBORIO.layout, str(robot.root))
    flock, calls = fcntl.flock, []

    def late_flock(stream: Any, how: int) -> None:
        if not calls:
            there.lock.unlink()
        calls.append(how)
        flock(stream, how)

    monkeypatch.setattr(fcntl, "flock", late_flock)
    monkeypatch.setattr(robot_paths, "_GRACE", 0.0)
    with Lock(there, "first"):
        with pytest.raises(Refusal, match="first is deploying to this robot right now"), Lock(there, "second"):
            pass
        assert is_held(there.lock)


def test_an_undeploy_holds_the_lock_until_everything_is_removed_and_limits_no_silence_then(
    robot: LocalRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    there = RobotPaths(ROBORIO.layout, str(robot.root))
    (there.releases / "1").mkdir(parents=True)
    (there.releases / "1.json").write_text("{}")
    there.code.symlink_to(".pyfrc/releases/1")
    held, remove = {}, serve.remove

    def watched_remove(path: Path) -> None:
        held[path] = is_held(there.lock)
        remove(path)

    for module in (serve, releases):
        monkeypatch.setattr(module, "remove", watched_remove)
    limited: list[bool] = []

    class LoggingWire(wire.Wire):
        def receive(self) -> wire.Message:
            limited.append(self.limits_silence)
            return super().receive()

    source, target = os.pipe()
    os.write(target, wire.message_frame({"op": "undeploy"}))
    os.close(target)
    responses = io.BytesIO()
    with io.FileIO(source, "rb") as stream:
        serve.Agent(LoggingWire(stream, responses), RealRobot(there), {"who": "alice"}).serve()
    assert limited == [False, False]
    responses.seek(0)
    wire.read_frame(responses.read)  # the facts
    assert wire.parse_message(*wire.read_frame(responses.read)) == {"done": {"removed": True}}
    assert {there.code, there.releases / "1.json", there.lock} <= held.keys()
    assert all(held.values())
    assert not there.own.exists()
