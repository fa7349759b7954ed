"""After a lost connection, the robot starts the complete old or new program, and the next deploy works.

Cuts of power are in `core/test_agent_power_cuts`, at each step of the agent on the disk.
"""

from __future__ import annotations

import contextlib
from collections import defaultdict
from pathlib import Path

import pytest
from conftest import sampled
from roborio.local import ROBOT_PY, Disk, LocalRobot, project_of

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
#: What the program has written beside its code: it is there before and after.
WRITTEN: Files = {"log.txt": b"1\n2\n", "state/odometer": b"17"}


#: By controller and scenario, the disks on which a deploy after a cut was seen to work.
_DEPLOYED_AGAIN: dict[tuple[str, str], set[Disk]] = defaultdict(set)


class Scenario:
    """A robot as it is before a deploy, the deploy, and the programs that may be there after it."""

    def __init__(self, name: str, directory: Path, controller: ControllerKind) -> None:
        self._directory = directory
        self._before = LocalRobot.new(directory / "before", controller)
        self.project: Manifest = project_of(directory / "new", NEW)
        self.old, self.new = None, NEW
        if name != "first":
            self._before.deploy(project_of(directory / "old", OLD))
            for path, content in WRITTEN.items():
                file = self._before.home / "py" / path
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(content)
            self.old, self.new = {**OLD, **WRITTEN}, {**NEW, **WRITTEN}
        whole = self.robot()
        whole.deploy(self.project)
        assert whole.startable() == self.new
        self.channel = whole.channel
        self._deployed_again = _DEPLOYED_AGAIN[controller.name, name]

    def robot(self) -> LocalRobot:
        """The robot as it was before."""
        return self._before.copy(self._directory / "robot")

    def check(self, **cut: int) -> bool:
        """Deploy, be cut, and look; then deploy again. Whether the new program was in place after the cut already.

        Many cuts leave the same on the disk. What the next deploy does there is seen once.
        """
        robot = self.robot()
        with contextlib.suppress(DeployError):
            robot.deploy(self.project, **cut)
        started = robot.startable()
        assert started in (self.old, self.new), f"after {cut}, neither the old nor the new program would be started"
        disk = robot.disk()
        if disk in self._deployed_again:
            return started == self.new
        self._deployed_again.add(disk)
        robot.deploy(self.project)
        assert robot.startable() == self.new, f"after {cut}, and another deploy"
        assert {each.name for each in (robot.home / ".pyfrc").iterdir()} == {"lock", "releases"}
        assert not list(robot.home.glob(".*.new"))
        return started == self.new


#: Each scenario on one of the controllers, with the connection cut on the way to the robot, and back.
CASES = [(*case, way) for case in (("update", CONTROLLERS[0]), ("first", CONTROLLERS[1])) for way in ("from", "to")]


@pytest.mark.parametrize(
    ("name", "controller", "way"),
    sampled(CASES, CASES[0]),
    ids=lambda each: getattr(each, "name", each),
)
def test_cut_after_every_kth_byte(name: str, controller: ControllerKind, way: str, in_memory: Path) -> None:
    """More than 300 places in all, the last of them within the last bytes."""
    scenario = Scenario(name, in_memory, controller)
    total = scenario.channel.bytes_to_robot if way == "to" else scenario.channel.bytes_from_robot
    places = [total * number // 80 for number in range(80)] + [total - 1]
    assert len(set(places)) == 81
    outcomes = [scenario.check(**{f"cut_{way}_robot": place}) for place in places]
    assert not outcomes[0]
    if way == "from":
        assert outcomes[-1], "the last byte comes when all is done"
