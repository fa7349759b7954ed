"""Wrong settings, wrong options, the wrong directory: each gives one sentence and a remedy."""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import MakeProject
from loops import for_each
from test_failures import ANY_TEST, ROBOT

from pyfrc_cli.main import COMMANDS, OTHER_NAMES


@pytest.mark.parametrize(
    ("settings", "line", "message", "remedy"),
    [
        ("[tool.pyfrc.match]\ntelop = 1\n", 2, "unknown key 'tool.pyfrc.match.telop'", "did you mean 'teleop'?"),
        ("[tool.pyfrc]\n\nrobot_clas = 1\n", 3, "unknown key 'tool.pyfrc.robot_clas'", "did you mean 'robot_class'?"),
        ('[tool.pyfrc.match]\nteleop = "long"\n', 2, "tool.pyfrc.match.teleop = 'long': input should be a valid", ""),
        ("[tool.pyfrc.match]\n# s\nteleop = -1\n", 3, "tool.pyfrc.match.teleop = -1: ", "greater than 0"),
        ('[tool.pyfrc.test]\njobs = "many"\n', 2, "tool.pyfrc.test.jobs = 'many': ", "'auto'"),
        ('[tool.pyfrc.test]\nisolation = "full"\n', 2, "tool.pyfrc.test.isolation = 'full': ", "'reuse'"),
        ('[tool.pyfrc.test]\nisolation = "spawn"\n', 2, "tool.pyfrc.test.isolation = 'spawn': ", "Write reuse"),
    ],
    ids=[
        "unknown-key",
        "unknown-top-key",
        "wrong-type",
        "out-of-range",
        "neither-of-two",
        "not-a-choice",
        "no-choice-any-more",
    ],
)
def test_a_wrong_setting_is_told_with_its_line(
    make_project: MakeProject, settings: str, line: int, message: str, remedy: str
) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": ANY_TEST, "pyproject.toml": settings})
    result = project.run_here("test")
    assert result.code == 2, result.output
    assert result.first_error.startswith(f"pyproject.toml:{line}: {message}")
    assert remedy in result.stderr
    assert "Traceback" not in result.output


def test_a_broken_pyproject_toml_is_told_with_its_line(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": "[tool.pyfrc]\nmain =\n"})
    result = project.run_here("test")
    assert result.code == 2, result.output
    assert result.first_error.startswith("pyproject.toml")
    assert "not valid TOML: " in result.first_error
    assert "line 2" in result.first_error
    assert "Traceback" not in result.output


@pytest.mark.parametrize("name", ["mian", "main"])
def test_plain_pytest_tells_wrong_settings_in_a_sentence(make_project: MakeProject, name: str) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": f'[tool.pyfrc]\n{name} = "nothing.py"\n'})
    result = project.pytest()
    assert result.code == 4
    assert "INTERNALERROR" not in result.output
    assert name in result.output


@pytest.mark.parametrize("command", [["test"], ["--help"]])
def test_a_current_directory_that_was_removed(command: list[str], tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    script = f'rmdir "$PWD" && exec {shlex.join([sys.executable, "-m", "pyfrc", *command])}'
    ended = subprocess.run(["sh", "-c", script], cwd=gone, capture_output=True, text=True, check=False)
    assert ended.returncode == 2
    assert ended.stderr.startswith("error: the current directory cannot be found: ")
    assert "Traceback" not in ended.stderr


def test_a_project_without_tests_is_told_where_they_are_looked_for(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT})
    result = project.run_here("test")
    assert result.code == 1, result.output
    assert "test_*.py" in result.stderr
    assert str(project.path / "tests") in result.stderr
    assert str(project.path.parent / "tests") in result.stderr
    assert "pyfrc test --builtin" in result.stderr


@pytest.mark.parametrize(
    "words",
    [
        "sim --log a.wpilog --log b.wpilog",
        "profile sim --log a.wpilog --log=b.wpilog",
        "view a.wpilog --page a --page b",
    ],
)
def test_an_option_that_is_given_twice_is_refused(words: str, make_project: MakeProject) -> None:
    result = make_project({"robot.py": ROBOT}).run_here(*words.split())
    assert result.code == 2
    option = "--page" if "--page" in words else "--log"
    assert f"Error: {option} is given twice: give it once." in result.stderr


def test_outside_of_a_project_there_is_a_remedy(make_project: MakeProject) -> None:
    project = make_project({"notes.txt": "No robot here."})
    result = project.run_here("test")
    assert result.code == 2
    assert f"there is no robot.py in or above {project.path}" in result.first_error
    for remedy in ("--project", "pyfrc init"):
        assert remedy in result.stderr


@for_each(
    "args, message",
    [
        (["--jobs", "none"], "'none' is neither a number of processes, 1 or more, nor 'auto'"),
        (["--jobs", "0"], "'0' is neither a number of processes, 1 or more, nor 'auto'"),
        (["--seed", "-1"], "--seed"),
        (["--project", "nowhere"], "there is no directory nowhere"),
        (["--main", "nothing.py"], "there is no file nothing.py"),
    ],
)
def test_a_wrong_option_is_told(make_shared_project: MakeProject, args: list[str], message: str) -> None:
    result = make_shared_project({"robot.py": ROBOT}).run_here("test", *args)
    assert result.code == 2
    assert message in result.stderr
    assert "Traceback" not in result.stderr


@for_each(
    "words, remedy",
    [
        ("deploy 10.12.34.2", "Write: pyfrc deploy --robot 10.12.34.2"),
        ("deploy roborio-1234-frc.local", "Write: pyfrc deploy --robot roborio-1234-frc.local"),
        ("deploy roboRIO-1234-FRC --skip-tests", "Write: pyfrc deploy --robot roboRIO-1234-FRC"),
        ("deploy-info 127.0.0.1:2222", "Write: pyfrc deploy-info --robot 127.0.0.1:2222"),
        ("undeploy 1234", "Write: pyfrc undeploy --team 1234"),
        ("console 10.12.34.2", "Write: pyfrc console --robot 10.12.34.2"),
        ("sim tests", "To simulate the project in it: pyfrc sim --project tests"),
        ("sim tests/a.wpilog", "To run your code with the inputs of a log: pyfrc sim --log tests/a.wpilog"),
        ("sim robot.py", "pyfrc finds the robot's file. Use --main FILE if it is not called robot.py."),
        ("sync robot.py", "pyfrc finds the robot's file."),
        ("view --log a.wpilog", "To look at a log: pyfrc view FILE. To run your code with its inputs: pyfrc sim --log"),
        ("deploy everything", "unexpected extra argument (everything)"),
        ("download", "There is no command 'download'. To download what the robot needs: pyfrc sync"),
        ("run", "There is no command 'run'. To run the robot on this computer: pyfrc sim. To start it on the robot: "),
        ("rollback", "There is no command 'rollback'. To go back to an earlier release: pyfrc deploy --rollback"),
    ],
)
def test_what_other_tools_call_otherwise_leads_to_what_exists(
    make_shared_project: MakeProject, words: str, remedy: str
) -> None:
    result = make_shared_project({"robot.py": ROBOT, "tests/a.wpilog": ""}).run_here(*words.split())
    assert (result.code, result.stdout) == (2, "")
    assert "Did you mean" not in result.stderr
    assert remedy in result.stderr.splitlines()[-1]


def test_every_command_that_is_named_in_place_of_another_exists() -> None:
    for name, text in OTHER_NAMES.items():
        assert name not in COMMANDS
        assert {words.split()[0].rstrip(".") for words in text.split("pyfrc ")[1:]} <= set(COMMANDS)
