"""Which tests `pyfrc test` runs: the project's, the ready-made ones, and both; in directories of any name."""

from __future__ import annotations

import re
import sys

import pytest

ROBOT = "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
OWN = "def test_own(robot):\n    pass\n"
READY_MADE = {"autonomous", "disabled", "operator_control", "practice"}


def ran(result) -> list[str]:
    return [re.sub(r".*::test_|\[.*", "", name) for name in result.outcomes()]


@pytest.mark.parametrize(
    ("tests", "expected", "line"),
    [
        pytest.param(*(None, READY_MADE, "4 ready-made tests and 0 other tests"), marks=pytest.mark.slow),
        ("from pyfrc.tests import *\n", {*READY_MADE, "fuzz"}, "5 ready-made tests and 0 other tests"),
        ("from pyfrc.tests import test_practice\n" + OWN, {*READY_MADE, "own"}, "4 ready-made tests and 1 other test"),
    ],
)
def test_builtin_runs_each_ready_made_test_once(make_project, tests: str | None, expected: set[str], line: str) -> None:
    project = make_project({"robot.py": ROBOT, **({"tests/pyfrc_test.py": tests} if tests is not None else {})})
    result = project.run("test", "--builtin", "--no-isolation", "--", "-v")
    assert result.code == 0, result.output
    names = ran(result)
    assert set(names) == expected
    assert len(names) == len(expected)
    assert f"--builtin: {line}\n" in result.stdout


#: Part of a name for each thing that pytest would replace, or take for something else. Windows has no `:` in names.
ODD = "a $HOME [1] %PATH%" + ("" if sys.platform == "win32" else " b::c")


@pytest.mark.slow
def test_a_project_in_a_directory_with_any_name(make_project) -> None:
    files = {f"{ODD}/robot.py": ROBOT, f"{ODD}/tests/test_a.py": OWN, f"{ODD}/pytest.ini": "[pytest]\nmarkers = odd\n"}
    project = make_project(files)
    inside = project.path / ODD
    for result in (
        project.run("coverage", "test", cwd=inside),
        project.run("coverage", "test", "--project", ODD),
        project.run("profile", "test", "--project", ODD, "--isolation", "reuse"),
        project.run("test", "--project", ODD, "--", f"{ODD}/tests/test_a.py::test_own", "--junitxml=report.xml"),
    ):
        assert result.code == 0, result.output
        assert "1 passed" in result.stdout
        assert "configfile: pytest.ini" in result.stdout
        assert "test_a.py " not in result.stdout.partition("Cover")[2], "tests are not measured"
    assert (project.path / "report.xml").is_file(), "paths are relative to the user's directory"


def test_an_error_of_pytest_gives_no_advice_about_tests(make_project) -> None:
    ini = "[pytest]\naddopts = nowhere.py\n"
    result = make_project({"robot.py": ROBOT, "tests/test_a.py": OWN, "pytest.ini": ini}).run("test")
    assert result.code == 4
    assert "file or directory not found: nowhere.py" in result.output
    assert "files without tests" not in result.output
