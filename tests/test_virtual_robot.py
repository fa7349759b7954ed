"""`pyfrc virtual-robot` and deploys to it: without root, SSH server or network."""

from __future__ import annotations

import json
import os
import re
import select
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path
from textwrap import dedent
from types import SimpleNamespace
from typing import Any

import pytest
from conftest import RobotProject, sampled
from ports import lasting_port
from skips import require
from started_commands import StartedCommand

from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.connection import connect
from pyfrc_core.deploy.discovery import parse_address
from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.host_keys import HostKeys
from pyfrc_core.deploy.login import Credentials
from pyfrc_core.deploy.targets import CONTROLLERS, ControllerKind
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.doctor.robot import RobotSearch
from pyfrc_core.doctor.steps import Step
from pyfrc_core.errors import PyfrcError, UsageError
from pyfrc_core.project import find_project
from pyfrc_core.virtual_robot import children
from pyfrc_core.virtual_robot import robot as virtual_robot
from pyfrc_core.virtual_robot.console import ConsoleServer
from pyfrc_core.virtual_robot.disk import RobotDisk
from pyfrc_core.virtual_robot.robot import Control
from pyfrc_core.virtual_robot.supervisor import Supervisor, program_words

pytestmark = pytest.mark.bare

ROBOT = """
import os
import wpilib

class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        print("version 1 of", os.getpid(), flush=True)
"""


class Started:
    """A `pyfrc virtual-robot` that is running."""

    def __init__(self, command: StartedCommand) -> None:
        self.command = command
        self.printed: list[str] = []
        self._news = threading.Condition()
        self._ended = False
        threading.Thread(target=self._read, daemon=True).start()
        (self.address,) = re.findall(r"running at (\S+);", self.said("running at"))

    def _read(self) -> None:
        for line in self.command.stdout:
            with self._news:
                self.printed.append(line)
                self._news.notify_all()
        with self._news:
            self._ended = True
            self._news.notify_all()

    def said(self, text: str, times: int = 1) -> str:
        """Wait until so many lines with `text` have been printed; the last of them."""
        with self._news:
            self._news.wait_for(lambda: sum(text in line for line in self.printed) >= times or self._ended)
            found = [line for line in self.printed if text in line]
            assert len(found) >= times, f"{text!r} was not printed, but:\n{''.join(self.printed)}"
            return found[times - 1]

    def pid(self, times: int = 1) -> int:
        """Return the process of the program that prints that it is version 1."""
        return int(self.said("version 1 of", times).split()[-1])


@contextmanager
def started(project: RobotProject, directory: Path, *options: str) -> Iterator[Started]:
    """A virtual robot, ended by Ctrl-C at the end."""
    with project.start("virtual-robot", "--directory", directory, *options) as command:
        try:
            yield Started(command)
        finally:
            command.send_signal(signal.SIGINT)
            command.wait()


@pytest.fixture
def project(make_project) -> RobotProject:
    return make_project({"robot.py": ROBOT, "other.py": "VALUE = 1\n"})


@pytest.fixture
def directory(tmp_path: Path) -> Path:
    return tmp_path / "robot"


def on(robot: Started, project: RobotProject, command: str, *options: str) -> str:
    """Run a command about the robot, which succeeds; what it printed."""
    result = project.run(command, *options, "--robot", robot.address)
    assert result.code == 0, result.output
    return result.output


def deploy(robot: Started, project: RobotProject, *options: str) -> str:
    return on(robot, project, "deploy", "--skip-tests", *options)


def info(robot: Started, project: RobotProject) -> dict:
    return json.loads(on(robot, project, "deploy-info", "--json").splitlines()[-1])


def ended(pid: int) -> bool:
    """Wait until a process has ended."""
    if not hasattr(os, "pidfd_open"):
        pytest.skip("ends of other programs' processes are not seen here")
    try:
        descriptor = os.pidfd_open(pid)
    except ProcessLookupError:
        return True
    try:
        return bool(select.select([descriptor], [], [])[0])
    finally:
        os.close(descriptor)


@pytest.mark.parametrize("there", sampled(CONTROLLERS, CONTROLLERS[-1]), ids=lambda each: each.name)
def test_another_controller_is_refused_without_asking_for_a_password(
    project: RobotProject, directory: Path, there: ControllerKind
) -> None:
    (expected,) = (each for each in CONTROLLERS if each is not there)
    asked: list[str] = []
    with started(project, directory, "--controller", there.name.lower()) as robot:
        address = parse_address(robot.address)
        keys = HostKeys(directory).of_robot(address, expected)
        with pytest.raises(RefusedError, match=f"this robot has a {there.name}, but"):
            connect(address, expected, keys, credentials=Credentials(ask_password=asked.append))
    assert asked == []


@pytest.mark.slow
@pytest.mark.usefixtures("patient_doctor")
def test_a_program_is_deployed_changed_rolled_back_and_removed(project: RobotProject, directory: Path) -> None:
    with started(project, directory) as robot:
        assert "the program runs" in deploy(robot, project)
        first = robot.pid()
        project.write({"robot.py": ROBOT.replace("version 1", "version 2")})
        assert "1 file" in deploy(robot, project)
        robot.said("version 2")
        assert ended(first)
        about = info(robot, project)
        assert (about["current"], about["running"]) == (2, True)
        on(robot, project, "deploy", "--rollback")
        second = robot.pid(times=2)
        (project.path / ".pyfrc/known_hosts").unlink()
        search = RobotSearch(find_project(project.path), robot.address)
        assert [each.status for each in search.findings()] == ["ok", "ok"]
        assert search.missing_step() == (Step.DRIVE, "")
        assert not (project.path / ".pyfrc/known_hosts").exists(), "the doctor pins no key"
        on(robot, project, "undeploy", "--yes")
        assert ended(second)
        about = info(robot, project)
        assert (about["current"], about["running"], about["releases"]) == (None, False, [])


def test_the_program_is_disabled_finds_its_files_and_does_not_outlive_a_robot_that_is_killed(
    project: RobotProject, directory: Path
) -> None:
    project.write(
        {
            "deploy/path.txt": "a path",
            "robot.py": """
            import os
            from pathlib import Path
            import wpilib

            class MyRobot(wpilib.TimedRobot):
                def disabledInit(self):
                    station = wpilib.DriverStation
                    print("seen:", station.isDSAttached(), station.isEnabled(), wpilib.RobotBase.isSimulation())
                    print("read:", Path(wpilib.getDeployDirectory(), "path.txt").read_text())
                    print("name:", __name__, type(self).__module__)
                    print("home:", Path.home(), Path.cwd() == Path.home())
                    print("silenced:", station.isJoystickConnectionWarningSilenced())
                    print("version 1 of", os.getpid(), flush=True)
            """,
        }
    )
    with started(project, directory) as robot:
        deploy(robot, project)
        assert "False False True" in robot.said("seen:")
        assert "a path" in robot.said("read:")
        assert f"{directory / 'root/home/lvuser'} True" in robot.said("home:")
        assert "robot robot" in robot.said("name:")
        assert "silenced: True" in robot.said("silenced:")
        pid = robot.pid()
        robot.command.kill()
        assert ended(pid)


@pytest.mark.slow
def test_ctrl_c_ends_everything_and_a_later_start_has_the_same_programs_key_and_port(
    project: RobotProject, directory: Path
) -> None:
    # A port that no other test's robot takes meanwhile: they try those from 2222 on.
    with started(project, directory, "--port", str(lasting_port())) as robot:
        deploy(robot, project)
        pid, address = robot.pid(), robot.address
    assert robot.command.wait() == 130
    assert ended(pid)
    with started(project, directory) as robot:
        assert robot.address == address
        robot.pid()  # it is started without another deploy
        assert "its key is known" in on(robot, project, "deploy-info")
        assert info(robot, project)["current"] == 1
    with started(project, directory, "--fresh") as robot:
        assert info(robot, project)["releases"] == []


def test_a_line_that_is_printed_right_after_a_client_has_connected_reaches_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """As the first lines of a program that an agent restarts, although no thread of the server's gets a turn."""
    monkeypatch.setattr(threading.Thread, "start", lambda thread: None)
    console, other = ConsoleServer("127.0.0.1"), ConsoleServer("127.0.0.1")
    other.close()
    assert other.port > 1023
    assert other.port != console.port, "each has a port of its own"
    try:
        with socket.create_connection(("127.0.0.1", console.port)) as client:
            for number, line in ((1, b"first"), (2, b"second")):
                console.send(line)
                frame = client.recv(100)
                assert (frame[7:9], frame[9:]) == (bytes([0, number]), line)
    finally:
        console.close()


def test_a_command_gets_the_address_and_the_robot_ends_with_it(project: RobotProject, directory: Path) -> None:
    check = "import socket, sys; print(socket.create_connection(sys.argv[1].split(':')).recv(4)); sys.exit(7)"
    result = project.run("virtual-robot", "--directory", directory, "--", sys.executable, "-c", check)
    assert (result.code, result.stdout) == (7, "b'SSH-'\n")


def test_other_users_of_the_computer_are_not_let_in(project: RobotProject, directory: Path) -> None:
    missing = ["Linux"] if sys.platform != "linux" else [] if os.geteuid() == 0 else ["root"]
    require("that a virtual robot refuses other users", missing)

    def first_bytes() -> bytes:
        with socket.create_connection(tuple(robot.address.split(":"))) as connected:
            return connected.recv(4)

    with started(project, directory) as robot:
        assert first_bytes() == b"SSH-"
        os.seteuid(65534)
        try:
            assert first_bytes() == b""
        finally:
            os.seteuid(0)


# -- what a robot program leaves, and clients that say nothing ------------------------------------------------------

LEAVES_PROCESSES = """
import os
import subprocess
import sys
import wpilib

SLEEP = [sys.executable, "-c", "import time; time.sleep(3600)"]

class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        # One in its process group, and one in a session of its own whose parent process has ended.
        child = subprocess.Popen(SLEEP)
        start = f"import subprocess as s; print(s.Popen({SLEEP!r}, stdout=s.DEVNULL, start_new_session=True).pid)"
        other = subprocess.check_output([sys.executable, "-c", start])
        print("children", child.pid, int(other), flush=True)
"""


@pytest.mark.parametrize("stop", sampled(["interrupt", "kill"], "interrupt"))
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux finds processes that have left their group")
def test_a_stopped_robot_leaves_no_child_processes(project: RobotProject, directory: Path, stop: str) -> None:
    project.write({"robot.py": LEAVES_PROCESSES})
    with started(project, directory) as robot:
        deploy(robot, project)
        children = [int(word) for word in robot.said("children").split()[1:]]
        assert len(children) == 2
        if stop == "kill":
            robot.command.kill()
        else:
            robot.command.send_signal(signal.SIGINT)
            robot.command.wait()
        assert all(ended(child) for child in children)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux finds processes that have left their group")
def test_a_program_that_ends_as_its_supervisor_does_leaves_no_child_processes(tmp_path: Path) -> None:
    """Such as one that prints: although the thread that waits for the supervisor's end gets no turn any more."""
    (tmp_path / "robot.py").write_text(
        dedent(
            """
            import subprocess, sys, threading
            from pyfrc_core.virtual_robot import children

            begun = threading.Event()

            def kill_marked(mark, kill=children.kill_marked):
                if threading.current_thread() is not threading.main_thread():
                    begun.set()
                    threading.Event().wait()
                kill(mark)

            children.kill_marked = kill_marked
            sleep = [sys.executable, "-c", "import time; time.sleep(3600)"]
            print("child", subprocess.Popen(sleep, stdout=subprocess.DEVNULL).pid, flush=True)
            begun.wait()
            raise BrokenPipeError
            """
        )
    )
    command = [sys.executable, "-m", "pyfrc_core.virtual_robot.program", "--main", str(tmp_path / "robot.py"), "run"]
    environment = {**os.environ, children.MARK: "a mark of this test"}
    with children.start(command, tmp_path, environment, stderr=subprocess.DEVNULL) as program:
        assert program.stdin is not None
        assert program.stdout is not None
        child = next(int(line.split()[1]) for line in program.stdout if line.startswith(b"child"))
        program.stdin.close()
    assert ended(child)


def test_a_control_request_needs_the_key(project: RobotProject, directory: Path) -> None:
    program = Supervisor(RobotPaths(ROBORIO.layout, str(directory)), lambda line: None, lambda text: None)
    control = Control(program)
    try:
        for request, response in ((f"{control.key} processes\n", b"[]"), ("0000 processes\n", b""), ("\n", b"")):
            with socket.create_connection(("127.0.0.1", control.port)) as client:
                client.sendall(request.encode())
                assert client.recv(100) == response
    finally:
        control.close()


def test_what_can_be_wrong_with_its_directory(tmp_path: Path) -> None:
    place, layout = tmp_path / "robot", ROBORIO.layout
    with RobotDisk(place, layout) as disk:
        assert disk.last_port() is None
        disk.write_address("127.0.0.1:2222", 2222)
        assert disk.last_port() == 2222
        (disk.paths.home / "program").touch()
        (disk.paths.of("/tmp") / "old").touch()
        with pytest.raises(PyfrcError, match=r"a virtual robot is already running here, at 127\.0\.0\.1:2222\n"):
            RobotDisk(place, layout)
    assert (place / "lock").read_text() == "", "it has no address any more"
    with RobotDisk(place, layout) as again:
        assert again.key == disk.key
        assert (disk.paths.home / "program").exists()
        assert not (disk.paths.of("/tmp") / "old").exists(), "as on a robot, at each start"
    with RobotDisk(place, layout, fresh=True) as fresh:
        assert (fresh.key, list(fresh.paths.home.iterdir())) == (disk.key, [])
    (place / "host_key").write_text("no key")
    with pytest.raises(PyfrcError, match="this is not an SSH key"):
        RobotDisk(place, layout)
    with pytest.raises(UsageError, match="this directory has files that are not from a virtual robot"):
        RobotDisk(tmp_path, layout)
    (tmp_path / "file").touch()
    with pytest.raises(PyfrcError, match=r"cannot store the virtual robot's files here: (not a directory|file exists)"):
        RobotDisk(tmp_path / "file/robot", layout)


def test_the_port_is_that_of_the_last_start_or_the_next_free_one(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken, socket.create_server(("127.0.0.1", 0)) as free:
        ports = [each.getsockname()[1] for each in (taken, free)]
        free.close()
        with pytest.raises(
            PyfrcError, match=rf"127\.0\.0\.1:{ports[0]}: the port cannot be used: Address already in use"
        ):
            virtual_robot._listener(ports[0], None)
        for named, last in ((ports[1], ports[0]), (None, ports[1])):
            with virtual_robot._listener(named, last) as listening:
                assert listening.getsockname()[1] == ports[1]
        monkeypatch.setattr(virtual_robot, "FIRST_PORT", ports[0])
        with virtual_robot._listener(None, ports[0]) as listening:
            assert listening.getsockname()[1] > ports[0]


def test_a_command_s_exit_code_and_the_controllers_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[dict[str, Any]] = []

    class Robot(nullcontext[Any]):
        def __init__(self, directory: Path, **how: Any) -> None:
            super().__init__(SimpleNamespace(address="there"))
            made.append({"directory": directory, **how})

    monkeypatch.setattr(virtual_robot, "VirtualRobot", Robot)
    run = partial(virtual_robot.run_command, directory=tmp_path, port=None, fresh=True)
    assert run([sys.executable, "-c", "import sys; sys.exit(sys.argv[1] == 'there')"], controller="RoboRIO") == 1
    assert made == [{"directory": tmp_path, "controller": ROBORIO, "port": None, "fresh": True}]
    if sys.platform != "win32":
        kill = "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"
        assert run([sys.executable, "-c", kill], controller=None) == 128 + signal.SIGKILL
    with pytest.raises(UsageError, match="there is no controller 'crio'\n  Write: --controller roborio or systemcore"):
        run([sys.executable], controller="crio")
    with pytest.raises(UsageError, match="there is no command 'no-such-command'"):
        run(["no-such-command"], controller=None)


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("env A=/b /usr/bin/python3 -u -O -m robotpy --main /home/lvuser/py/r.py run", ["-u", "-O", "r.py", "run"]),
        ("python3.14 -m robotpy --main '/home/lvuser/py/r.py' -v run", ["r.py", "-v", "run"]),
        ("java -jar Robot.jar", None),
        ("python3 -m robotpy --main", None),
        ("python3 -m other --main /home/lvuser/py/r.py run", None),
        ("python3 -m robotpy '", None),
    ],
)
def test_start_commands_are_translated(command: str, words: list[str] | None, tmp_path: Path) -> None:
    paths = RobotPaths(ROBORIO.layout, str(tmp_path))
    found = program_words(command, paths)
    if words is None:
        assert found is None
        return
    assert found is not None
    assert found[:3] == [sys.executable, "-X", "utf8"]
    runner = found.index("pyfrc_core.virtual_robot.program")
    assert found[runner + 1 : runner + 3] == ["--main", str(paths.home / "py/r.py")]
    assert [*found[3 : runner - 1], Path(found[runner + 2]).name, *found[runner + 3 :]] == words
