"""The suite's warm processes: robot code finds in a fork what it finds in a new interpreter."""

from __future__ import annotations

import json
import os
import re
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
import warm_processes
import warm_start
from conftest import MakeProject, RobotProject
from conftest import _warm_processes as warm_processes_of_the_suite
from sim_robots import settle, wait

from pyfrc_core.processes.spawn import Interpreter
from pyfrc_core.project import Project
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.sim.engine import host_process
from pyfrc_core.sim.engine.host import Hosting

pytestmark = pytest.mark.skipif(not warm_start.POSSIBLE, reason="here all hosts start cold")

ROBOT = """
    import faulthandler
    import gc
    import io
    import json
    import os
    import random
    import signal
    import stat
    import sys
    import threading
    import traceback

    import wpilib

    TOP_LEVEL = {name.partition(".")[0] for name in sys.modules}


    def stream(file):
        how = file.encoding, file.errors, file.line_buffering, file.write_through, file.isatty()
        return [*how, type(file.buffer).__name__, stat.S_IFMT(os.fstat(file.fileno()).st_mode)]


    def handler(number):
        found = signal.getsignal(number)
        return getattr(found, "__name__", str(found))


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            stat_of_host = open(f"/proc/{os.getppid()}/stat").read().rpartition(")")[2].split()
            found = {
                "path": sys.path,
                "arguments": [sys.argv, sys.orig_argv, sys.executable, sys.flags, sys.warnoptions],
                "environment": dict(os.environ),
                "directory": os.getcwd(),
                "streams": [stream(file) for file in (sys.stdin, sys.stdout, sys.stderr)],
                "typed": sys.stdin.read(),
                "descriptors": len(os.listdir("/proc/self/fd")),
                "handlers": {str(number): handler(number) for number in signal.valid_signals()},
                "masked": sorted(signal.pthread_sigmask(signal.SIG_BLOCK, [])),
                "session": os.getsid(0) == os.getppid() == int(stat_of_host[2]),
                "libraries": sorted(TOP_LEVEL - sys.stdlib_module_names),
                "threads": [thread.name for thread in threading.enumerate()],
                "others": [faulthandler.is_enabled(), sys.dont_write_bytecode, hash("robot"), gc.get_threshold()],
                "random": random.random(),
                "main": __import__("__main__").__name__,
                "lines": [frame.filename for frame in traceback.extract_stack() if "robot-project" in frame.filename],
            }
            print(json.dumps(found))
            print("grün", file=sys.stderr)
    """


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Interpreter]]:
    """The hosts that a test starts."""
    hosts: list[Interpreter] = []
    start_host = host_process.start_host

    def noted(hosting: Hosting, output: int) -> Interpreter:
        hosts.append(start_host(hosting, output))
        return hosts[-1]

    monkeypatch.setattr(host_process, "start_host", noted)
    return hosts


def started_warm(host: Interpreter) -> bool:
    return type(host).__name__ != "Popen"


def found_by(project: RobotProject) -> dict[str, object]:
    with Simulation(Project(project.path / "robot.py"), SimOptions(paused=True, speed=0)) as simulation:
        settle(simulation)
        printed = ""

        def complete() -> bool:
            nonlocal printed
            printed = simulation.output_cursor().read()
            return "grün" in printed

        wait(simulation, complete)
        assert simulation.status.state == "paused", simulation.status
    before, brace, after = printed.partition("{")
    facts, _, after = after.partition("\n")
    return json.loads(brace + facts) | {"printed": before + after}


def test_a_robot_finds_what_it_finds_where_hosts_start_cold(
    make_project: MakeProject, started: list[Interpreter], request: pytest.FixtureRequest
) -> None:
    project = make_project({"robot.py": ROBOT})
    os.utime(project.path / "robot.py", (1.7e9, 1.7e9))  # of a file saved less than 2 s ago, no bytecode is written
    warm = found_by(project)
    assert [started_warm(host) for host in started] == [True]
    request.getfixturevalue("cold_hosts")
    assert warm == found_by(project)


def test_a_client_that_ends_before_its_request_ends_nothing_else(
    make_project: MakeProject, started: list[Interpreter]
) -> None:
    """As a command that a test kills in this moment."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as killed:
        killed.connect(warm_processes_of_the_suite().address)
    project = make_project({"robot.py": "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"})
    with Simulation(Project(project.path / "robot.py"), SimOptions(paused=True, speed=0)) as simulation:
        settle(simulation)
        assert simulation.status.state == "paused", simulation.status
    assert [started_warm(host) for host in started] == [True]


@pytest.mark.parametrize("cold", [False, True])
def test_the_end_of_a_host_is_reported(
    cold: bool, make_project: MakeProject, started: list[Interpreter], request: pytest.FixtureRequest
) -> None:
    if cold:
        request.getfixturevalue("cold_hosts")
    kills = (
        "import os\n\nos.kill(os.getppid(), 9)\nos.pause() if hasattr(os, 'pause') else __import__('signal').pause()\n"
    )
    project = make_project({"robot.py": kills})
    with Simulation(Project(project.path / "robot.py")) as simulation:
        wait(simulation, lambda: simulation.status.state == "failed")
        assert "SIGKILL" in str(simulation.status.failure)


@pytest.mark.parametrize(
    ("module", "variable"), [("pydantic.py", None), ("robot.py", "PYTHONDEVMODE"), ("robot.py", "PYFRC_COVERAGE")]
)
def test_it_starts_cold_where_a_fork_would_differ(
    module: str,
    variable: str | None,
    make_project: MakeProject,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    started: list[Interpreter],
) -> None:
    (tmp_path / "modules").mkdir()
    (tmp_path / "modules" / module).touch()
    monkeypatch.syspath_prepend(tmp_path / "modules")
    if variable is not None:
        monkeypatch.setenv(variable, "1")
    read, write = os.pipe()
    try:
        hosting = Hosting(str(tmp_path / "nothing"), b"", True, str(tmp_path))
        host = host_process.start_host(hosting, write)
        assert not started_warm(host)
        host.wait()
    finally:
        os.close(read)
        os.close(write)


def test_a_warm_command_has_a_warm_host(make_project: MakeProject) -> None:
    """What it does is compared in test_warm_start.py."""
    robot = """
        from pathlib import Path

        import wpilib

        parent = Path("/proc/self/status").read_text().partition("PPid:")[2].split()[0]
        print("started by", Path("/proc", parent, "cmdline").read_text().split("\\0")[1], flush=True)

        class MyRobot(wpilib.TimedRobot):
            pass
        """
    project = make_project({"robot.py": robot})
    assert (
        f"started by {Path(__file__).with_name('warm_processes.py')}\n"
        in project.run("sim", "--ui", "none", "--seconds", "0.1").stdout
    )


def test_a_deploys_check_starts_warm(make_project: MakeProject, tmp_path: Path) -> None:
    """Its hash seed is any, where the warm process has a fixed one."""
    robot = f"""
        import os

        import wpilib

        with open({str(tmp_path)!r} + "/found", "w") as file:
            print("warm_processes.py" in open(f"/proc/{{os.getppid()}}/cmdline").read(), file=file)

        class MyRobot(wpilib.TimedRobot):
            pass
        """
    project = make_project({"robot.py": robot})
    assert "no robot found" in project.run("deploy", "--skip-tests", "--robot", "127.0.0.1:1").stderr.lower()
    assert (tmp_path / "found").read_text() == "True\n"


def test_a_deploys_tests_find_what_they_find_in_a_new_interpreter(make_project: MakeProject, tmp_path: Path) -> None:
    tests = f"""
        import json
        import os
        import stat
        import sys

        kinds = [stat.S_IFMT(os.fstat(descriptor).st_mode) for descriptor in range(3)]
        environment = {{name: os.environ[name] for name in os.environ if name != "PYTEST_VERSION"}}
        found = [sys.path, sys.argv, sys.orig_argv, os.getcwd(), environment, kinds, hash("robot")]
        with open({str(tmp_path)!r} + "/found", "a") as file:
            print(json.dumps(found), file=file)
            print(json.dumps("warm_start.py" in open(f"/proc/{{os.getppid()}}/cmdline").read()), file=file)

        def test_it():
            print("printed", flush=True)
            os.write(2, b"written")
            assert False
        """
    robot = "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
    project = make_project({"robot.py": robot, "tests/test_it.py": tests})
    words = ["deploy", "--robot", "127.0.0.1:1"]
    for quiet in ([], ["--quiet"]):
        warm, cold = (project.run(*words, *quiet, cold=cold) for cold in (False, True))
        assert warm.blocks() == cold.blocks()
        assert "written" in warm.blocks()["test_it"]
        assert (warm.code, warm.stderr) == (cold.code, cold.stderr)
        assert "the tests failed" in warm.stderr
    found = [json.loads(line) for line in (tmp_path / "found").read_text().splitlines()]
    assert found[1::2] == [True, False, True, False]
    assert found[0] == found[2]
    assert found[4] == found[6]


@pytest.mark.parametrize(("seed", "is_warm"), [("0", True), ("1", False), ("random", False)])
def test_a_seed_that_is_asked_for_is_the_seed(seed: str, is_warm: bool) -> None:
    assert warm_processes._the_same({"PYTHONHASHSEED": seed}, {"PYTHONHASHSEED": "0"}) is is_warm


def test_what_is_looked_at_apart_does_the_same_as_in_a_new_interpreter(
    make_project: MakeProject, tmp_path: Path
) -> None:
    robot = f"""
        import json
        import os
        import sys

        import wpilib

        streams = [[file.encoding, file.errors] for file in (sys.stdin, sys.stdout, sys.stderr)]
        found = [sys.path, sys.orig_argv, os.getcwd(), dict(os.environ), streams, hash("robot")]
        found.append(len(os.listdir("/proc/self/fd")))
        with open({str(tmp_path)!r} + "/found", "a") as file:
            print(json.dumps(found), file=file)
            print("warm_processes.py" in open(f"/proc/{{os.getppid()}}/cmdline").read(), file=file)
        print("\\udcff")
        os._exit(3)
        """
    project = make_project({"robot.py": robot})
    warm, cold = project.run("create-physics"), project.run("create-physics", cold=True)
    assert (warm.code, warm.stdout, warm.stderr) == (cold.code, cold.stdout, cold.stderr)
    assert "os._exit" in warm.stderr
    found_warm, is_warm, found_cold, is_not_warm = (tmp_path / "found").read_text().splitlines()
    assert (is_warm, is_not_warm) == ("True", "False")
    assert json.loads(found_warm) == json.loads(found_cold)


def test_a_spawned_test_finds_what_it_finds_in_a_new_interpreter(make_project: MakeProject, tmp_path: Path) -> None:
    tests = f"""
        import json
        import os
        import sys

        def test_it(robot):
            streams = [[file.encoding, file.errors] for file in (sys.stdin, sys.__stdout__, sys.__stderr__)]
            found = [sys.path, sys.argv, sys.orig_argv, os.getcwd(), dict(os.environ), streams, hash("robot")]
            found.append(len(os.listdir("/proc/self/fd")))
            with open({str(tmp_path)!r} + "/found", "a") as file:
                print(json.dumps(found), file=file)
                print("warm_start.py" in open(f"/proc/{{os.getppid()}}/cmdline").read(), file=file)
            print("printed", flush=True)
            os.write(2, b"written")
            assert False
        """
    robot = "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
    project = make_project({"robot.py": robot, "tests/test_it.py": tests})
    warm, cold = (project.run("test", "--isolation", "spawn", "--", "-v", cold=cold) for cold in (False, True))
    shown_warm, shown_cold = (re.sub("0x[0-9a-f]+", "", run.blocks()["test_it"]) for run in (warm, cold))
    assert (warm.code, shown_warm, warm.stderr) == (cold.code, shown_cold, cold.stderr)
    assert "written" in shown_warm
    found_warm, is_warm, found_cold, is_not_warm = (tmp_path / "found").read_text().splitlines()
    assert (is_warm, is_not_warm) == ("True", "False")
    assert json.loads(found_warm) == json.loads(found_cold)
