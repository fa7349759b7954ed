"""The suite's forked programs do what new interpreters do."""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import forked
import pytest
from conftest import MakeProject, Result, RobotProject, _forking_process
from sim_robots import settle, wait

from pyfrc_core.processes import spawn
from pyfrc_core.project import Project
from pyfrc_core.sim import SimOptions, Simulation

pytestmark = pytest.mark.skipif(not forked.POSSIBLE, reason="here all programs are new interpreters")

#: Prints what it finds, and the robot code's line that a traceback would show.
FINDS = """
    import gc
    import json
    import os
    import signal
    import stat
    import sys
    import threading
    import traceback

    TOP_LEVEL = {name.partition(".")[0] for name in list(sys.modules)}  # a thread may import meanwhile


    def stream(file):
        how = file.encoding, file.errors, file.line_buffering, file.write_through, file.isatty()
        return [*how, type(file.buffer).__name__, stat.S_IFMT(os.fstat(file.fileno()).st_mode)]


    def handler(number):
        found = signal.getsignal(number)
        return getattr(found, "__name__", str(found))


    def show():
        found = {
            "path": sys.path,
            "arguments": [sys.argv, sys.orig_argv, sys.executable, sys.warnoptions],
            "environment": {name: os.environ[name] for name in os.environ if name != "PYTEST_VERSION"},
            "directory": os.getcwd(),
            "streams": [stream(file) for file in (sys.__stdin__, sys.__stdout__, sys.__stderr__)],
            "typed": sys.__stdin__.read(),
            "descriptors": sum(  # a late libffi keeps its own file open
                "libffi" not in os.path.realpath(f"/proc/self/fd/{each}") for each in os.listdir("/proc/self/fd")
            ),
            "handlers": {str(number): handler(number) for number in signal.valid_signals()},
            "masked": sorted(signal.pthread_sigmask(signal.SIG_BLOCK, [])),
            "main": sys.modules["__main__"].__name__,
            "threads": [thread.name for thread in threading.enumerate()],
            "others": [sys.dont_write_bytecode, gc.get_threshold(), os.getpgid(0) == os.getpgid(os.getppid())],
            "lines": [frame.filename for frame in traceback.extract_stack() if "robot-project" in frame.filename],
        }
        print(json.dumps(found), flush=True)
        print("grün", file=sys.__stderr__, flush=True)
"""

ROBOT = f"""{FINDS}
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            show()
"""


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The processes of the hosts that a test starts."""
    hosts: list[Any] = []
    popen = spawn.popen

    def noted(*args: Any, **options: Any) -> Any:
        hosts.append(popen(*args, **options))
        return hosts[-1]

    monkeypatch.setattr(spawn, "popen", noted)
    return hosts


def found_by_host(project: RobotProject) -> dict[str, object]:
    printed = ""
    with Simulation(Project(project.path / "robot.py"), SimOptions(paused=True, speed=0)) as simulation:
        settle(simulation)
        output = simulation.output_cursor()

        def complete() -> bool:
            nonlocal printed
            printed += output.read()
            return "grün" in printed

        wait(simulation, complete)
    facts = next(line for line in printed.splitlines() if line.startswith("{"))
    return json.loads(facts) | {"printed": printed.replace(facts, "")}


def test_a_robot_finds_in_its_host_what_it_finds_in_a_new_interpreter(
    make_project: MakeProject, started: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    project = make_project({"robot.py": ROBOT})
    os.utime(project.path / "robot.py", (1.7e9, 1.7e9))  # of a file saved less than 2 s ago, no bytecode is written
    warm = found_by_host(project)
    assert [type(host) for host in started] == [forked.Forked]
    monkeypatch.setattr(spawn, "popen", subprocess.Popen)
    assert warm == found_by_host(project)


def test_a_program_finds_what_it_finds_in_a_new_interpreter(make_project: MakeProject, tmp_path: Path) -> None:
    project = make_project({"conftest.py": f"{FINDS}\n    show()\n    os._exit(0)\n"})
    environment = {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(tmp_path / "missing")])}
    warm, cold = (
        project.run("-s", program="pytest", env=environment, stdin="ein\nWört\n", cold=cold) for cold in (False, True)
    )
    assert warm == cold
    assert "Wört" in json.loads(warm.stdout.splitlines()[0])["typed"]


FILES = {
    "pyproject.toml": "[tool.pyfrc.fuzz]\nmatch_seconds = 2\n",
    "robot.py": """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.motor = wpilib.PWMSparkMax(0)
            self.stick = wpilib.Joystick(0)

        def teleopPeriodic(self):
            self.motor.set(self.stick.getY())
    """,
    "tests/test_it.py": """
    import sys

    def test_that_fails(robot):
        print(sys.argv, __name__)
        assert robot.motor.get() == 1
    """,
}

COMMANDS = [
    "pyfrc test --trace traces -- -v",
    "pyfrc sim --ui none --mode auto --seconds 0.5 --record auto.jsonl",
    "pyfrc fuzz --runs 1 --seed 1",
    "pyfrc deploy --robot 127.0.0.1:1",
    "pytest -v",
]

#: What may be measured, and so differ from run to run: numbers, and lines that are drawn to their width.
MEASURED = re.compile(r"0x[0-9a-f]+|\d[\d.,]*|[-=]{3,}|(?<=\S)  +")


def shown(result: Result, project: RobotProject) -> tuple[int, str, str]:
    stdout, stderr = (
        MEASURED.sub("~", text.replace(str(project.path), ".")) for text in (result.stdout, result.stderr)
    )
    return result.code, stdout, stderr


def left(directory: Path) -> dict[str, str]:
    """Its files; what is in them, where the robot's doings are."""
    return {
        file.relative_to(directory).as_posix(): file.read_text("utf-8") if "trace" in file.name else ""
        for file in directory.rglob("*")
        if file.is_file() and not {"__pycache__", ".pytest_cache"}.intersection(file.parts)
    }


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_does_the_same_as_in_a_new_interpreter(command: str, make_shared_project: MakeProject) -> None:
    cold, warm = make_shared_project(FILES), make_shared_project(FILES)
    program, *words = command.split()
    assert shown(cold.run(*words, program=program, cold=True), cold) == shown(warm.run(*words, program=program), warm)
    assert left(cold.path) == left(warm.path)
    assert left(warm.temporary) == {}


@pytest.mark.parametrize("end", ["os.kill(os.getpid(), 9)", "os._exit(77)", "sys.exit('enough')", "sys.exit()"])
def test_its_end_is_reported(end: str, make_project: MakeProject) -> None:
    project = make_project({"ends.py": f"import atexit, os, sys\natexit.register(print, 'at exit')\n{end}\n"})
    environment = {"PYTHONPATH": str(project.path)}
    assert project.run(program="ends", env=environment) == project.run(program="ends", env=environment, cold=True)


@pytest.mark.parametrize(
    ("module", "variable", "is_warm"),
    [
        ("numbers.py", {}, False),
        ("below/coverage.py", {}, False),
        ("below/numbers.txt", {}, True),
        ("package/numbers.py", {}, True),
        ("robot.py", {"PYTHONDEVMODE": "1"}, False),
        ("robot.py", {"PYFRC_COVERAGE": "1"}, False),
        ("robot.py", {"PYTHONHASHSEED": "1"}, False),
        ("robot.py", {"PYTHONHASHSEED": "0"}, True),
    ],
)
def test_a_new_interpreter_starts_where_a_fork_would_differ(
    module: str, variable: dict[str, str], is_warm: bool, make_project: MakeProject
) -> None:
    project = make_project({module: "", "package/__init__.py": ""})
    program = project.start_with([0, 1, 2], "--version", env=variable)
    assert program.wait() == 0
    assert isinstance(program, forked.Forked) is is_warm


def test_a_client_that_ends_before_its_request_ends_nothing_else() -> None:
    """As a command that a test kills in this moment."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as killed:
        killed.connect(_forking_process())
    assert forked.popen(_forking_process(), [sys.executable, "-c", "raise SystemExit(3)"]).wait() == 3
