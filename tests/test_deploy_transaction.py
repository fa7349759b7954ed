"""The robot's disk after a deploy: the real agent in a directory of this machine."""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, LocalRobot, directory_in_memory, project_of

from pyfrc_core.deploy.agent_client import DeployRequest
from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.manifest import Entry, Manifest

START = "env LD_LIBRARY_PATH=/usr/local/frc/lib/ /usr/local/bin/python3 -u"
OTHER_COMMAND = "/usr/local/bin/python3 -u -O -m robotpy --main /home/lvuser/py/robot.py run"


class Project:
    """A project in a directory, changed now and then."""

    def __init__(self, directory: Path) -> None:
        self._directory = directory
        self.write("robot.py", ROBOT_PY)

    def write(self, name: str, content: str | bytes = "") -> Project:
        project_of(self._directory, {name: content})
        return self

    def remove(self, name: str) -> Project:
        (self._directory / name).unlink()
        return self

    @property
    def manifest(self) -> Manifest:
        return project_of(self._directory, {})


@pytest.fixture
def project(tmp_path: Path) -> Project:
    return Project(tmp_path / "project").write("arm.py", "LENGTH = 1\n").write("deploy/path.json", "[1, 2]")


def contents(directory: Path) -> dict[str, bytes | str]:
    """All that is below a directory."""
    return {
        path.relative_to(directory).as_posix(): str(path.readlink()) if path.is_symlink() else path.read_bytes()
        for path in directory.rglob("*")
        if path.is_symlink() or path.is_file()
    }


def test_first_deploy_makes_what_other_tools_and_the_robot_expect(robot: LocalRobot, project: Project) -> None:
    deployed = robot.deploy(project.manifest)
    assert (deployed.release, deployed.previous, deployed.taken, deployed.unchanged) == (1, None, None, False)
    assert deployed.files_sent == 3
    py = robot.home / "py"
    assert py.is_dir()
    assert (py / "arm.py").read_text() == "LENGTH = 1\n"
    assert json.loads((py / "deploy.json").read_text()) == {"deploy-user": "somebody"}
    assert (robot.home / "robotCommand").read_text() == f"{START} -O -m robotpy --main /home/lvuser/py/robot.py run\n"
    assert not (robot.root / "tmp/frcdebug").exists()
    assert [each.name.endswith(".opt-1.pyc") for each in (py / "__pycache__").iterdir()] == [True, True]


def test_debugging(robot: LocalRobot, project: Project) -> None:
    """The robot forgets /tmp when it is switched off: robotCommand has to start the program then."""
    robot.deploy(project.manifest, debug=True)
    command = (robot.home / "robotDebugCommand").read_text()
    assert command == f"{START} -m robotpy --main /home/lvuser/py/robot.py -v run\n"
    assert (robot.root / "tmp/frcdebug").exists()
    (robot.root / "tmp/frcdebug").unlink()
    assert robot.startable() is not None
    robot.deploy(project.manifest, debug=True)
    robot.deploy(project.manifest)
    assert not (robot.root / "tmp/frcdebug").exists()


def test_only_what_changed_is_sent_and_the_rest_is_linked(robot: LocalRobot, project: Project, tmp_path: Path) -> None:
    py = robot.home / "py"
    robot.deploy(project.manifest)
    inode = (py / "arm.py").stat().st_ino
    project.write("robot.py", ROBOT_PY + "# changed\n").remove("deploy/path.json")
    deployed = robot.deploy(project.manifest)
    assert (deployed.release, deployed.previous, deployed.files_sent) == (2, 1, 1)
    assert (py / "arm.py").stat().st_ino == inode
    assert robot.startable() == {"robot.py": (ROBOT_PY + "# changed\n").encode(), "arm.py": b"LENGTH = 1\n"}
    assert len(list((py / "__pycache__").iterdir())) == 2
    assert not (py / "deploy").exists()
    # The same again is no new release: three of them would push out the last program that worked.
    deployed = robot.deploy(project.manifest)
    assert (deployed.release, deployed.unchanged, deployed.bytes_sent) == (2, True, 0)
    # A file that was moved, and one that can be run now.
    project.remove("arm.py").write("lib/lever.py", "LENGTH = 1\n")
    (tmp_path / "project/robot.py").chmod(0o755)
    assert robot.deploy(project.manifest).files_sent == 0
    assert (py / "lib/lever.py").read_text() == "LENGTH = 1\n"
    assert (py / "robot.py").stat().st_mode & 0o777 == 0o755
    # A file that was changed on the robot.
    robot.deploy(project.write("path.json", "[1]").manifest)
    (py / "path.json").write_text("[9]")
    deployed = robot.deploy(project.manifest)
    assert (deployed.unchanged, deployed.files_sent) == (False, 1)
    assert (py / "path.json").read_text() == "[1]"


def test_rollback(robot: LocalRobot, project: Project) -> None:
    robot.deploy(project.manifest)
    first = robot.startable()
    robot.deploy(project.remove("arm.py").write("robot.py", "# 2\n").manifest)
    (robot.home / "py/robot.py").write_text("# 9\n")
    robot.deploy(project.write("robot.py", "# 3\n").manifest, debug=True)
    session = robot.start()
    gone_back = session.rollback()
    assert (gone_back.release.number, gone_back.previous, gone_back.changed) == (2, 3, ("robot.py",))
    assert not (robot.root / "tmp/frcdebug").exists()
    gone_back = session.rollback()
    assert (gone_back.release.number, gone_back.changed, robot.startable()) == (1, (), first)
    with pytest.raises(RefusedError, match=r"no earlier release.*\n.*1, 2, 3; current: 1"):
        session.rollback()
    with pytest.raises(RefusedError, match="no release 7"):
        session.rollback(7)
    assert session.rollback(3).release.debug
    assert (robot.root / "tmp/frcdebug").exists()
    session.close()


def other_tools_program(robot: LocalRobot, command: str = OTHER_COMMAND) -> None:
    py = robot.home / "py"
    if py.is_symlink():
        py.unlink()  # as `rm -rf` does
    (py / "sub").mkdir(parents=True)
    (py / "robot.py").write_text("# another tool's\n")
    (py / "sub/helper.py").write_text("# another tool's\n")
    (py / "deploy.json").write_text('{"deploy-host": "theirs"}')
    (py / "match.log").write_text("written by the program\n")
    (robot.home / "robotCommand").write_text(command)


def test_another_tools_program_becomes_a_release(robot: LocalRobot, project: Project) -> None:
    other_tools_program(robot)
    deployed = robot.deploy(project.manifest)
    assert (deployed.release, deployed.taken) == (2, 1)
    py = robot.home / "py"
    assert not (py / "sub/helper.py").exists()
    assert (py / "match.log").read_text() == "written by the program\n"
    session = robot.start()
    taken = session.rollback().release
    assert (taken.number, taken.taken, taken.deploy_json) == (1, True, {"deploy-host": "theirs"})
    assert (robot.home / "robotCommand").read_text() == OTHER_COMMAND
    assert (py / "sub/helper.py").exists()
    assert not session.info().other_code
    session.close()


def test_what_the_program_writes_survives(robot: LocalRobot, project: Project) -> None:
    robot.deploy(project.manifest)
    py = robot.home / "py"
    (py / "logs/empty").mkdir(parents=True)
    (py / "logs/1.csv").write_text("1\n")
    (py / "latest").symlink_to("logs/1.csv")
    open_log = (py / "open.log").open("a")
    session = robot.start()
    session.deploy(project.write("robot.py", "# 2\n").manifest, DeployRequest("robot.py", {}))
    # Until it is restarted, the old program goes on, with the files and directories that it has open.
    old = robot.home / ".pyfrc/releases/1"
    open_log.write("still written\n")
    open_log.close()
    (old / "late.csv").write_text("late\n")
    (old / "1.new").write_text("2\n")
    (old / "1.new").replace(old / "logs/1.csv")
    session.restart()
    session.close()
    assert (py / "open.log").read_text() == "still written\n"
    assert (py / "late.csv").read_text() == "late\n"
    assert (py / "latest").read_text() == "2\n"
    assert (py / "logs/empty").is_dir()


def test_rollback_keeps_what_the_program_wrote_in_either_release(robot: LocalRobot, project: Project) -> None:
    robot.deploy(project.manifest)
    py, first = robot.home / "py", robot.home / ".pyfrc/releases/1"
    for name in ("log.txt", "same.txt", "one.txt"):
        (py / name).write_text(f"1: {name}" if name != "same.txt" else "same")
    robot.deploy(project.write("robot.py", "# 2\n").manifest)
    for name in ("log.txt", "same.txt"):  # as programs write that log to a new file each time
        (py / name).unlink()
        (py / name).write_text(f"2: {name}" if name != "same.txt" else "same")
    for times in (1, 2):
        session = robot.start()
        assert session.rollback(1).release.number == 1
        session.close()
        written = {name: text for name, text in contents(py).items() if name.split(".")[0] in ("log", "same", "one")}
        assert written == {
            "log.txt": b"2: log.txt",
            "log.txt.release-1": b"1: log.txt",
            "same.txt": b"same",
            "one.txt": b"1: one.txt",
        }, times
    (first / "log.txt").unlink()
    (first / "log.txt").write_text("3")
    session = robot.start()
    session.rollback(2)
    session.close()
    assert (py / "log.txt").read_text() == "3"
    assert (py / "log.txt.release-2").read_text() == "2: log.txt"
    assert (py / "log.txt.release-1").read_text() == "1: log.txt"
    (py / "log.txt").unlink()
    (py / "log.txt").write_text("4")
    session = robot.start()
    session.rollback(1)
    session.close()
    assert (py / "log.txt").read_text() == "4"
    assert (py / "log.txt.release-1-2").read_text() == "3"


def test_the_kill_script_finds_the_robots_commands(robot: LocalRobot) -> None:
    """Both files of the image that set the path are read, and each may be missing."""
    bin_directory, profile = robot.root / "usr/local/frc/bin", robot.root / "etc/profile.d"
    for name in ("FRC_ConsoleTee", "natinst_command"):
        (robot.root / name).mkdir()
        (robot.root / name / name).write_text(f"#!/bin/sh\necho {name} >> {robot.root}/found\n")
        (robot.root / name / name).chmod(0o755)
    (bin_directory / "frcKillRobot.sh").write_text("#!/bin/sh\nFRC_ConsoleTee; natinst_command; exit 0\n")
    (profile / "frc-path.sh").write_text(f'export PATH="$PATH:{robot.root}/FRC_ConsoleTee"\n')
    (profile / "natinst-path.sh").write_text(f'export PATH="$PATH:{robot.root}/natinst_command"\n')
    for missing in (None, "natinst-path.sh", "frc-path.sh"):
        if missing is not None:
            (profile / missing).unlink()
        session = robot.start()
        session.restart()
        session.close()
    assert (robot.root / "found").read_text().split() == ["FRC_ConsoleTee", "natinst_command", "FRC_ConsoleTee"]


def test_files_of_the_same_content_do_not_become_one(robot: LocalRobot, project: Project) -> None:
    """Or what the program writes into the one would be in the other."""
    robot.deploy(project.write("package/__init__.py").write("data.csv").manifest)
    py = robot.home / "py"
    (py / "log.txt").touch()
    robot.deploy(project.write("lib/__init__.py").write("robot.py", "# 2\n").manifest)
    for name in ("log.txt", "data.csv"):
        with (py / name).open("a") as stream:
            stream.write("written")
    assert (py / "lib/__init__.py").read_text() == ""
    assert (py / "package/__init__.py").read_text() == ""


def test_plan_writes_nothing(robot: LocalRobot, project: Project) -> None:
    session = robot.start()
    before = contents(robot.root)
    plan = session.plan(project.manifest)
    assert plan.added == ("arm.py", "deploy/path.json", "robot.py")
    assert (plan.changed, plan.removed, plan.files_to_send) == ((), (), 3)
    assert plan.bytes_to_send == project.manifest.total_bytes
    assert contents(robot.root) == before
    session.close()
    robot.deploy(project.manifest)
    (robot.home / "py/log.txt").write_text("the program's")
    before = contents(robot.root)
    project.remove("arm.py").write("robot.py", "# 2\n").write("new.py", "# new\n").write("again.py", "LENGTH = 1\n")
    session = robot.start()
    plan = session.plan(project.manifest)
    session.close()
    assert (plan.added, plan.changed, plan.removed) == (("again.py", "new.py"), ("robot.py",), ("arm.py",))
    assert (plan.files_to_send, plan.bytes_to_send) == (2, 10)
    assert contents(robot.root) == before


def test_undeploy(robot: LocalRobot, project: Project) -> None:
    robot.deploy(project.manifest, debug=True)
    session = robot.start()
    assert session.undeploy()
    assert not session.undeploy()
    assert session.info().releases == ()
    session.close()
    assert list(robot.home.iterdir()) == []
    assert list((robot.root / "tmp").iterdir()) == []


def test_a_module_with_a_name_too_long_for_its_compiled_form(robot: LocalRobot, project: Project) -> None:
    project.write("a" * 250 + ".py", "X = 1\n")
    for number in range(2):
        robot.deploy(project.write("robot.py", f"# {number}\n").manifest)
    assert robot.startable() is not None
    assert any((robot.home / "py/__pycache__").glob("robot.*.pyc"))


def test_another_tools_program_is_started_for_debugging_again(robot: LocalRobot, project: Project) -> None:
    project_of(robot.home / "py", {"robot.py": "# other\n"})
    (robot.home / "robotDebugCommand").write_text(OTHER_COMMAND)
    (robot.root / "tmp/frcdebug").touch()
    before = robot.startable()
    assert before == {"robot.py": b"# other\n"}
    robot.deploy(project.manifest)
    assert robot.startable() != before
    session = robot.start()
    assert session.rollback().release.taken
    session.close()
    assert robot.startable() == before


def test_a_start_command_that_is_no_utf8_comes_back(robot: LocalRobot, project: Project) -> None:
    odd = b"python3 /home/lvuser/py/robot.py --name \xff\n"
    project_of(robot.home / "py", {"robot.py": "# other\n"})
    (robot.home / "robotCommand").write_bytes(odd)
    robot.deploy(project.manifest)
    session = robot.start()
    assert session.rollback().release.taken
    session.close()
    assert (robot.home / "robotCommand").read_bytes() == odd


def test_a_file_that_changes_while_it_is_sent(robot: LocalRobot, project: Project, tmp_path: Path) -> None:
    robot.deploy(project.manifest)
    before = robot.startable()
    for change in ("LENGTH = 3\n", "", "much longer than it was\n"):
        manifest = project.write("arm.py", "LENGTH = 2\n").manifest
        project.write("arm.py", change)
        with pytest.raises(RefusedError, match=r"arm.py was changed while it was sent\n  Deploy again."):
            robot.deploy(manifest)
        assert robot.startable() == before
    manifest = project.write("arm.py", "LENGTH = 2\n").manifest
    (tmp_path / "project/arm.py").unlink()
    os.mkfifo(tmp_path / "project/arm.py")
    with pytest.raises(RefusedError, match=r"arm.py was changed while it was sent"):
        robot.deploy(manifest)
    (tmp_path / "project/arm.py").unlink()
    robot.deploy(project.manifest)


NAMES = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="/\0"), min_size=1, max_size=20).filter(
    lambda name: not name.startswith(".") and name not in ("robot.py", "deploy.json", "__pycache__")
)


@settings(max_examples=10, suppress_health_check=list(HealthCheck))
@given(programs=st.lists(st.dictionaries(NAMES, st.binary(max_size=200), max_size=6), min_size=2, max_size=3))
def test_any_programs_one_after_the_other(programs: list[dict[str, bytes]]) -> None:
    """Manifests made here, since the file system of this machine may not have all such names."""
    with directory_in_memory() as directory:
        robot = LocalRobot.new(directory / "robot")
        for program in programs:
            files = {**program, "robot.py": ROBOT_PY.encode()}
            entries = []
            for number, (name, content) in enumerate(files.items()):
                file = directory / str(number)
                file.write_bytes(content)
                entries.append(Entry(name, len(content), hashlib.sha256(content).hexdigest(), False, file))
            robot.deploy(Manifest(tuple(entries)))
            assert robot.startable() == files
