"""The agent's parts: frames, keep-alive messages, the console, its facts, restarting and watching a program."""

from __future__ import annotations

import io
import os
import signal
import socket
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

from pyfrc_core.deploy.agent import host, wire
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.compiling import Compiler
from pyfrc_core.deploy.agent.console import ConsoleClient, OutputCommand, text_frame
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
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE

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


def received(output: ConsoleClient | OutputCommand) -> str:
    """What is received first; after the end, nothing."""
    text = ""
    while not text and vars(output).get("_socket", vars(output).get("_process")) is not None:
        text = output.receive(0.2)
    return text


def test_the_output_of_a_console_until_its_end() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        output = ConsoleClient("127.0.0.1", (1, server.getsockname()[1]))  # at the first port is none
        assert output.receive(0.0) == ""
        output.connect()
        robot, _ = server.accept()
        with robot:
            robot.sendall(text_frame(b"one", 1) + text_frame("zwei\xdf".encode(), 2)[:-1])
            assert received(output) == "one\n"
            assert robot.recv(100) == b"\0\0", "a sign of life"
            robot.sendall(text_frame(b"\x9f", 3)[-1:] + text_frame(b"three", 3))
            assert received(output) == "zwei\xdf\nthree\n"
        assert received(output) == ""
        assert output.receive(0.0) == ""
    with pytest.raises(OSError, match="refused"):
        output.connect()


def test_the_output_of_a_command_until_its_end() -> None:
    output = OutputCommand(["sh", "-c", "echo one; printf half; read line"])
    output.connect()
    assert received(output) == "one\n"
    output.disconnect()
    assert output.receive(0.0) == ""
    for command in (["true"], ["/no/such/command"]):
        output = OutputCommand(command)
        output.connect()
        assert received(output) == ""


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


def test_where_the_exit_code_of_the_command_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    World(monkeypatch, [])
    assert robot_with_script(tmp_path, "exit 1").stop(start=True) is False, "a roboRIO's script fails without a program"
    robot = RealRobot(RobotPaths(SYSTEMCORE.layout, str(tmp_path)))
    sudo = robot.paths.of(SYSTEMCORE.layout.stop[0])
    sudo.parent.mkdir(parents=True)
    sudo.write_text("#!/bin/sh\necho sudo: a password is required >&2\nexit 1\n")
    sudo.chmod(0o755)
    with pytest.raises(Refusal, match=r"^systemctl has failed: sudo: a password is required$") as caught:
        robot.stop(start=False)
    assert caught.value.remedy.startswith("Switch the robot off and on again")


def test_a_watch_ends_when_the_laptop_wants_something_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    World(monkeypatch, [8])
    monkeypatch.setattr(RealRobot, "is_running", lambda robot, process: True)
    ours = Program(RealRobot(RobotPaths(ROBORIO.layout, str(tmp_path))))
    monkeypatch.setattr(ours._console, "receive", lambda seconds: "")
    with pipe_with(message_frame({})) as source:
        assert ours.watch(Wire(source, io.BytesIO()), 60, 60)["verdict"] == "starting"


def test_of_much_output_before_the_restart_the_end_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    World(monkeypatch, [8], [9])
    ours = Program(robot_with_script(tmp_path, ""))
    printed = iter([f"{'x' * 40_000}\n", f"{'y' * 40_000}\nthe end\n"])

    def stop(robot: RealRobot, start: bool, meanwhile: Callable[[], None]) -> bool:
        meanwhile()
        return False

    monkeypatch.setattr(ours._console, "connect", lambda: None)  # another test's robot may have a console here
    monkeypatch.setattr(ours._console, "receive", lambda seconds: next(printed, ""))
    monkeypatch.setattr(RealRobot, "stop", stop)
    assert ours.restart() is False
    assert ours._output == f"[pyfrc has left out earlier output]\n{'y' * 40_000}\nthe end\n"


def test_what_is_known_of_processes_and_of_the_last_start(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = RealRobot(RobotPaths(ROBORIO.layout))
    assert robot.is_running(os.getpid())
    assert not robot.is_running(1 << 30)
    boot = robot.boot()
    assert (bool(boot.name), (boot.age or 0) > 0) == (True, True)
    assert robot.boot().name == boot.name
    monkeypatch.setattr(host, "age_of", lambda processes: None)
    assert robot.boot() == ("", None)


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
