"""A robot that sends invalid data: one sentence each time, within limits of time and memory."""

from __future__ import annotations

import os
import struct
import threading
import tracemalloc
import zlib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest
from loops import for_each
from roborio.local import project_of

from pyfrc_core.deploy import agent_stream
from pyfrc_core.deploy.agent import wire
from pyfrc_core.deploy.agent_client import AgentClient, DeployRequest
from pyfrc_core.deploy.agent_stream import TimeLimits
from pyfrc_core.deploy.errors import DeployError
from pyfrc_core.deploy.manifest import Manifest
from pyfrc_core.deploy.targets import CONTROLLERS, ControllerKind

Script = Iterable[bytes]

FACTS: dict[str, Any] = {
    "python": "3.14.0",
    "wpilib": "2026.2.2",
    "virtual": False,
    "texts": {"image": "IMAGEVERSION = FRC_roboRIO_2026_v1.2", "memory": None},
    "can_restart": True,
    "free": 1_000_000,
    "user": "lvuser",
    "home": True,
    "current": 1,
    "releases": [
        {
            "release": 1,
            "taken": False,
            "main": "robot.py",
            "debug": False,
            "files": 3,
            "from": None,
            "deploy": {},
            "ran": True,
            "ended": False,
        }
    ],
    "other_code": False,
    "deploy_json": "{}",
    "command": None,
    "debug": False,
    "running": True,
    "packages": {"wpilib": "2026.2.2"},
    "missing_modules": [],
    "machine": "armv7l",
    "program_age": 12.5,
    "remains": False,
}
DEPLOYED = {
    "release": 2,
    "previous": 1,
    "fallback": 1,
    "taken": None,
    "unchanged": False,
    "files": 1,
    "bytes": 10,
}
STATE = {"seconds": 1.5, "age": 1.0, "heard": True, "seen": True, "replaced": False}
HELLO = wire.message_frame({"done": FACTS})
REQUEST = DeployRequest("robot.py", {})


def packed(text: bytes) -> bytes:
    return wire.frame(wire.MESSAGE, zlib.compress(text))


class FakeRobot:
    """A robot that sends what it was made to: something for each time that it is sent something.

    :param then: what it sends when all of it was read: nothing, and the link is closed, or something for ever
    :param status: with which its command has ended; none: that is never known
    """

    address = "10.12.34.2"
    controller: ControllerKind = CONTROLLERS[0]

    def __init__(self, *scripts: bytes, then: Script = (), status: int | None = -1, errors: bytes = b"") -> None:
        self._scripts = iter(scripts)
        self._buffer = b""
        self._then = iter(then)
        self._status = status
        self._errors = errors
        self.status_event = threading.Event()
        if status is not None:
            self.status_event.set()
        self.closed = False

    def open(self, command: str) -> FakeRobot:
        return self

    def sendall(self, data: bytes) -> None:
        self._buffer += next(self._scripts, b"")

    def recv(self, count: int) -> bytes:
        self._buffer = self._buffer or next(self._then, b"")
        piece, self._buffer = self._buffer[:count], self._buffer[count:]
        return piece

    def recv_ready(self) -> bool:
        return bool(self._buffer)

    def recv_stderr(self, count: int) -> bytes:
        return self._errors[:count]

    def recv_exit_status(self) -> int:
        assert self._status is not None, "it would wait for ever"
        return self._status

    def settimeout(self, seconds: float | None) -> None:
        assert seconds

    def close(self) -> None:
        self.closed = True


def protocol_error(robot: FakeRobot, do: Callable[[AgentClient], object] = lambda robot: None, **limits: float) -> str:
    """Return the error message: one sentence and a remedy."""
    with pytest.raises(DeployError) as caught:
        do(AgentClient.start(robot, limits=TimeLimits(**limits)))
    error = caught.value
    assert error.exit_code == 1
    assert "\n" not in error.message
    assert len(error.message) < 1200
    assert error.message.isprintable()
    assert error.remedy
    return error.message


NOT_THE_AGENT = "the robot sent data that is not from pyfrc's agent: "


# -- frames ------------------------------------------------------------------------------------------------------------

FRAMES = {
    "wrong kind": wire.frame(b"X", b"{}"),
    "contents": wire.frame(wire.CONTENT, b"abc"),
    "length 0": wire.frame(wire.MESSAGE, b""),
    "length 4 GB": b"\xff\xff\xff\xff" + wire.MESSAGE + bytes(100),
    "just too long": struct.pack(">I", agent_stream.MAX_RESPONSE_BYTES + 1) + wire.MESSAGE,
    "no zlib": wire.frame(wire.MESSAGE, b"{}"),
    "zlib without an end": wire.frame(wire.MESSAGE, zlib.compress(b"{}")[:-4]),
    "no UTF-8": packed(b'{"done": "\xff"}'),
    "no JSON": packed(b"{'done': 1}"),
    "empty JSON": packed(b""),
    "a list": packed(b"[1, 2]"),
    "a number": packed(b"1e999"),
    "a huge number": packed(b'{"done": ' + b"9" * 5_000 + b"}"),
    "a banner": b"\r\n*** Welcome to the robot! ***\x1b[2J\r\n",
    "nothing that is known": wire.message_frame({"hello": 1}),
    "no object as the answer": wire.message_frame({"done": [FACTS]}),
    "no response": wire.message_frame({"done": None}),
    "an error that is a number": wire.message_frame({"error": 1, "message": "x", "remedy": ""}),
    "an error without a message": wire.message_frame({"error": "bug"}),
    "an error with a list": wire.message_frame({"error": "bug", "message": "x", "remedy": "", "traceback": []}),
    "an error with a remedy that is none": wire.message_frame({"error": "x", "message": "x", "remedy": {"a": 1}}),
}

#: Those that take long to make, which each process of the suite would do.
LARGE: dict[str, Callable[[], bytes]] = {
    "zlib bomb": lambda: packed(b'{"done": "' + bytes(50_000_000) + b'"}'),
    "deep JSON": lambda: packed(b'{"done": ' + b"[" * 100_000),
    "millions of lists": lambda: packed(b'{"done": [' + b"[]," * 2_600_000 + b"[]]}"),
    "many keys": lambda: packed(b'{"done": {' + b",".join(b'"%x":0' % each for each in range(400_000)) + b"}}"),
    "wide letters": lambda: packed(('{"done": "\U0001f600' + "x" * 4_000_000 + '"}').encode()),
}


def refused_within_memory(frame: bytes, what: str) -> None:
    """Assert that a frame is refused in a sentence, and that this takes little memory."""
    tracemalloc.start()
    try:
        message = protocol_error(FakeRobot(frame))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert message.startswith(NOT_THE_AGENT), what
    assert peak < 40_000_000, what


def test_a_frame_that_is_none() -> None:
    for what, frame in FRAMES.items():
        refused_within_memory(frame, what)


def test_a_large_frame_that_is_none() -> None:
    for what, make in LARGE.items():
        refused_within_memory(make(), what)


def test_the_longest_real_response_is_read(project: Manifest) -> None:
    """The changes of a project with 50,000 files, with as many commas in their names."""
    paths = [f"deploy/trajectories, and choreo/{number:05}.traj" for number in range(50_000)]
    plan = {"added": paths, "changed": [], "removed": [], "files": 50_000, "bytes": 1}
    robot = AgentClient.start(FakeRobot(HELLO, wire.message_frame({"done": plan})))
    assert len(robot.plan(project).added) == 50_000


@for_each("status", [-1, None, 0])
def test_a_link_that_is_closed_in_the_middle(status: int | None) -> None:
    for cut in (0, 1, 5, 6, len(HELLO) - 1):
        message = protocol_error(FakeRobot(HELLO[:cut], status=status), start=0.01)
        assert message.startswith("the connection to the robot was lost: the stream has ended"), cut


def test_many_errors_printed() -> None:
    message = protocol_error(FakeRobot(status=1, errors=b"x\n" * 1_000_000 + b"\x1b]0;pwned\x07" + b"y" * 1_000_000))
    assert message.startswith("the agent on the robot has ended: ")


# -- the fields of each response ---------------------------------------------------------------------------------------


@for_each(
    "wrong",
    [{"python": 3}, {"releases": [{}]}, {"releases": {}}, {"current": -1}, {"texts": []}, {"free": float("nan")}, None],
)
def test_facts_with_a_wrong_field(wrong: dict[str, Any] | None) -> None:
    facts = {} if wrong is None else {**FACTS, **wrong}
    assert protocol_error(FakeRobot(wire.message_frame({"done": facts}))).startswith(NOT_THE_AGENT)


@pytest.fixture
def project(tmp_path: Path) -> Manifest:
    return project_of(tmp_path / "project", {"robot.py": "x = 1\n", "a.py": ""})


@for_each("wrong", [{"release": "2"}, {"previous": 1.5}, {"unchanged": 0}, {"files": 1 << 70}, {"taken": []}])
def test_a_response_to_a_deploy_with_an_invalid_field(wrong: dict[str, Any], project: Manifest) -> None:
    reply = b"".join(map(wire.message_frame, ({"need": []}, {"done": {**DEPLOYED, **wrong}})))
    message = protocol_error(FakeRobot(HELLO, reply), lambda robot: robot.deploy(project, REQUEST))
    assert message.startswith(NOT_THE_AGENT)


NEEDS: list[Any] = [
    {"need": ["robot.py", "secret.txt"]},
    {"need": ["../robot.py"]},
    {"need": ["robot.py", "robot.py"]},
    {"need": "robot.py"},
    {"need": [1]},
    {"need": [["robot.py"]]},
    {"need": None},
    {"phase": "compile"},
]


def test_contents_that_were_not_offered(project: Manifest) -> None:
    for need in NEEDS:
        robot = FakeRobot(HELLO, wire.message_frame(need))
        assert "'need'" in protocol_error(robot, lambda client: client.deploy(project, REQUEST)), need


def test_wheels_that_were_not_offered(project: Manifest) -> None:
    for need in ({"need": ["other.whl"], "bytes": 1}, {"need": ["robot.py", "robot.py"]}, {"need": 1}):
        session = AgentClient.start(FakeRobot(HELLO, wire.message_frame(need)))
        with pytest.raises(DeployError, match="not from pyfrc's agent"):
            session.install("a" * 16, "b" * 16, project, [1] * len(project.entries))


def test_a_phase_that_is_not_known_is_one_of_a_later_agent(project: Manifest) -> None:
    reply = b"".join(map(wire.message_frame, ({"need": []}, {"phase": "\x1b[2Jpolish"}, {"done": DEPLOYED})))
    phases: list[str] = []
    robot = AgentClient.start(FakeRobot(HELLO, reply))
    assert robot.deploy(project, REQUEST, lambda phase, done, total: phases.append(phase)).release == 2
    assert phases == ["\\x1b[2Jpolish"]


def test_what_is_sent_is_counted_only_until_the_robot_says_what_it_has(tmp_path: Path) -> None:
    """What is sent may still be on its way. Of a sign of life that says something else, nothing is shown."""
    project = project_of(tmp_path, {"robot.py": "", "a.bin": os.urandom(300_000)})
    odd, alive = ({"alive": each} for each in (True, {"phase": "receive", "count": 5, "of": 9}))
    signs = b"".join(map(wire.message_frame, (odd, alive)))
    robot = FakeRobot(HELLO, wire.message_frame({"need": ["a.bin"]}), wire.message_frame(odd), signs)
    robot._then = iter([wire.message_frame({"done": DEPLOYED})])
    seen: list[tuple[str, int, int]] = []
    AgentClient.start(robot).deploy(project, REQUEST, lambda *step: seen.append(step))
    (first, total), *others = [(done, total) for phase, done, total in seen if phase == "send"]
    assert (0 < first < total, total, len(others)) == (True, 300_000, 1)
    assert seen[2:] == [("receive", 5, 9)]


def test_a_duplicate_response(project: Manifest) -> None:
    reply = b"".join(map(wire.message_frame, ({"need": []}, {"done": DEPLOYED}, {"done": DEPLOYED})))

    def do(robot: AgentClient) -> None:
        robot.deploy(project, REQUEST)
        robot.restart()

    assert "it sent a message without a request" in protocol_error(FakeRobot(HELLO, reply), do)


OTHERS: list[tuple[Callable[[AgentClient], object], object]] = [
    (lambda robot: robot.rollback(), {"release": 1, "previous": None, "changed": [1], "about": {}}),
    (lambda robot: robot.rollback(), {"release": 1, "previous": None, "changed": [], "about": []}),
    (lambda robot: robot.undeploy(), {"removed": "yes"}),
    (lambda robot: robot.undeploy(), 1),
    (lambda robot: robot.restart(), "done"),
    (lambda robot: robot.watch(1.0), {}),
    (lambda robot: robot.watch(1.0), STATE),
    (lambda robot: robot.watch(1.0), {**STATE, "verdict": "\x1b[2J"}),
    (lambda robot: robot.watch(1.0), {**STATE, "verdict": ["running"]}),
    (lambda robot: robot.watch(1.0), {**STATE, "verdict": "running", "seconds": float("nan")}),
    (lambda robot: robot.watch(1.0), {**STATE, "verdict": "running", "age": float("inf")}),
    (lambda robot: robot.watch(1.0), {**STATE, "verdict": "running", "cpu": -1}),
    (lambda robot: robot.watch(1.0), {**STATE, "verdict": "running", "network_tables": 1}),
    (lambda robot: robot.info(), {}),
    (lambda robot: robot.plan(Manifest(())), {"added": [], "changed": 1, "removed": [], "files": 0, "bytes": 0}),
    (lambda robot: robot.plan(Manifest(())), {"added": [], "changed": [], "removed": [], "files": -1, "bytes": 0}),
]


def test_other_responses_with_an_invalid_field() -> None:
    for op, response in OTHERS:
        message = protocol_error(FakeRobot(HELLO, wire.message_frame({"done": response})), op)
        assert message.startswith(NOT_THE_AGENT), response


# -- without end -------------------------------------------------------------------------------------------------------


def for_ever(*frames: dict[str, Any]) -> Iterator[bytes]:
    while True:
        yield from map(wire.message_frame, frames)


@for_each("frame", [{"alive": True}, {"output": "x" * 100_000}, {"output": ""}])
def test_frames_without_an_end(frame: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(agent_stream, "MAX_FRAMES", 100)
    tracemalloc.start()
    try:
        message = protocol_error(FakeRobot(HELLO, then=for_ever(frame)), lambda robot: robot.watch(3600.0))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert "no response" in message
    assert peak < 10_000_000


def test_the_connection_is_closed_afterwards() -> None:
    robot = FakeRobot(FRAMES["a list"])
    protocol_error(robot)
    assert robot.closed
