"""After any interruption, the robot starts the complete old or new program, and the next deploy works."""

from __future__ import annotations

import contextlib
import itertools
from collections import defaultdict
from collections.abc import Generator
from pathlib import Path

import pytest
from conftest import sampled
from roborio.local import ROBOT_PY, Agents, Disk, LocalRobot, directory_in_memory, project_of

from pyfrc_core.deploy.agent_client import AgentClient
from pyfrc_core.deploy.errors import DeployError
from pyfrc_core.deploy.manifest import Manifest
from pyfrc_core.deploy.targets import CONTROLLERS, ControllerKind

Files = dict[str, bytes]

KEPT = b"x = 1\n" * 20
OLD: Files = {
    "robot.py": ROBOT_PY.encode(),
    "sub/kept.py": KEPT,
    "sub/gone.py": b"y = 1\n",
    "a.bin": bytes(range(256)) * 8,
}
NEW: Files = {
    **OLD,
    "robot.py": b"# new\n" + ROBOT_PY.encode(),
    "new.py": b"z = 1\n",
    "b.bin": bytes(range(255, -1, -1)) * 8,
}
del NEW["sub/gone.py"]
#: The new program under another name, so that the start command changes with it.
RENAMED: Files = {**NEW, "my_robot.py": NEW["robot.py"]}
del RENAMED["robot.py"]
#: What the program has written beside its code: it is there before and after.
WRITTEN: Files = {"log.txt": b"1\n2\n", "state/odometer": b"17"}

SCENARIOS = ["first", "update", "renamed", "taken over"]
#: Cut at each step: by day, an update; by night, all.
SAMPLED_SCENARIOS = sampled(SCENARIOS, "update")

#: By controller and scenario, the disks on which a deploy after a cut was seen to work.
_DEPLOYED_AGAIN: dict[tuple[str, str], set[Disk]] = defaultdict(set)


@pytest.fixture(params=sampled(CONTROLLERS, CONTROLLERS[0]), ids=lambda each: each.name)
def controller(request: pytest.FixtureRequest) -> ControllerKind:
    return request.param


class Scenario:
    """A robot as it is before a deploy, the deploy, and the programs that may be there after it."""

    def __init__(self, name: str, directory: Path, agents: Agents, controller: ControllerKind) -> None:
        self._directory = directory
        self._agents = agents
        self._before = LocalRobot.new(directory / "before", controller)
        self.main = "my_robot.py" if name == "renamed" else "robot.py"
        new = RENAMED if name == "renamed" else NEW
        self.project: Manifest = project_of(directory / "new", new)
        written = {} if name == "first" else WRITTEN
        if name == "taken over":
            for path, content in OLD.items():
                self._write(path, content)
            layout = controller.layout
            command = layout.start.rstrip().replace("{main}", f"{layout.code}/robot.py")
            (self._before.home / layout.command).write_text(command)
        elif name != "first":
            self._before.deploy(agents, project_of(directory / "old", OLD))
        for path, content in written.items():
            self._write(path, content)
        self.old = None if name == "first" else {**OLD, **written}
        self.new = {**new, **written}
        whole = self.robot()
        whole.deploy(agents, self.project, main=self.main)
        assert whole.startable() == self.new
        self.channel = whole.channel
        self._deployed_again = _DEPLOYED_AGAIN[controller.name, name]

    def _write(self, path: str, content: bytes) -> None:
        file = self._before.home / "py" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)

    def robot(self) -> LocalRobot:
        """The robot as it was before."""
        return self._before.copy(self._directory / "robot")

    def check(self, **cut: int | bool) -> bool:
        """Deploy, be cut, and look; then deploy again. Whether the new program was in place after the cut already.

        Many cuts leave the same on the disk. What the next deploy does there is seen once.
        """
        robot = self.robot()
        with contextlib.suppress(DeployError):
            robot.deploy(self._agents, self.project, main=self.main, **cut)
        started = robot.startable()
        assert started in (self.old, self.new), f"after {cut}, neither the old nor the new program would be started"
        disk = robot.disk()
        if disk in self._deployed_again:
            return started == self.new
        self._deployed_again.add(disk)
        robot.deploy(self._agents, self.project, main=self.main)
        assert robot.startable() == self.new, f"after {cut}, and another deploy"
        assert {each.name for each in (robot.home / ".pyfrc").iterdir()} == {"lock", "releases"}
        assert not list(robot.home.glob(".*.new"))
        return started == self.new


@pytest.fixture
def directory() -> Generator[Path]:
    with directory_in_memory() as directory:
        yield directory


@pytest.mark.parametrize(
    ("name", "way"), sampled(itertools.product(["first", "update"], ["to", "from"]), ("update", "from"))
)
def test_cut_after_every_kth_byte(
    name: str, way: str, directory: Path, agents: Agents, controller: ControllerKind
) -> None:
    """More than 300 places in all, the last of them within the last bytes."""
    scenario = Scenario(name, directory, agents, controller)
    total = scenario.channel.bytes_to_robot if way == "to" else scenario.channel.bytes_from_robot
    places = [total * number // 80 for number in range(80)] + [total - 1]
    assert len(set(places)) == 81
    outcomes = [scenario.check(**{f"cut_{way}_robot": place}) for place in places]
    assert not outcomes[0]
    if way == "from":
        assert outcomes[-1], "the last byte comes when all is done"


@pytest.mark.slow
@pytest.mark.parametrize("name", SAMPLED_SCENARIOS)
def test_agent_killed_at_each_step(name: str, directory: Path, agents: Agents, controller: ControllerKind) -> None:
    """Killed: its last step is the one before; what it had written stays."""
    scenario = Scenario(name, directory, agents, controller)
    assert scenario.channel.steps is not None
    outcomes = [scenario.check(last_step=step) for step in range(1, scenario.channel.steps + 1)]
    assert outcomes == sorted(outcomes), "once the new program is in place it stays there"
    assert {True, False} == set(outcomes)


@pytest.mark.parametrize("name", SAMPLED_SCENARIOS)
def test_power_lost_at_each_step(name: str, directory: Path, agents: Agents, controller: ControllerKind) -> None:
    """As killed; and what was written since the disk was last flushed is lost, while names have changed."""
    scenario = Scenario(name, directory, agents, controller)
    assert scenario.channel.steps is not None
    outcomes = [scenario.check(last_step=step, loses=True) for step in range(1, scenario.channel.steps + 1)]
    assert outcomes == sorted(outcomes)
    assert {True, False} == set(outcomes)


@contextlib.contextmanager
def agent(robot: LocalRobot, agents: Agents, **options: int | bool) -> Generator[AgentClient]:
    session = robot.start(agents, **options)
    try:
        yield session
    finally:
        session.close()


@pytest.mark.slow
@pytest.mark.parametrize("loses", sampled([False, True], True))
def test_rollback_killed_at_each_step(directory: Path, agents: Agents, controller: ControllerKind, loses: bool) -> None:
    """From a program with another start command, and with files that it has written."""
    before = LocalRobot.new(directory / "before", controller)
    before.deploy(agents, project_of(directory / "old", OLD))
    before.deploy(agents, project_of(directory / "renamed", RENAMED), main="my_robot.py")
    (before.home / "py/log.txt").write_bytes(b"1\n2\n")
    new, old = before.startable(), {**OLD, "log.txt": b"1\n2\n"}
    step, outcomes = 0, []
    while True:
        step += 1
        robot = before.copy(directory / "robot")
        ended = False
        with contextlib.suppress(DeployError), agent(robot, agents, last_step=step, loses=loses) as session:
            ended = session.rollback().release.number == 1
        started = robot.startable()
        assert started in (old, new)
        outcomes.append(started == old)
        with agent(robot, agents) as session:
            session.rollback(1)
        assert robot.startable() == old
        if ended:
            break
    assert outcomes == sorted(outcomes)
    assert {True, False} == set(outcomes)


@pytest.mark.slow
def test_undeploy_killed_at_each_step(directory: Path, agents: Agents, controller: ControllerKind) -> None:
    """The robot starts the program, or nothing; and can be deployed to."""
    before = LocalRobot.new(directory / "before", controller)
    project = project_of(directory / "old", OLD)
    before.deploy(agents, project)
    step, ended = 0, False
    while not ended:
        step += 1
        robot = before.copy(directory / "robot")
        with contextlib.suppress(DeployError), agent(robot, agents, last_step=step) as session:
            ended = session.undeploy()
        assert robot.startable() in (OLD, None)
        robot.deploy(agents, project)
        assert robot.startable() == OLD
    assert step > 10
