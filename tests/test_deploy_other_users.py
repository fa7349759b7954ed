"""Files of the robot's other users among the program's files: errors explain them, and later deploys work."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path

import pytest
from roborio import Roborio, require_roborio
from roborio.local import project_of
from roborio.ssh import SshConnection

from pyfrc_core.deploy.agent_client import AgentClient, Deployed, DeployRequest
from pyfrc_core.deploy.errors import RefusedError

ADMIN = 0
ROBOT = "import wpilib\n\n\nclass Robot(wpilib.TimedRobot):\n    NUMBER = {number}\n"


@pytest.fixture
def roborio() -> Generator[Roborio]:
    require_roborio()
    with Roborio() as roborio:
        yield roborio


def deploy(roborio: Roborio, directory: Path, number: int) -> Deployed:
    project = project_of(directory, {"robot.py": ROBOT.format(number=number)})
    with SshConnection(roborio.host, roborio.port, "lvuser") as connection:
        robot = AgentClient.start(connection)
        try:
            deployed = robot.deploy(project, DeployRequest("robot.py", {}))
        finally:
            robot.close()
            roborio.wait_for_end_of_deploy()
    return deployed


def test_a_directory_that_cannot_be_moved_is_refused_before_anything_is_changed(
    roborio: Roborio, tmp_path: Path
) -> None:
    roborio.put("home/lvuser/py/robot.py", "# by hand\n", owner=ADMIN)
    roborio.put("home/lvuser/robotCommand", "python3 /home/lvuser/py/robot.py\n")
    roborio.run("chown", "-R", "admin", "/home/lvuser/py")
    for act in (lambda: undeploy(roborio), lambda: deploy(roborio, tmp_path, 1)):
        with pytest.raises(RefusedError, match="/home/lvuser/py belongs to another user of the robot") as caught:
            act()
        assert (roborio.home / "robotCommand").read_text() == "python3 /home/lvuser/py/robot.py\n"
        assert (roborio.home / "py/robot.py").read_text() == "# by hand\n"
    assert caught.value.remedy is not None
    command = caught.value.remedy.partition(": ")[2].split()
    assert roborio.run(*command).returncode == 0
    assert deploy(roborio, tmp_path, 1).taken == 1


def undeploy(roborio: Roborio) -> bool:
    with SshConnection(roborio.host, roborio.port, "lvuser") as connection:
        robot = AgentClient.start(connection)
        try:
            return robot.undeploy()
        finally:
            robot.close()
            roborio.wait_for_end_of_deploy()


@pytest.mark.slow
def test_a_read_only_directory_of_the_program_is_removed(roborio: Roborio, tmp_path: Path) -> None:
    for number in range(1, 6):
        deploy(roborio, tmp_path, number)
        assert roborio.run("mkdir", "-p", "/home/lvuser/py/photos/old", user="lvuser").returncode == 0
        roborio.run("touch", "/home/lvuser/py/photos/old/a.jpg", user="lvuser")
        roborio.run("chmod", "-R", "a-w", "/home/lvuser/py/photos", user="lvuser")
        # The trash of an earlier deploy is gone as well.
        assert sorted(each.name for each in (roborio.home / ".pyfrc").iterdir()) == ["lock", "releases"]
    roborio.run("chmod", "555", "/home/lvuser/.pyfrc/releases/5", user="lvuser")
    assert undeploy(roborio)
    assert not (roborio.home / "py").exists()
    assert not (roborio.home / ".pyfrc").exists()


def test_files_of_other_users_prevent_neither_an_undeploy_nor_the_next_deploy(roborio: Roborio, tmp_path: Path) -> None:
    deploy(roborio, tmp_path, 1)
    roborio.put("home/lvuser/py/photos/robot.jpg", "a picture", owner=ADMIN)
    roborio.run("chown", "admin", "/home/lvuser/py/photos")
    for _ in range(2):
        undeploy(roborio)
        assert not (roborio.home / "py").exists()
        assert (roborio.home / ".pyfrc/trash-1/photos/robot.jpg").read_text() == "a picture"
    assert deploy(roborio, tmp_path, 2).release == 1
    assert "NUMBER = 2" in (roborio.home / "py/robot.py").read_text()
    roborio.run("chown", "lvuser", "/home/lvuser/.pyfrc/trash-1/photos")
    deploy(roborio, tmp_path, 3)
    assert not (roborio.home / ".pyfrc/trash-1").exists()
