"""The agent's parts: frames, keep-alive messages, the console, its facts, restarting and watching a program."""

from __future__ import annotations

import io
import os
import signal
from collections.abc import Iterable
from pathlib import Path

import pytest

from pyfrc_core.deploy.agent import host, wire
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.compiling import Compiler
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.program import Program
from pyfrc_core.deploy.agent.robot_paths import Refusal, RobotPaths
from pyfrc_core.deploy.agent.wire import (
    CONTENT,
    EndedError,
    Wire,
    WireError,
    frame,
    message_frame,
    read_frame,
)
from pyfrc_core.deploy.targets.roborio import ROBORIO

# -- frames ------------------------------------------------------------------------------------------------------------


def pipe_with(sent: bytes) -> io.FileIO:
    source, target = os.pipe()
    os.write(target, sent)
    os.close(target)
    return io.FileIO(source, "rb")


def test_a_wire_receives_and_sends() -> None:
    with pipe_with(frame(CONTENT, b"left over") + message_frame({"op": "x"}) + frame(CONTENT, b"c")) as source:
        target = io.BytesIO()
        ours = Wire(source, target)
        assert ours.has_input()
        assert ours.receive() == {"op": "x"}  # contents of before are passed over
        assert ours.receive_contents() == b"c"
        with pytest.raises(EndedError):
            ours.receive()
        ours.send(a=1)
        assert wire.parse_message(*read_frame(io.BytesIO(target.getvalue()).read)) == {"a": 1}
    with (
        pipe_with(message_frame({})) as source,
        pytest.raises(WireError, match="received a message instead"),
    ):
        Wire(source, io.BytesIO()).receive_contents()


def test_a_wire_limits_silence() -> None:
    source, target = os.pipe()
    with io.FileIO(source, "rb") as stream, io.FileIO(target, "wb"):
        limited = Wire(stream, io.BytesIO(), silence_limit=0.01)
        assert not limited.has_input()
        limited.limits_silence = True
        with pytest.raises(WireError, match=r"no data for 0\.01 s"):
            limited.receive()
        # A laptop that holds no lock may be silent for longer, but not for ever.
        with pytest.raises(WireError, match=r"no data for 0\.02 s"):
            Wire(stream, io.BytesIO(), silence_limit=0.01, idle_limit=0.02).receive()


# -- the console -------------------------------------------------------------------------------------------------------


def message(kind: int, body: bytes) -> bytes:
    content = bytes([kind]) + body
    return len(content).to_bytes(2, "big") + content


# -- what is on the robot ----------------------------------------------------------------------------------------------


def test_the_image_of_a_roborio() -> None:
    assert ROBORIO.image_in({"image": 'x\nIMAGEVERSION = "FRC_2026"\n'}) == "FRC_2026"
    assert ROBORIO.image_in({"image": "IMAGEVERSION=FRC_2026\n"}) == "FRC_2026"
    assert ROBORIO.image_in({"image": ""}) is None
    assert ROBORIO.image_in({"image": None}) is None


# -- restarting --------------------------------------------------------------------------------------------------------


def robot_with_script(root: Path, script: str) -> RealRobot:
    file = root / "usr/local/frc/bin/frcKillRobot.sh"
    file.parent.mkdir(parents=True)
    file.write_text(f"#!/bin/sh\n{script}\n")
    file.chmod(0o755)
    return RealRobot(RobotPaths(ROBORIO.layout, str(root)))


class World:
    """What is seen of the robot's processes, look by look; the last look stays."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *looks: Iterable[int]) -> None:
        self._looks = [set(look) for look in looks]
        self.signals: list[tuple[int, int]] = []
        monkeypatch.setattr(RealRobot, "processes", lambda robot: self.processes())
        monkeypatch.setattr(host, "_END_SECONDS", 0.0)
        self._kill = os.kill
        monkeypatch.setattr(host.os, "kill", self.kill)

    def kill(self, process: int, number: int) -> None:
        if process < 10:
            self.signals.append((process, number))
        else:
            self._kill(process, number)  # the script's

    def processes(self) -> set[int]:
        return self._looks.pop(0) if len(self._looks) > 1 else self._looks[0]


def test_a_program_that_survives_is_ended_by_signals(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch, [7, 8], [7, 8, 9], [8], [9])
    assert robot_with_script(tmp_path, "").stop(start=True) is True
    assert sorted(world.signals) == [(7, signal.SIGTERM), (8, signal.SIGKILL), (8, signal.SIGTERM)]


def test_what_cannot_be_stopped_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    World(monkeypatch, [7])
    with pytest.raises(Refusal, match=r"there is no /usr/local/frc/bin/frcKillRobot\.sh on the robot"):
        RealRobot(RobotPaths(ROBORIO.layout, str(tmp_path))).stop(start=True)
    robot = robot_with_script(tmp_path, "echo cannot; exit 1")
    with pytest.raises(Refusal, match="has not stopped the old program: cannot"):
        robot.stop(start=True)
    robot.paths.of(ROBORIO.layout.stop[0]).write_text("exec /no/such/thing\n")
    with pytest.raises(Refusal, match="cannot be executed"):
        robot.stop(start=True)
    monkeypatch.setattr(host, "_COMMAND_SECONDS", 2)
    robot.paths.of(ROBORIO.layout.stop[0]).write_text("sleep 60\n")
    waits: list[int] = []
    with pytest.raises(Refusal, match=r"it did not end within 2 s"):
        robot.stop(start=True, meanwhile=lambda: waits.append(1))
    assert waits


def test_a_watch_ends_when_the_laptop_wants_something_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    World(monkeypatch, [8])
    monkeypatch.setattr(RealRobot, "is_running", lambda robot, process: True)
    ours = Program(RealRobot(RobotPaths(ROBORIO.layout, str(tmp_path))))
    monkeypatch.setattr(ours._console, "receive", lambda seconds: "")
    with pipe_with(message_frame({})) as source:
        assert ours.watch(Wire(source, io.BytesIO()), 60, 60)["verdict"] == "starting"


# -- compiling ---------------------------------------------------------------------------------------------------------


def compiled_in(directory: Path) -> list[str]:
    return sorted(".".join(each.name.split(".")[::2]) for each in directory.rglob("*.pyc"))


def test_the_programs_own_sources_have_to_be_valid(tmp_path: Path) -> None:
    (tmp_path / "wrong.py").write_text("x = 1\ndef f(:\n")
    activity = Activity(lambda **said: None)

    def compile_with(program: list[str]) -> None:
        with Compiler(tmp_path, ["wrong.py"], False, program) as compiler:
            compiler.add_next()
            compiler.finish(activity)

    compile_with([])
    with pytest.raises(Refusal, match=r"^wrong\.py:2: the robot's Python \d\.\d+ cannot compile this: ") as caught:
        compile_with(["wrong.py"])
    assert caught.value.kind == "syntax"


def test_where_no_process_can_be_forked_the_agent_compiles_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(os, "fork")
    for name in ("a.py", "b.py"):
        (tmp_path / name).write_text("x = 1\n")
    activity = Activity(lambda **said: None)
    with Compiler(tmp_path, ["a.py", "b.py"], False) as compiler:
        compiler.add_next()
        assert compiled_in(tmp_path) == ["a.opt-1"]
        compiler.add_next()
        compiler.finish(activity)
    assert compiled_in(tmp_path) == ["a.opt-1", "b.opt-1"]
