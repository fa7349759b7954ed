"""What the agent does around a deploy: restarts and watches, the laptop's progress, which releases stay, cuts."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from pyfrc_core.deploy.agent import disk, host, robot_paths, transaction
from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.content_index import ContentIndex
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.release_record import parse_record
from pyfrc_core.deploy.agent.releases import Releases
from pyfrc_core.deploy.agent.robot_paths import Lock, Refusal, RobotPaths
from pyfrc_core.deploy.targets.roborio import ROBORIO

from .agent_disk import AgentDisk, manifest

ONE = {"robot.py": "# one\nimport arm\n", "arm.py": "# arm\n", "data/path.json": "{}"}


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AgentDisk:
    """A robot with an empty disk, on which nothing has to wait for the disk."""
    monkeypatch.setattr(disk, "flush", lambda directory: None)
    return AgentDisk(tmp_path / "robot")


def numbered(robot: AgentDisk, *numbers: int) -> None:
    for number in numbers:
        robot.deploy({"robot.py": f"# {number}\n"}, f"# {number}\n")


def record(robot: AgentDisk, number: int) -> dict[str, Any]:
    return parse_record(robot.read(f".pyfrc/releases/{number}.json") or "")


def quiet(robot: AgentDisk) -> Releases:
    return Releases(robot.places, Activity(lambda **message: None))


# -- which releases stay -----------------------------------------------------------------------------------------------


def test_what_the_current_release_has_replaced_stays(robot: AgentDisk) -> None:
    numbered(robot, 1, 2, 3)
    robot.ask({"op": "rollback", "release": 1})
    numbered(robot, 4)
    assert record(robot, 4)["from"] == 1
    assert quiet(robot).numbers() == [1, 3, 4]
    numbered(robot, 5)
    assert quiet(robot).numbers() == [3, 4, 5]
    quiet(robot).prune(kept=1)
    assert quiet(robot).numbers() == [4, 5]  # what 4 has written after the switch is not carried over yet
    quiet(robot).carry_late_writes(5)
    quiet(robot).prune(kept=1)
    assert quiet(robot).numbers() == [5]


def test_a_switch_from_another_tools_program_that_was_cut_is_finished(robot: AgentDisk) -> None:
    numbered(robot, 1)
    robot.places.code.unlink()
    robot.places.code.mkdir()
    (robot.places.code / "robot.py").write_text("# other\n")
    command = robot.read("robotCommand") or ""
    (robot.home / "robotCommand").write_text(command.replace("/home/lvuser/py/", "/home/lvuser/.pyfrc/releases/1/"))
    quiet(robot).recover()
    assert robot.startable() == "py/robot.py: # 1"
    assert quiet(robot).current() == 1
    assert quiet(robot).numbers() == [1, 2]
    assert record(robot, 2)["taken"] is True
    assert robot.read(".pyfrc/releases/2/robot.py") == "# other\n"


def test_a_rollback_over_another_tools_program_keeps_that(robot: AgentDisk) -> None:
    numbered(robot, 1)
    robot.places.code.unlink()
    robot.places.code.mkdir()
    (robot.places.code / "robot.py").write_text("# other\n")
    (robot.places.code / "log.txt").write_text("written by it")
    (robot.home / "robotCommand").write_text("python3 --main /home/lvuser/py/robot.py run\n")
    (answer,) = robot.ask({"op": "rollback", "release": 1})
    assert answer["done"]["release"] == 1
    assert answer["done"]["previous"] is None
    assert robot.startable() == "py/robot.py: # 1"
    assert quiet(robot).numbers() == [1, 2]
    assert robot.read("py/log.txt") == "written by it"
    assert record(robot, 1)["carried"]["from"] == 2


def test_no_file_stays_open(robot: AgentDisk) -> None:
    numbered(robot, 1)
    before = open_files()
    numbered(robot, 2, 3)
    robot.ask({"op": "rollback"})
    robot.ask({"op": "plan", "files": manifest(ONE)})
    assert open_files() == before


def open_files() -> int:
    return len(list(Path("/proc/self/fd").iterdir())) if sys.platform == "linux" else 0


def test_undeploy_is_on_the_disk_before_the_program_is_stopped_and_when_it_is_done(
    robot: AgentDisk, monkeypatch: pytest.MonkeyPatch
) -> None:
    numbered(robot, 1)
    log: list[str] = []

    def note(what: str) -> None:
        there = [name for name in ("robotCommand", "py", ".pyfrc") if (robot.home / name).exists()]
        log.append(f"{what}: {' '.join(there)}")

    monkeypatch.setattr(disk, "flush", lambda directory: note(f"flush {directory.name}"))
    monkeypatch.setattr(RealRobot, "stop", lambda host, start: note("stop"))
    robot.ask({"op": "undeploy"})
    assert log == ["flush lvuser: py .pyfrc", "stop: py .pyfrc", "flush lvuser: "]


def test_the_process_that_a_restart_ends_has_not_crashed(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(RealRobot, "stop", lambda *asked, **more: False)
    numbered(robot, 1)
    quiet_releases = quiet(robot)
    quiet_releases.update_record(1, lambda record: {**record, "process": {"boot": "b", "id": 7}})
    quiet_releases.write_again()
    assert record(robot, 1)["process"] == {"boot": "b", "id": 7}
    robot.ask({"op": "restart"})
    assert record(robot, 1)["process"] is None


def test_while_another_computer_deploys_nothing_is_changed(robot: AgentDisk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot_paths, "_GRACE", 0.0)
    numbered(robot, 1, 2)
    before = robot.tree("")
    with Lock(robot.places, "ann@laptop"):
        for request in (
            {"op": "restart"},
            {"op": "rollback"},
            {"op": "undeploy"},
            {"op": "install", "environment": "a" * 16, "python": None, "wheels": []},
        ):
            (answer,) = robot.ask(request)
            assert answer["message"] == "ann@laptop is deploying to this robot right now", request
    assert robot.tree("") == before


# -- contents ----------------------------------------------------------------------------------------------------------


def test_a_file_that_is_changed_while_it_is_copied_is_refused(
    robot: AgentDisk, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot.deploy(ONE, *ONE.values())
    copies = {"arm.py": "# arm\n", "robot.py": "# two\n", "wrist.py": "# arm\n"}  # the wrist's is a copy of the arm's
    real = ContentIndex.copy

    def change(self: ContentIndex, wanted: Any) -> str | None:
        found = real(self, wanted)
        if found is not None and wanted.path == "wrist.py":
            changed = robot.root / "changed"
            changed.write_text("# changed\n")
            return str(changed)
        return found

    monkeypatch.setattr(ContentIndex, "copy", change)
    *_, answer = robot.deploy(copies, "# two\n")
    assert answer["message"] == "wrist.py was changed by the robot program during the deploy"
    assert robot.startable() == "py/robot.py: # one"
    monkeypatch.undo()
    with pytest.raises(Refusal):
        transaction._copy(None, transaction.parse_manifest(manifest(ONE))[0], robot.root / "x", Activity(print))


# -- processes of a roboRIO --------------------------------------------------------------------------------------------


def test_a_process_that_serves_network_tables(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        monkeypatch.setattr(host, "NETWORK_TABLES_PORT", server.getsockname()[1])
        assert RealRobot(RobotPaths(ROBORIO.layout)).serves_network_tables(os.getpid()) is True
        with socket.create_connection(server.getsockname()):
            pass
    assert RealRobot(RobotPaths(ROBORIO.layout)).serves_network_tables(os.getpid()) is False


def test_programs_are_known_by_their_command_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Below a directory of this test's own: no agent of another test takes them for its robot's.
    home = str(tmp_path)
    robot = RealRobot(RobotPaths(ROBORIO.layout._replace(home=home, code=f"{home}/py")))
    started: list[subprocess.Popen[bytes]] = []

    def start(name: str, *words: str) -> int:
        code = "import sys; print(flush=True); sys.stdin.read()"
        process = subprocess.Popen(
            [name, "-c", code, *words], executable=sys.executable, stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        started.append(process)
        assert process.stdout is not None
        process.stdout.readline()
        return process.pid

    try:
        ours = {start("/usr/local/bin/python3", f"{home}/py/robot.py"), start("java", f"{home}/Robot.jar")}
        ours.add(start(f"{home}/frcUserProgram"))
        others = {start("python3", "/tmp/robot.py"), start("tail", f"{home}/py/robot.py"), start("java", "x.jar")}
        found = robot.processes()
        assert found & (ours | others) == ours
        monkeypatch.setattr(host.os, "geteuid", lambda: -1)
        assert robot.processes() == set()
    finally:
        for process in started:
            process.communicate()
