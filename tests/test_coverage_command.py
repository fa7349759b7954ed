"""`pyfrc coverage`: lines count wherever they run, the figures are coverage.py's, and unused functions are listed."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from conftest import SHORT_MATCH, MakeProject, RobotProject, sampled
from loops import for_each

from pyfrc_core.measure.coverage import never_run

#: Each of its helpers runs in one place only.
ROBOT = """
    import threading

    import wpilib

    import helpers


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = wpilib.Joystick(0)
            self.notifier = wpilib.Notifier(helpers.in_a_notifier)
            threading.Thread(target=self.work, daemon=True).start()

        def work(self):
            wpilib.wait(0.1)
            helpers.in_a_thread()

        def autonomousInit(self):
            helpers.in_autonomous()

        def teleopInit(self):
            self.notifier.startSingle(0.1)

        def teleopPeriodic(self):
            if self.stick.getRawButton(3):
                helpers.with_button_pressed()
"""

HELPERS = """
    def in_a_thread():
        return 1


    def in_a_notifier():
        return 1


    def in_autonomous():
        return 1


    def with_button_pressed():
        return 1


    class Unused:
        def short(self):
            return 1

        def long(self):
            first = 1
            second = 2

            def inner():
                return first + second

            return inner()

        def only_documented(self):
            \"\"\"There is nothing in it to be run.\"\"\"
"""

TESTS = """
    def test_autonomous(control):
        control.set_autonomous(enabled=True)
        control.run_test(lambda tm: tm < 1)


    def test_teleop(control):
        control.set_operator_control(enabled=True)
        control.run_test(lambda tm: tm < 1)
"""

FILES = {"robot.py": ROBOT, "helpers.py": HELPERS, "tests/test_a.py": TESTS, "pyproject.toml": SHORT_MATCH}


@pytest.fixture(scope="module")
def project(make_shared_project: MakeProject) -> RobotProject:
    return make_shared_project(FILES)


def measured(project: RobotProject, *command: str) -> dict[str, Any]:
    """What coverage.py says as JSON of a command that passes."""
    result = project.run("coverage", "--json", "coverage.json", *command)
    assert result.code == 0, result.output
    assert list(project.path.rglob(".coverage*")) == []
    report: dict[str, Any] = json.loads((project.path / "coverage.json").read_text("utf-8"))
    return report


def functions_run(report: dict[str, Any]) -> set[str]:
    functions = report["files"]["helpers.py"]["functions"]
    return {name for name, function in functions.items() if name and function["executed_lines"]}


@pytest.mark.parametrize("isolation", sampled(["auto", "reuse", "none"], "auto"))
def test_lines_in_threads_and_isolated_tests_count(project: RobotProject, isolation: str) -> None:
    tests = () if isolation != "none" else ("--", "-k", "teleop")
    report = measured(project, "--fail-under", "40", "test", "--isolation", isolation, *tests)
    expected = {"in_a_thread", "in_a_notifier", "in_autonomous"} - ({"in_autonomous"} if tests else set())
    assert functions_run(report) == expected


@pytest.mark.slow
def test_lines_that_only_a_fuzz_match_runs_count(project: RobotProject) -> None:
    report = measured(project, "fuzz", "--runs", "2", "-j", "2")
    assert functions_run(report) == {"in_a_thread", "in_a_notifier", "in_autonomous", "with_button_pressed"}


@pytest.mark.slow
def test_the_figures_equal_those_of_coverage_by_hand(project: RobotProject) -> None:
    assert project.run("test", "--record", "scripts", "--", "-k", "teleop").code == 0
    (script,) = (project.path / "scripts").glob("*teleop.jsonl")
    report = measured(project, "replay", str(script))
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("COVERAGE_", "PYTEST_"))}
    for by_hand in (
        ["run", "--source", ".", "--omit", "tests/*", "-m", "pyfrc", "replay", str(script)],
        ["json", "-o", "by-hand.json"],
    ):
        subprocess.run(
            [sys.executable, "-m", "coverage", *by_hand],
            cwd=project.path,
            env=environment | {"PYTHONHASHSEED": "0", "COVERAGE_FILE": str(project.temporary / "by-hand")},
            check=True,
            capture_output=True,
        )
    expected = json.loads((project.path / "by-hand.json").read_text("utf-8"))
    assert report["files"] == expected["files"]
    assert report["totals"] == expected["totals"]
    assert 0 < report["totals"]["percent_covered"] < 100


@for_each(
    "words, complaint",
    [
        ((), "Missing argument 'COMMAND"),
        (("tets",), "'tets' is not a command that can be measured. These can: test, "),
        (("init",), "'init' is not a command that can be measured"),
        (("test", "--no-such-option"), "No such option"),
        (("test", "--coverage"), "coverage is already being measured"),
        (("coverage", "test"), "'coverage' is not a command that can be measured"),
        (("--xml", ".", "test"), "--xml . cannot be written: it is a directory"),
        (("--json", "robot.py/report.json", "test"), " cannot be written: robot.py is a file"),
        (("--html", "robot.py", "test"), " cannot be written: robot.py is a file"),
        (("test", "--project", "nowhere"), "there is no directory nowhere"),
    ],
)
def test_what_cannot_be_is_said(project: RobotProject, words: tuple[str, ...], complaint: str) -> None:
    result = project.run_here("coverage", *words)
    assert result.code == 2
    assert complaint in result.stderr
    assert "Traceback" not in result.output


@pytest.mark.slow
def test_the_wrapped_commands_project_is_measured(project: RobotProject, tmp_path: Path) -> None:
    result = project.run("coverage", "test", "--project", str(project.path), cwd=tmp_path)
    assert result.code == 0, result.output
    assert re.search(r"helpers\.py +\d+ ", result.stdout)


def test_the_worst_file_comes_first_and_in_it_the_longest_function() -> None:
    def function(missing: list[int], executed: list[int], start: int) -> dict[str, Any]:
        return {"missing_lines": missing, "executed_lines": executed, "start_line": start}

    report = {
        "files": {
            "good.py": {"functions": {"run": function([3], [2], 1), "": function([9], [], 1)}},
            "bad.py": {"functions": {"short": function([2], [], 1), "long": function([5, 6], [], 4)}},
            "worst.py": {"functions": {"f": function([2, 3, 4, 5], [], 1)}},
            "as_bad.py": {"functions": {"f": function([2, 3, 4], [], 1)}},
        }
    }
    assert never_run(report).splitlines()[2:] == [
        "worst.py: 1 function, 4 lines",
        "  f (worst.py:1), 4 lines",
        "as_bad.py: 1 function, 3 lines",
        "  f (as_bad.py:1), 3 lines",
        "bad.py: 2 functions, 3 lines",
        "  long (bad.py:4), 2 lines",
        "  short (bad.py:1), 1 line",
    ]
    assert never_run({"files": {}}) == ""


@pytest.mark.slow
def test_lines_that_a_simulation_runs_count(project: RobotProject) -> None:
    report = measured(project, "sim", "--ui", "none", "--mode", "practice", "--nt-port", "0")
    assert functions_run(report) == {"in_a_thread", "in_a_notifier", "in_autonomous"}
