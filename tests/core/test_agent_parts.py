"""The agent's parts: frames, keep-alive messages, the console, its facts, restarting and watching a program."""

from __future__ import annotations

import io
import os
import signal
import socket
import struct
import sys
import threading
import time
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from ports import refusing_port

from pyfrc_core.deploy.agent import console, host, imports, inventory, program, wire
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.compiling import CompiledForms, Compiler, compile_below
from pyfrc_core.deploy.agent.console import ConsoleClient, console_text, split_frames
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.program import Program
from pyfrc_core.deploy.agent.robot_paths import Refusal, RobotPaths
from pyfrc_core.deploy.agent.virtual import VARIABLE, VirtualRobotClient
from pyfrc_core.deploy.agent.wire import (
    CONTENT,
    MESSAGE,
    EndedError,
    OutputPipe,
    Wire,
    WireError,
    frame,
    message_frame,
    read_frame,
)
from pyfrc_core.deploy.agent_stream import MAX_RESPONSE_BYTES
from pyfrc_core.deploy.responses import parse_json
from pyfrc_core.deploy.targets.roborio import ROBORIO

# -- frames ------------------------------------------------------------------------------------------------------------


def test_a_frame_is_its_length_its_kind_and_its_body() -> None:
    assert frame(CONTENT, b"abc") == b"\0\0\0\3Cabc"
    assert read_frame(io.BytesIO(b"\0\0\0\3Cabc").read) == (CONTENT, b"abc")
    assert wire.parse_message(*read_frame(io.BytesIO(message_frame({"a": 1})).read)) == {"a": 1}
    assert read_frame(io.BytesIO(b"\0\0\0\0J").read) == (MESSAGE, b"")
    assert read_frame(io.BytesIO(b"\0\0\0\3Cabc").read, longest=3) == (CONTENT, b"abc")


@pytest.mark.parametrize(
    ("sent", "error", "message"),
    [
        (b"", EndedError, "the stream has ended"),
        (b"\0\0\0\3", EndedError, "the stream has ended"),
        (b"\0\0\0\3Cab", EndedError, "the stream has ended in the middle of a frame"),
        (b"\0\0\0\3Xabc", WireError, "this is not a frame: b'"),
        (b"\0\0\0\4Cabcd", WireError, "this is not a frame: b'"),
    ],
)
def test_what_is_no_frame(sent: bytes, error: type[WireError], message: str) -> None:
    with pytest.raises(error) as caught:
        read_frame(io.BytesIO(sent).read, longest=3)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    ("kind", "body", "message"),
    [
        (CONTENT, b"", "received file contents instead of a message"),
        (MESSAGE, b"abc", "a frame cannot be read"),
        (MESSAGE, zlib.compress(b"[]"), "a frame does not hold one JSON object"),
        (MESSAGE, zlib.compress(b"{"), "a frame cannot be read"),
        (MESSAGE, zlib.compress(b"{}")[:-1], "a frame is too long, or is cut short"),
    ],
)
def test_what_says_nothing(kind: bytes, body: bytes, message: str) -> None:
    with pytest.raises(WireError) as caught:
        wire.parse_message(kind, body)
    assert str(caught.value).startswith(message)


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


def test_a_pipe_that_the_laptop_reads() -> None:
    source, target = os.pipe()
    received: list[bytes] = []

    def read() -> None:
        while chunk := os.read(source, 10_000):
            received.append(chunk)

    reader = threading.Thread(target=read)
    reader.start()
    Wire(io.BytesIO(), OutputPipe(target)).send(text=os.urandom(500_000).hex())
    os.close(target)
    reader.join()
    os.close(source)
    assert len(wire.parse_message(*read_frame(io.BytesIO(b"".join(received)).read))["text"]) == 1_000_000


def test_a_pipe_that_the_laptop_does_not_read() -> None:
    """A suspended laptop's connection stays: the agent would hold its lock for as long as the program prints."""
    source, target = os.pipe()
    pipe = OutputPipe(target, limit=0.01)
    for _ in range(2):
        with pytest.raises(ConnectionAbortedError):
            Wire(io.BytesIO(), pipe).send(text=os.urandom(500_000).hex())
    os.close(source)
    os.close(target)


# -- signs of life -----------------------------------------------------------------------------------------------------


def test_a_sign_is_sent_for_work_once_a_second() -> None:
    now, signs = [0.0], []
    activity = Activity(lambda **said: signs.append(said["alive"]), clock=lambda: now[0])
    for second, phase in ((0.5, "check"), (0.999, ""), (1.0, ""), (1.5, "send"), (2.0, ""), (9.0, "")):
        now[0] = second
        if phase:
            activity.begin(phase, of=10)
        activity.step(2)
    assert signs == [
        {"phase": "check", "count": 6, "of": 10},
        {"phase": "send", "count": 4, "of": 10},
        {"phase": "send", "count": 6, "of": 10},
    ]
    now[0] = 10.5
    activity.reset()
    now[0] = 11.4
    activity.step()
    assert len(signs) == 3


def test_a_call_that_takes_long_is_accompanied_by_signs() -> None:
    now, signs = [0.0], []

    def clock() -> float:
        now[0] += 100.0
        return now[0]

    release = threading.Event()

    def call(value: int) -> int:
        assert release.wait(60), "no third message"
        return value + 1

    def send(**sent: Any) -> None:
        signs.append(sent["alive"])
        if len(signs) == 3:
            release.set()

    activity = Activity(send, clock=clock, pause=0.001)
    activity.begin("sync")
    assert activity.wait_for(call, 3) == 4
    assert signs[:3] == [{"phase": "sync", "count": 0, "of": 0}] * 3
    with pytest.raises(KeyError):
        activity.wait_for({}.__getitem__, "x")


# -- the console -------------------------------------------------------------------------------------------------------


def message(kind: int, body: bytes) -> bytes:
    content = bytes([kind]) + body
    return len(content).to_bytes(2, "big") + content


def text_message(text: str) -> bytes:
    return message(console.TEXT, b"\0" * 6 + text.encode())


def error_message(*parts: str) -> bytes:
    packed = b"".join(struct.pack(">H", len(part.encode())) + part.encode() for part in parts)
    return message(console.ERROR, b"\0" * 13 + packed)


def test_messages_of_the_console() -> None:
    stream = text_message("one") + b"\0\0" + error_message("what", "", "where") + text_message("two\n")
    messages, rest = split_frames(stream + b"\0\5abc")
    assert rest == b"\0\5abc"
    assert [console_text(each) for each in messages] == ["one\n", "", "what where\n", "two\n"]
    assert split_frames(b"\0") == ([], b"\0")
    assert split_frames(b"\0\1a") == ([b"a"], b"")
    assert console_text(b"\x07abc") == ""
    assert console_text(b"") == ""


def test_a_console_client() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener, refusing_port() as refusing:
        ours = ConsoleClient((refusing, listener.getsockname()[1]))
        assert ours.receive(0.0) == ""  # nothing listens
        ours.connect()
        robot, _ = listener.accept()
        with robot:
            robot.sendall(text_message("one") + text_message("two")[:-1])
            heard = ""
            while not heard:
                heard = ours.receive(1.0)
            assert heard == "one\n"
            assert robot.recv(100) == console.KEEP_ALIVE
            robot.sendall(text_message("two")[-1:])
            while heard == "one\n":
                heard += ours.receive(1.0)
            assert heard == "one\ntwo\n"
            assert ours.receive(0.0) == ""
        while ours._socket is not None:
            assert ours.receive(1.0) == ""
        assert ours.receive(0.0) == ""
        ours.connect()
        ours.disconnect()
        assert ours._socket is None


# -- what is on the robot ----------------------------------------------------------------------------------------------


def test_modules_are_found_without_importing_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("pack/__init__.py", "pack/inner/__init__.py", "pack/inner/leaf.py", "space/part/leaf.py", "single.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("raise SystemExit\n")
    for name in ("My.Package-1.2.3.dist-info", "other_one-4.0-py3.9.egg-info", "no.txt"):
        (tmp_path / name).mkdir()
    monkeypatch.setattr(sys, "path", [str(tmp_path), "", str(tmp_path / "none"), *sys.path])
    there = (
        "pack",
        "pack.inner",
        "pack.inner.leaf",
        "space",
        "space.part.leaf",
        "single",
        "json",
        "json.decoder",
        "os.path",
    )
    assert [name for name in there if not imports.is_there(name)] == []
    # What a module that is no package has below it, only the module could say.
    assert imports.is_there("single.x")
    missing = ["none", "none.x", "pack.none", "pack.inner.none", "space.none", "space.part.none"]
    found = imports.look_up([*there, *missing])
    assert found["missing_modules"] == missing
    assert (found["packages"]["my-package"], found["packages"]["other-one"]) == ("1.2.3", "4.0")
    assert "no" not in found["packages"]
    assert not {"pack", "single"} & set(sys.modules)


def test_what_other_languages_have_left(tmp_path: Path) -> None:
    places = RobotPaths(ROBORIO.layout, str(tmp_path))
    assert places.of("/home/lvuser") == tmp_path / "home/lvuser"
    assert inventory.find_other_languages(places) == []
    files = ("home/lvuser/b.jar", "home/lvuser/a.jar", "home/lvuser/frcUserProgram", "usr/local/frc/JRE/bin/java")
    for name in (*files, "usr/local/frc/third-party/lib/x.so", "home/lvuser/robotDebugCommand"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("/home/lvuser/frcUserProgram")
    assert inventory.find_other_languages(places) == [
        "/home/lvuser/robotDebugCommand",
        "/home/lvuser/a.jar",
        "/home/lvuser/b.jar",
        "/home/lvuser/frcUserProgram",
        "/usr/local/frc/JRE/bin/java",
        "/usr/local/frc/third-party/lib",
    ]


def test_the_image_of_a_roborio() -> None:
    assert ROBORIO.image_in({"image": 'x\nIMAGEVERSION = "FRC_2026"\n'}) == "FRC_2026"
    assert ROBORIO.image_in({"image": "IMAGEVERSION=FRC_2026\n"}) == "FRC_2026"
    assert ROBORIO.image_in({"image": ""}) is None
    assert ROBORIO.image_in({"image": None}) is None


def test_a_virtual_robot_in_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    assert VirtualRobotClient.from_environment(ROBORIO.layout) is None
    virtual = VirtualRobotClient(ROBORIO.layout, "/robot", 1234, "ab", 5678)
    monkeypatch.setenv(VARIABLE, virtual.to_text())
    found = VirtualRobotClient.from_environment(ROBORIO.layout)
    assert found is not None
    assert found.to_text() == virtual.to_text()
    assert (found.paths.root, found.console_ports) == (Path("/robot"), (5678,))


def test_own_processes() -> None:
    robot = RealRobot(RobotPaths(ROBORIO.layout))
    assert robot.is_running(os.getpid())
    assert not robot.is_running(2**22 + 1)
    assert os.getpid() not in robot.processes()
    state = program.process_state(robot, os.getpid())
    assert state["cpu"] > 0
    assert state["network_tables"] is False
    assert program.process_state(robot, 2**22 + 1) == {}
    age = host.age_of([os.getpid(), 2**22 + 1])
    assert age is not None
    assert 0 <= age < 86_400
    assert host.age_of([]) is None
    assert robot._is_jar(b"/home/lvuser/Robot.jar")
    assert not robot._is_jar(b"/home/other/Robot.jar")
    assert not robot._is_jar(b"/home/lvuser/Robot.jar.txt")


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


@pytest.mark.parametrize(("start", "options"), [(True, "-t -r"), (False, "-t")])
def test_the_kill_script_is_run(start: bool, options: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch, [7], [8])
    robot = robot_with_script(tmp_path, f'echo "$@" > {tmp_path}/options')
    profile = tmp_path / "etc/profile.d/natinst-path.sh"
    profile.parent.mkdir(parents=True)
    profile.write_text(f"touch {tmp_path}/sourced\n")
    assert robot.stop(start=start) is False
    assert (tmp_path / "options").read_text() == f"{options}\n"
    assert (tmp_path / "sourced").exists()
    assert world.signals == []


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


def test_a_restart_is_watched_until_there_is_a_verdict(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    World(monkeypatch, [7], [7], [], [8])
    ours = Program(robot_with_script(tmp_path, ""))
    heard = iter(["", "WPILib version 2026\n", "********** Robot program startup complete **********\n"])

    def receive(seconds: float) -> str:
        time.sleep(seconds / 4)
        return next(heard, "") if ours._monitor is None else ""  # it prints when it is watched

    monkeypatch.setattr(ours._console, "receive", receive)
    monkeypatch.setattr(RealRobot, "is_running", lambda robot, process: True)
    monkeypatch.setattr(program, "_REPORT_SECONDS", 0.0)
    ours.restart()
    source, target = os.pipe()
    answers = io.BytesIO()
    with io.FileIO(source, "rb") as stream, io.FileIO(target, "wb"):
        watched = ours.watch(Wire(stream, answers), 60, 60)
    assert watched["verdict"] == "running"
    assert (watched["heard"], watched["seen"]) == (True, True)
    assert watched["age"] >= 0.6
    answers.seek(0)
    said = []
    while answers.tell() < len(answers.getvalue()):
        said.append(wire.parse_message(*read_frame(answers.read)))
    assert "startup complete" in "".join(each.get("output", "") for each in said)
    assert any("watching" in each for each in said)


def test_a_watch_ends_when_the_laptop_wants_something_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    World(monkeypatch, [8])
    monkeypatch.setattr(RealRobot, "is_running", lambda robot, process: True)
    ours = Program(RealRobot(RobotPaths(ROBORIO.layout, str(tmp_path))))
    monkeypatch.setattr(ours._console, "receive", lambda seconds: "")
    with pipe_with(message_frame({})) as source:
        assert ours.watch(Wire(source, io.BytesIO()), 60, 60)["verdict"] == "starting"


@pytest.mark.parametrize(
    ("text", "reports"),
    [
        ("import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n", True),
        ("class MyRobot(wpilib.TimedRobot):  # no longer a magicbot\n", True),
        ("class MyRobot(commands2.TimedCommandRobot):\n", True),
        ("import wpilib\n", False),
        ("import magicbot\n\nclass MyRobot(wpilib.TimedRobot):\n", False),
        ("class MyRobot(wpilib.TimedRobot):\n    def startCompetition(self):\n", False),
    ],
)
def test_what_reports_its_start(tmp_path: Path, text: str, reports: bool) -> None:
    (tmp_path / "robot.py").write_text(text)
    assert program._reports_start(tmp_path / "robot.py") is reports
    # The class may be in any module of the program.
    (tmp_path / "robot.py").write_text("from bases.ours import MyRobot\n")
    (tmp_path / "bases").mkdir()
    (tmp_path / "bases/ours.py").write_text(text)
    assert program._reports_start(tmp_path / "robot.py") is reports


def test_a_program_whose_main_file_is_unknown_reports_its_start() -> None:
    assert program._reports_start(None)


def output_of(*texts: str, before: str = "") -> list[str]:
    """What the laptop accepts of this output of a program, message by message.

    :param before: printed during the restart
    """
    ours, responses = Program(RealRobot(RobotPaths(ROBORIO.layout))), io.BytesIO()
    waiting = iter([before, *texts])
    with pytest.MonkeyPatch.context() as patch, pipe_with(message_frame({})) as source:
        World(patch, [8])
        patch.setattr(ours._console, "connect", lambda: None)
        patch.setattr(ours._console, "receive", lambda seconds: next(waiting, ""))
        patch.setattr(RealRobot, "is_running", lambda robot, process: True)
        patch.setattr(RealRobot, "stop", lambda robot, start, meanwhile: meanwhile())
        patch.setattr(RealRobot, "processes", lambda robot: {8} if ours._monitor else set())
        ours.restart()
        ours.watch(Wire(source, responses), 60, 60)
    responses.seek(0)
    found = []
    while responses.tell() < len(responses.getvalue()):
        text = wire.unpack_message(*read_frame(responses.read, MAX_RESPONSE_BYTES), MAX_RESPONSE_BYTES)
        found.append(parse_json(text).get("output", ""))
    return [each for each in found if each]


@pytest.mark.parametrize("line", ["[],", "\0", "\U0001f916", "x"])
def test_much_output_is_sent_in_pieces(line: str) -> None:
    text = line * (300_000 // len(line)) + "\n"
    assert "".join(output_of("", text)) == text


def test_the_last_output_of_a_long_restart_is_kept() -> None:
    lines = [f"line {number}" for number in range(100_000)]
    kept = "".join(output_of(before="\n".join([*lines, ""]))).splitlines()
    assert kept[0] == "[pyfrc has left out earlier output]"
    assert kept[1:] == lines[1 - len(kept) :]
    assert len("\n".join(kept)) > 60_000


# -- compiling ---------------------------------------------------------------------------------------------------------


def compiled_in(directory: Path) -> list[str]:
    return sorted(".".join(each.name.split(".")[::2]) for each in directory.rglob("*.pyc"))


def test_what_is_not_compiled_yet_is_compiled(tmp_path: Path) -> None:
    for name in ("a.py", "b.py", "sub/c.py", "no.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("x = 1\n")
    signs: list[Any] = []
    activity = Activity(lambda **said: signs.append(said), pause=-1.0)
    compile_below(tmp_path, False, activity)
    assert compiled_in(tmp_path) == ["a.opt-1", "b.opt-1", "c.opt-1"]
    assert signs[-1] == {"alive": {"phase": "compile", "count": 3, "of": 3}}
    compile_below(tmp_path, True, activity)
    assert compiled_in(tmp_path) == ["a.opt-1", "a.pyc", "b.opt-1", "b.pyc", "c.opt-1", "c.pyc"]
    forms = CompiledForms()
    source = str(tmp_path / "a.py")
    assert forms.includes(source, True)
    assert forms.includes(source, False)
    assert not forms.includes(str(tmp_path / "d.py"), True)
    assert [Path(form).name.partition(".")[0] for form in forms.of(source)] == ["a", "a"]
    assert forms.of(str(tmp_path / "no.txt")) == []
    (tmp_path / "new").mkdir()
    forms.link(source, str(tmp_path / "new/a.py"))
    forms.link(str(tmp_path / "no.txt"), str(tmp_path / "new/no.txt"))
    assert compiled_in(tmp_path / "new") == ["a.opt-1", "a.pyc"]


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
