"""The suite's warm starts: a command that is forked does, tells and leaves what it does in a new interpreter."""

from __future__ import annotations

import json
import os
import re
import select
import subprocess
import sys
from pathlib import Path

import conftest
import pytest
import warm_start
from conftest import MakeProject, Result, RobotProject

from pyfrc_cli.main import COMMANDS

pytestmark = pytest.mark.skipif(not warm_start.POSSIBLE, reason="here all commands start cold")

ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.motor = wpilib.PWMSparkMax(0)
            self.stick = wpilib.Joystick(0)

        def teleopPeriodic(self):
            self.motor.set(self.stick.getY())
    """

TESTS = """
    import sys

    def test_it(control, hal_data, robot):
        with control.run_robot():
            hal_data["joysticks"][0]["axes"][1] = 0.5
            control.step_timing(seconds=1.0, autonomous=False, enabled=True)
            assert hal_data["pwm"][0]["value"] == 0.5

    def test_that_fails(robot):
        print(sys.argv, __name__)
        assert robot.motor.get() == 1
    """

SCRIPT = [{"format": "pyfrc-input 1", "end": 1.0}, {"t": 0, "set": {"mode": "teleop"}}]

SHORT_MATCHES = "[tool.pyfrc.fuzz]\nmatch_seconds = 2\n"

FILES = {
    "pyproject.toml": SHORT_MATCHES,
    "robot.py": ROBOT,
    "tests/test_it.py": TESTS,
    "script.jsonl": "".join(json.dumps(line) + "\n" for line in SCRIPT),
    "sim/config.json": '{"pyfrc": {"robot": {"w": 2, "starting_y": 12}}}',
}

#: Words for each command, that let it do its work without a robot or a window.
WORDS = {
    "add-tests": [],
    "completion": ["bash"],
    "config": ["check"],
    "console": ["--no-such-option"],
    "coverage": ["fuzz", "--runs", "1", "-j", "2"],
    "create-physics": [],
    "deploy": ["--skip-tests", "--robot", "127.0.0.1:1"],
    "deploy-info": ["--robot", "127.0.0.1:1"],
    "doctor": ["--no-robot"],
    "fuzz": ["--runs", "1", "--seed", "1"],
    "init": [],
    "profile": ["--json", "profile.json", "test", "-j", "2"],
    "replay": ["script.jsonl", "--trace", "trace.jsonl"],
    "sim": ["--ui", "none", "--mode", "auto", "--seconds", "0.5", "--record", "auto.jsonl"],
    "test": ["--trace", "traces", "--", "-v"],
    "undeploy": ["--yes", "--robot", "127.0.0.1:1"],
    "virtual-robot": ["--directory", "disk", "--", "echo"],
}

#: What may be measured, and so differ from run to run: numbers, and lines that are drawn to their width.
MEASURED = re.compile(r"0x[0-9a-f]+|\d[\d.,]*|[-=]{3,}|(?<=\S)  +")


def told(result: Result, project: RobotProject) -> tuple[int, str, str]:
    def without_figures(text: str) -> str:
        # A campaign tells how far it is as often as it has time to: equal lines after one another count once.
        return re.sub(r"^(.*\n)\1+", r"\1", MEASURED.sub("~", text.replace(str(project.path), ".")), flags=re.MULTILINE)

    # `pyfrc profile` tells how often a loop took too long, if any did.
    stdout = "" if "profile.json" in result.stdout else result.stdout
    return result.code, without_figures(stdout), without_figures(result.stderr)


def left(directory: Path) -> dict[str, str]:
    """Its files; what is in them, where the robot's doings are."""
    files = (file for file in directory.rglob("*") if file.is_file() and "__pycache__" not in file.parts)
    return {
        file.relative_to(directory).as_posix(): file.read_text("utf-8") if "trace" in file.name else ""
        for file in files
        if ".pytest_cache" not in file.parts
    }


@pytest.mark.parametrize("command", sorted(COMMANDS.keys() - {"create-tests", "profiler"}))  # older names
def test_a_command_does_the_same_as_in_a_new_interpreter(command: str, make_shared_project: MakeProject) -> None:
    cold, warm = (make_shared_project({} if command == "init" else FILES) for _ in range(2))
    words = [command, *WORDS[command]]
    assert told(cold.run(*words, cold=True), cold) == told(warm.run(*words), warm)
    assert left(cold.path) == left(warm.path)
    assert left(warm.temporary) == {}


def test_plain_pytest_does_the_same_as_in_a_new_interpreter(make_shared_project: MakeProject) -> None:
    cold, warm = make_shared_project(FILES), make_shared_project(FILES)
    expected = told(cold.run("-v", program="pytest", cold=True), cold)
    assert told(warm.pytest("-v"), warm) == expected
    assert expected[0] == 1


def test_modules_are_found_where_a_variable_says(tmp_path: Path, make_project: MakeProject) -> None:
    code = """
        import os
        import sys

        import found_elsewhere

        started_by = open(f"/proc/{os.getppid()}/cmdline").read().split("\\0")[1]
        print(found_elsewhere.__file__, started_by.endswith("/warm_start.py"))
        print(sys.path, flush=True)
        os._exit(0)
        """
    project = make_project({"conftest.py": code})
    (tmp_path / "modules").mkdir()
    (tmp_path / "modules" / "found_elsewhere.py").touch()
    environment = {"PYTHONPATH": os.pathsep.join([str(tmp_path / "modules"), str(tmp_path / "missing")])}
    warm, cold = (project.run("-s", program="pytest", env=environment, cold=cold) for cold in (False, True))
    assert warm.stdout.splitlines()[0].endswith("found_elsewhere.py True"), warm.output
    assert "found_elsewhere.py False" in cold.stdout
    assert warm.stdout == cold.stdout.replace("found_elsewhere.py False", "found_elsewhere.py True")
    (tmp_path / "modules" / "sitecustomize.py").touch()
    assert "found_elsewhere.py False" in project.run("-s", program="pytest", env=environment).stdout


@pytest.mark.parametrize("end", ["os.kill(os.getpid(), 9)", "os._exit(77)", "sys.exit('enough')"])
def test_its_end_is_told(end: str, make_project: MakeProject) -> None:
    project = make_project({"conftest.py": f"import os\nimport sys\n\n{end}\n"})
    warm, cold = project.pytest(), project.run(program="pytest", cold=True)
    assert (warm.code, warm.stderr) == (cold.code, cold.stderr)
    assert warm.code


def test_it_is_told_what_is_typed(make_project: MakeProject) -> None:
    project = make_project(
        {"conftest.py": "import os\nimport sys\n\nprint(sys.stdin.read(), end='', flush=True)\nos._exit(0)\n"}
    )
    assert project.run("-s", program="pytest", stdin="ein\nWört\n").stdout.count("Wört\n") == 1
    assert "Wört" not in project.run("-s", program="pytest").stdout


def test_a_module_of_the_users_is_found_before_one_of_its_name(make_project: MakeProject) -> None:
    """It starts cold, where that module is the first to be imported."""
    code = "import os\nimport coverage\n\nprint(coverage.__file__, flush=True)\nos._exit(0)\n"
    project = make_project({"conftest.py": code, "coverage.py": ""})
    assert project.run("-s", program="pytest").stdout == f"{project.path / 'coverage.py'}\n"


def test_what_a_run_of_the_tests_leaves_hides_no_module(make_project: MakeProject) -> None:
    """There is a directory with the name of a package in pytest's cache; the next command starts warm, too."""
    project = make_project(FILES)
    project.run("test")
    assert (project.path / ".pytest_cache" / "v" / "pyfrc").is_dir()
    assert conftest._warm_starts().fit(project.path, conftest._environment())


def test_a_module_of_a_package_has_another_name(make_project: MakeProject) -> None:
    """It hides nothing that is imported already, so the command starts warm."""
    code = """
        import os
        import numbers
        import parts.numbers

        print(open(f"/proc/{os.getppid()}/cmdline").read().split("\\0")[1].endswith("/warm_start.py"))
        print(parts.numbers.__file__, hasattr(numbers, "Number"), flush=True)
        os._exit(0)
        """
    project = make_project({"conftest.py": code, "parts/__init__.py": "", "parts/numbers.py": ""})
    assert project.run("-s", program="pytest").stdout == f"True\n{project.path / 'parts/numbers.py'} True\n"


def test_it_ends_with_the_tests_that_wait_for_it(tmp_path: Path, make_project: MakeProject) -> None:
    os.mkfifo(tmp_path / "began")
    os.mkfifo(tmp_path / "never")
    waits = f"""
        import os

        with open({str(tmp_path / "began")!r}, "w") as file:
            file.write(str(os.getpid()))
        open({str(tmp_path / "never")!r})
        """
    project = make_project({"conftest.py": waits})
    code = f"""if True:
        import os, sys
        from pathlib import Path
        sys.path.insert(0, {str(Path(__file__).parent)!r})
        from warm_start import WarmStarts
        WarmStarts(os.environ).run("pytest", [], Path({str(project.path)!r}), os.environ, None)
        """
    with subprocess.Popen([sys.executable, "-c", code]) as tests:
        command = os.pidfd_open(int((tmp_path / "began").read_text()))
        tests.kill()
        select.select([command], [], [])  # for ever, if it went on
        os.close(command)


def test_a_new_interpreter_reads_what_a_fork_does_not(make_project: MakeProject) -> None:
    project = make_project(
        {"conftest.py": "import os\nimport sys\n\nprint(sys.flags.dev_mode, flush=True)\nos._exit(0)\n"}
    )
    assert "True" in project.run("-s", program="pytest", env={"PYTHONDEVMODE": "1"}).stdout
