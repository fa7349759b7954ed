"""Deploys that are interrupted between the switch and the program's start: the error explains the state. The lock."""

from __future__ import annotations

import contextlib
import io
import socket
import zlib
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, LocalRobot, project_of
from test_deploy_lock import is_held

from pyfrc_core.deploy import recovery_hints, target_connection
from pyfrc_core.deploy.agent import serve, wire
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.agent_client import AgentClient, DeployRequest
from pyfrc_core.deploy.errors import ConnectionFailedError, DeployError, RefusedError, StoppedError
from pyfrc_core.deploy.manifest import Manifest
from pyfrc_core.deploy.recovery_hints import explain_interruption
from pyfrc_core.deploy.targets.roborio import ROBORIO

REQUEST = DeployRequest("robot.py", {})


@pytest.fixture
def project(tmp_path: Path) -> Manifest:
    return project_of(tmp_path / "project", {"robot.py": ROBOT_PY})


def interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def interrupt_after(do: Callable[[AgentClient, Manifest], object], agent: AgentClient, project: Manifest) -> None:
    with explain_interruption(agent):
        do(agent, project)
        interrupt()


def refuse(agent: AgentClient, project: Manifest) -> None:
    with pytest.raises(RefusedError):
        agent.rollback(77)


def in_switch(phase: str, done: int, total: int) -> None:
    if phase == "switch":
        interrupt()


#: The actions before the interruption, the state in the message, and the suggested command.
CUT_SHORT: dict[str, tuple[Callable[[AgentClient, Manifest], object], str, str]] = {
    "switching": (
        lambda agent, project: agent.deploy(project, REQUEST, in_switch),
        "may already run the new one",
        "pyfrc deploy.",
    ),
    "deployed": (
        lambda agent, project: agent.deploy(project, REQUEST),
        "release 2 is on the robot, which will start it when it is switched on, but may still run the previous program",
        "pyfrc deploy. Or go back to the previous release: pyfrc deploy --rollback.",
    ),
    "restarted": (
        lambda agent, project: (agent.deploy(project, REQUEST), agent.restart()),
        "release 2 was started, but not confirmed to run",
        "pyfrc deploy-info. To go back to the previous release: pyfrc deploy --rollback.",
    ),
    "went back": (
        lambda agent, project: (agent.deploy(project, REQUEST), agent.rollback()),
        "the robot will start release 1 when it is switched on, but may still run the previous program",
        "pyfrc deploy --rollback 1.",
    ),
}


@pytest.mark.parametrize("moment", CUT_SHORT)
def test_ctrl_c_explains_the_robots_state(moment: str, robot: LocalRobot, project: Manifest, tmp_path: Path) -> None:
    robot.deploy(project)
    do, what, remedy = CUT_SHORT[moment]
    agent = robot.start()
    second = project_of(tmp_path / "project", {"robot.py": ROBOT_PY + "# 2\n"})
    with contextlib.closing(agent), pytest.raises(StoppedError) as caught:
        interrupt_after(do, agent, second)
    assert caught.value.exit_code == 2
    assert caught.value.message.startswith("interrupted; ")
    assert what in caught.value.message
    assert remedy in str(caught.value.remedy)


def test_a_command_about_a_robot_explains_its_interruption(monkeypatch: pytest.MonkeyPatch) -> None:
    robot: Any = SimpleNamespace(recovery_hint=None, close=lambda: None)
    monkeypatch.setattr(target_connection, "find", lambda *asked: None)
    monkeypatch.setattr(target_connection, "connected", lambda *asked: nullcontext(SimpleNamespace()))
    monkeypatch.setattr(target_connection, "_start_agent", lambda *asked: robot)
    asked: Any = [None] * 3

    def deploy() -> None:
        with target_connection.connected_agent(*asked):
            robot.recovery_hint = recovery_hints.deployed(1, None)
            interrupt()

    with pytest.raises(StoppedError, match=r"^interrupted; release 1 is on the robot"):
        deploy()
    for hint in (recovery_hints.deployed(1, None), recovery_hints.started(1, None)):
        assert "--rollback" not in hint.remedy, "there is no way back"


@pytest.mark.parametrize(
    ("error", "code"),
    [(ConnectionFailedError("the connection to the robot was lost"), 4), (KeyboardInterrupt(), 2)],
    ids=["connection", "Ctrl-C"],
)
def test_an_end_before_the_robots_list_arrives_may_come_after_the_switch(
    error: BaseException, code: int, robot: LocalRobot, project: Manifest
) -> None:
    """The robot needs no contents of an unchanged project: it switches and restarts without waiting."""
    robot.deploy(project)
    with contextlib.closing(robot.start()) as session:

        def read_message(parse: object) -> None:
            session._stream.read_response(lambda fields: None, lambda fields: None)  # until the robot has switched
            raise error

        session._stream.read_message = read_message  # type: ignore[method-assign,assignment]
        with pytest.raises(DeployError) as caught, explain_interruption(session):
            session.deploy(project, DeployRequest("robot.py", {}, restart=True))
    assert caught.value.exit_code == code
    assert "the robot may have switched to the new release" in caught.value.message
    assert "it may already run the new one" in caught.value.message


@pytest.mark.parametrize(
    "do",
    [
        lambda agent, project: agent.plan(project),
        lambda agent, project: (agent.deploy(project, REQUEST), agent.restart(), agent.watch(0.0)),
        lambda agent, project: agent.undeploy(),
        refuse,
    ],
    ids=["plan", "watched", "undeployed", "refused"],
)
def test_where_nothing_is_half_done_ctrl_c_is_just_that(
    do: Callable[[AgentClient, Manifest], object], robot: LocalRobot, project: Manifest
) -> None:
    robot.deploy(project)
    agent = robot.start()
    with contextlib.closing(agent), pytest.raises(KeyboardInterrupt):
        interrupt_after(do, agent, project)


# -- the lock ----------------------------------------------------------------------------------------------------------


def test_the_lock_is_held_until_the_program_was_started_and_watched(
    robot: LocalRobot, project: Manifest, tmp_path: Path
) -> None:
    agent = robot.start()
    with contextlib.closing(agent):
        agent.deploy(project, REQUEST)
        assert is_held(robot.home / ".pyfrc/lock")
        agent.restart()
        assert is_held(robot.home / ".pyfrc/lock")
        agent.watch(0.0)
        assert not is_held(robot.home / ".pyfrc/lock")
        agent.deploy(project_of(tmp_path / "project", {"robot.py": ROBOT_PY + "# 2\n"}), REQUEST)
        agent.rollback()
        assert is_held(robot.home / ".pyfrc/lock")
        agent.restart()
        agent.watch(0.0)
        assert not is_held(robot.home / ".pyfrc/lock")
        agent.deploy(project, REQUEST)
        with pytest.raises(RefusedError):
            agent.rollback(77)
        assert not is_held(robot.home / ".pyfrc/lock"), "nothing is going to be started"
        agent.deploy(project, REQUEST)
        assert is_held(robot.home / ".pyfrc/lock")
    assert not is_held(robot.home / ".pyfrc/lock"), "it goes with the connection"


def test_a_silent_laptop_counts_as_disconnected_while_it_holds_the_lock(robot: LocalRobot) -> None:
    """A command may wait for its user only after the watch, when the lock is free."""

    class LoggingWire(wire.Wire):
        def receive(self) -> wire.Message:
            limited.append(self.limits_silence)
            return super().receive()

    limited: list[bool] = []
    ours, theirs = socket.socketpair()
    nothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"  # SHA-256
    with ours, theirs, theirs.makefile("rb", buffering=0) as source:
        for data in (
            wire.message_frame({"op": "deploy", "main": "robot.py", "files": [["robot.py", 0, nothing, False]]}),
            wire.frame(wire.CONTENT, zlib.compress(b"")),
            *(wire.message_frame(each) for each in ({"op": "restart"}, {"op": "watch", "seconds": 0.0})),
        ):
            ours.sendall(data)
        ours.shutdown(socket.SHUT_WR)
        there = RealRobot(RobotPaths(ROBORIO.layout, str(robot.root)))
        serve.Agent(LoggingWire(source, io.BytesIO()), there, {}).serve()
    assert limited == [False, True, True, False]
