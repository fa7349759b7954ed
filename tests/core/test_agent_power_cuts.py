"""A power cut at any step, on a disk that loses what was not synced, leaves the old or the new program, complete."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol

import pytest
from conftest import sampled
from roborio.local import LocalRobot

from pyfrc_core.deploy.agent import releases
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.environment_files import EnvironmentFiles
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.integrity import different_in_release
from pyfrc_core.deploy.agent.releases import Releases
from pyfrc_core.deploy.targets import ControllerKind
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE

from .agent_disk import PACKAGES, AgentDisk, run_quickly
from .lossy_disk import noted

Files = Mapping[str, str]
#: A program's files, and its packages' files, if they are pyfrc's.
Program = tuple[Files, Files]
ONE = {"robot.py": "# one\n", "arm.py": "A = 1\n", "data/a.txt": "a"}
TWO = {**ONE, "robot.py": "# two\n", "new.py": "B = 1\n"}
RENAMED = {"main.py": "# renamed\n", "arm.py": "A = 1\n"}
FIRST, SECOND = (f"{number:016x}" for number in (1, 2))
WHEELS = {
    name: {"kept-1.whl": {"kept.py": "A = 1\n"}, "spinner-1.whl": {"spinner.py": f"V = {name[-1]}\n"}}
    for name in (FIRST, SECOND)
}


def packages_of(environment: str | None) -> Files:
    return (
        {}
        if environment is None
        else {name: text for each in WHEELS[environment].values() for name, text in each.items()}
    )


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(EnvironmentFiles, "_run", run_quickly)
    monkeypatch.setattr("pyfrc_core.deploy.agent.disk.flush", lambda directory: None)


def deploy(robot: AgentDisk, files: Files, environment: str | None = None) -> None:
    if environment is not None:
        robot.install(environment, WHEELS[environment])
    main = "main.py" if "main.py" in files else "robot.py"
    *_, last = robot.deploy(files, *robot.needed(files), main=main, environment=environment)
    assert "done" in last, last


def started(robot: AgentDisk, controller: ControllerKind) -> Program | None:
    """What the robot would start: each file of it is complete."""
    files = LocalRobot(robot.root, controller).startable()
    if files is None:
        return None
    (python,) = (word for word in robot.places.start_command().split() if word.endswith("/bin/python3"))
    place = robot.places.of(python).parents[1]
    packages = {}
    if (place / "environment.json").exists():
        packages = {each.name: each.read_text() for each in (place / PACKAGES).glob("*.py")}
        assert place.resolve().name not in robot.environments.damaged(), "the packages are not complete"
    return {name: content.decode() for name, content in files.items()}, packages


class Check(Protocol):
    """Do something on a robot, and look at what power cuts leave."""

    def __call__(
        self,
        controller: ControllerKind,
        act: Callable[[AgentDisk], object],
        old: Program | None,
        new: Program | None,
        environment: str | None = None,
    ) -> None: ...


@pytest.fixture
def check(in_memory: Path, pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch) -> Check:
    """By day, a deploy after that is tried after some of the power cuts: it takes most of the time."""
    every = 1 if pytestconfig.getoption("run_slow") else 9

    def check_all_cuts(
        controller: ControllerKind,
        act: Callable[[AgentDisk], object],
        old: Program | None,
        new: Program | None,
        environment: str | None = None,
    ) -> None:
        robot = AgentDisk(in_memory / "robot", controller.layout)
        with noted(robot.root, monkeypatch) as disk:
            act(robot)
        assert started(robot, controller) == new
        outcomes = set()
        for number, state in enumerate(disk.states):
            state.write(in_memory / "after")
            after = AgentDisk(in_memory / "after", controller.layout)
            found = started(after, controller)
            assert found in (old, new), "neither the old nor the new program would be started"
            outcomes.add(found == new)
            kept = Releases(after.places, Activity(lambda **said: None))
            assert not any(different_in_release(kept, number) for number in kept.numbers()), "a release is incomplete"
            if number % every == 0:
                deploy(after, TWO, environment)
                assert started(after, controller) == (TWO, packages_of(environment)), "a deploy after that fails"
        assert outcomes == {True, False}

    return check_all_cuts


@pytest.mark.parametrize(
    "controller", [ROBORIO, pytest.param(SYSTEMCORE, marks=pytest.mark.slow)], ids=lambda each: each.name
)
@pytest.mark.parametrize("files", [TWO, RENAMED], ids=["update", "another main file"])
def test_deploys(in_memory: Path, controller: ControllerKind, files: Files, check: Check) -> None:
    deploy(AgentDisk(in_memory / "robot", controller.layout), ONE)
    check(controller, lambda robot: deploy(robot, files), (ONE, {}), (files, {}))


@pytest.mark.slow
def test_the_first_deploy(check: Check) -> None:
    check(ROBORIO, lambda robot: deploy(robot, ONE), None, (ONE, {}))


@pytest.mark.parametrize("exchanges", sampled([True, False], True))
def test_another_tools_program_is_taken_over(
    in_memory: Path, exchanges: bool, check: Check, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = AgentDisk(in_memory / "robot", ROBORIO.layout)
    if not exchanges:  # as before Linux 3.15
        monkeypatch.setattr(releases, "exchange", lambda one, other: False)
    robot.places.code.mkdir()
    (robot.places.code / "robot.py").write_text("# theirs\n")
    start = ROBORIO.layout.start.replace("{main}", f"{ROBORIO.layout.code}/robot.py")
    (robot.home / ROBORIO.layout.command).write_text(start)
    theirs = {"robot.py": "# theirs\n"}
    check(ROBORIO, lambda robot: deploy(robot, ONE), (theirs, {}), (ONE, {}))


@pytest.mark.slow
def test_a_rollback(in_memory: Path, check: Check) -> None:
    robot = AgentDisk(in_memory / "robot", SYSTEMCORE.layout)
    deploy(robot, ONE)
    deploy(robot, RENAMED)
    back = {"op": "rollback", "release": 1}
    check(SYSTEMCORE, lambda robot: robot.ask(back), (RENAMED, {}), (ONE, {}))


@pytest.mark.slow
def test_an_undeploy(in_memory: Path, check: Check, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(RealRobot, "stop", lambda host, start: False)
    deploy(AgentDisk(in_memory / "robot", ROBORIO.layout), ONE)
    undeploy = {"op": "undeploy"}
    check(ROBORIO, lambda robot: robot.ask(undeploy), (ONE, {}), None)


def test_other_packages(in_memory: Path, check: Check) -> None:
    robot = AgentDisk(in_memory / "robot", ROBORIO.layout)
    deploy(robot, ONE, FIRST)

    def act(robot: AgentDisk) -> None:
        deploy(robot, TWO, SECOND)

    old, new = (ONE, packages_of(FIRST)), (TWO, packages_of(SECOND))
    check(ROBORIO, act, old, new, SECOND)


def test_while_damaged_files_are_replaced(in_memory: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each file is the damaged or the good one, and another attempt works."""
    robot = AgentDisk(in_memory / "robot", SYSTEMCORE.layout)
    deploy(robot, ONE, FIRST)
    place = robot.environments.directory(FIRST)
    file = place / PACKAGES / "kept.py"
    file.chmod(0o644)
    file.write_text("broken")
    (place / "pyvenv.cfg").unlink()
    with noted(robot.root, monkeypatch) as disk:
        assert robot.install(FIRST, WHEELS[FIRST]) == ["kept-1.whl"]
    seen = set()
    for state in disk.states:
        state.write(robot.root)
        after = AgentDisk(robot.root, SYSTEMCORE.layout)
        seen.add((after.environments.directory(FIRST) / PACKAGES / "kept.py").read_text())
        after.install(FIRST, WHEELS[FIRST])
        assert after.environments.damaged() == {}
        assert started(after, SYSTEMCORE) == (ONE, packages_of(FIRST))
    assert seen == {"broken", "A = 1\n"}
