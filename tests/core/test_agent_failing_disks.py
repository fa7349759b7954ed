"""A disk that is full or read-only from any step on: the robot keeps the old program or has the new one, complete."""

from __future__ import annotations

import errno
import shutil
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from conftest import sampled

from pyfrc_core.deploy.agent import serve
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.environment_files import EnvironmentFiles
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.integrity import different_in_release
from pyfrc_core.deploy.agent.releases import Releases
from pyfrc_core.deploy.agent.robot_paths import Refusal
from pyfrc_core.deploy.agent.wire import Message
from pyfrc_core.deploy.targets import CONTROLLERS, ControllerKind
from pyfrc_core.deploy.targets.roborio import ROBORIO

from .agent_disk import AgentDisk, run_quickly
from .failing_disk import FAILS, failing
from .test_agent_power_cuts import (
    FIRST,
    ONE,
    RENAMED,
    SECOND,
    TWO,
    WHEELS,
    Program,
    deploy,
    packages_of,
    started,
)

#: Whatever fails, the agent ends what it has started, and closes it.
pytestmark = pytest.mark.filterwarnings("error::ResourceWarning", "error::pytest.PytestUnraisableExceptionWarning")

#: What is done to a robot; it returns what the agent says.
Act = Callable[[AgentDisk], list[Message]]


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(EnvironmentFiles, "_run", run_quickly)
    monkeypatch.setattr("pyfrc_core.deploy.agent.disk.flush", lambda directory: None)
    monkeypatch.setattr(RealRobot, "stop", lambda robot, start, meanwhile=None: False)
    monkeypatch.setattr(RealRobot, "processes", lambda robot: set())
    monkeypatch.setattr(serve, "look_up", lambda modules: {"packages": {}})  # this Python has hundreds


def sending(files: dict[str, str], *contents: str, **more: object) -> Act:
    return lambda robot: robot.deploy(files, *contents, restart=True, **more)


def installing(environment: str) -> Act:
    def act(robot: AgentDisk) -> list[Message]:
        try:
            robot.install(environment, WHEELS[environment])
        except (OSError, Refusal) as error:
            return [{"error": "disk", "message": str(error)}]
        return [{"done": {}}]

    return act


def asking(request: Message) -> Act:
    return lambda robot: robot.ask(request)


def two_releases(robot: AgentDisk) -> None:
    deploy(robot, ONE)
    deploy(robot, RENAMED)


#: What is on the robot, what is done, and the programs that may be started afterwards; None: none.
ACTS: dict[str, tuple[Callable[[AgentDisk], object], Act, tuple[Program | None, ...]]] = {
    "first deploy": (lambda robot: None, sending(ONE, *ONE.values()), (None, (ONE, {}))),
    "update": (partial(deploy, files=ONE), sending(TWO, TWO["robot.py"], TWO["new.py"]), ((ONE, {}), (TWO, {}))),
    "another main file": (
        partial(deploy, files=ONE),
        sending(RENAMED, RENAMED["main.py"], main="main.py"),
        ((ONE, {}), (RENAMED, {})),
    ),
    "same files": (partial(deploy, files=ONE), sending(ONE, debug=True), ((ONE, {}),)),
    "rollback": (two_releases, asking({"op": "rollback", "release": 1}), ((RENAMED, {}), (ONE, {}))),
    "undeploy": (two_releases, asking({"op": "undeploy"}), ((RENAMED, {}), None)),
    "restart": (two_releases, asking({"op": "restart"}), ((RENAMED, {}),)),
    "packages": (
        partial(deploy, files=ONE, environment=FIRST),
        installing(SECOND),
        ((ONE, packages_of(FIRST)),),
    ),
    "other packages": (
        lambda robot: (deploy(robot, ONE, FIRST), robot.install(SECOND, WHEELS[SECOND])),
        sending(TWO, TWO["robot.py"], TWO["new.py"], environment=SECOND),
        ((ONE, packages_of(FIRST)), (TWO, packages_of(SECOND))),
    ),
}


#: Each of them on both controllers, and with both errors: the one on this, the other on that.
CASES = [
    (name, controller, number)
    for place, name in enumerate(ACTS)
    for controller, number in zip(CONTROLLERS, FAILS if place % 2 else reversed(FAILS), strict=True)
]


@pytest.mark.parametrize(
    ("name", "controller", "number"),
    sampled(CASES, ("update", ROBORIO, errno.ENOSPC), ("same files", CONTROLLERS[1], errno.ENOSPC)),
    ids=lambda each: errno.errorcode.get(each) if isinstance(each, int) else getattr(each, "name", each),
)
def test_any_step(
    name: str, controller: ControllerKind, number: int, in_memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before, act, expected = ACTS[name]
    robot = AgentDisk(in_memory / "robot", controller.layout)
    before(robot)
    environment = SECOND if "packages" in name else None
    root, first, has_failed = in_memory / "after", 0, True
    while has_failed:
        first += 1
        shutil.rmtree(root, ignore_errors=True)
        shutil.copytree(robot.root, root, symlinks=True)
        after = AgentDisk(root, controller.layout)
        with failing(number, first, monkeypatch) as disk:
            said = act(after)
        has_failed = disk.has_failed
        when = f"from step {first} on: {said}"
        assert said, when
        assert all(each.get("error") in (None, "space", "disk") for each in said), when
        assert started(after, controller) in expected, when
        kept = Releases(after.places, Activity(lambda **said: None))
        assert not any(different_in_release(kept, each) for each in kept.numbers()), when
        deploy(after, TWO, environment)
        assert started(after, controller) == (TWO, packages_of(environment)), f"{when}, and a deploy"
    assert first > 5
