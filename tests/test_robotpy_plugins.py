"""Our commands as `robotpy` runs them: with its own command line, which WPILib brings, and as its plug-ins are used."""

from __future__ import annotations

import argparse
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from pyfrc_cli import start
from pyfrc_cli.robotpy_plugins import command_line

NAMES = ["add-tests", "coverage", "create-physics", "profiler", "sim", "test"]

ROBOT = {"robot.py": "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"}
FAILING = ROBOT | {"tests/test_it.py": "def test_passes():\n    pass\n\ndef test_fails():\n    assert 0\n"}


@pytest.fixture
def become(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """What the plug-ins would have become; here they end with 7."""
    commands: list[list[str]] = []

    def become(command: list[str]) -> int:
        commands.append(command)
        return 7

    monkeypatch.setattr(start, "become", become)
    return commands


def run_as_robotpy_does(words: list[str], main_file: Path) -> int:
    """Its parser has a parser for each plug-in; `run` gets what it names."""
    parser = argparse.ArgumentParser(prog="robotpy")
    commands = parser.add_subparsers(dest="command")
    plugins = {}
    for point in entry_points(group="robotpy_cli.2026"):
        if point.dist is not None and point.dist.name == "pyfrc":
            plugins[point.name] = point.load()(commands.add_parser(point.name))
    assert sorted(plugins) == NAMES
    options = vars(parser.parse_args(words))
    return plugins[options["command"]].run(main_file=main_file, arguments=options["arguments"])  # type: ignore[no-any-return]


@pytest.mark.parametrize("name", NAMES)
def test_a_plugin_hands_on_all_that_stands_behind_its_name(name: str, become: list[list[str]], tmp_path: Path) -> None:
    words = ["-h", "--builtin", "-j", "2", "file.py", "--nonsense=3"]
    assert run_as_robotpy_does([name, *words], tmp_path / "robot.py") == 7
    (command,) = become
    assert command[:4] == [sys.executable, "-m", "pyfrc", name]
    rest = command[4:]
    place = rest.index("--project")
    assert rest[place : place + 2] == ["--project", str(tmp_path)]
    assert rest[:place] + rest[place + 2 :] == words


@pytest.mark.parametrize("name", ["coverage", "profiler"])
def test_the_project_is_told_to_the_command_that_is_measured(name: str) -> None:
    words = ["--json", "report", "sim", "--mode", "auto"]
    here = Path("somewhere", "robot.py")
    assert command_line(name, here, words) == [
        *(name, "--json", "report", "sim", "--project", "somewhere", "--mode", "auto")
    ]
    assert command_line(name, here, []) == [name, "--project", "somewhere"]


def test_a_main_file_of_another_name_is_named() -> None:
    assert command_line("test", Path("/p/my_robot.py"), ["--builtin"]) == [
        "test",
        "--main",
        "/p/my_robot.py",
        "--builtin",
    ]


def test_robotpy_runs_our_tests(make_project) -> None:
    project = make_project(ROBOT)
    result = project.run("--main", "robot.py", "test", "--builtin", program="robotpy")
    assert result.code == 0, result.output
    assert "pyfrc.tests ...." in result.stdout


@pytest.mark.slow
def test_robotpy_ends_as_our_command_does(make_project) -> None:
    project = make_project(FAILING)
    result = project.run("test", "--", "-v", program="robotpy")
    assert result.code == 1, result.output
    assert result.outcomes() == {"tests/test_it.py::test_passes": "PASSED", "tests/test_it.py::test_fails": "FAILED"}
    assert project.run("test", "--", "-k", "none_such", program="robotpy").code == 5
    wrong = project.run("test", "--jbos", "2", program="robotpy")
    assert wrong.code == 2
    assert "Did you mean '--jobs'?" in wrong.stderr


def test_robotpy_adds_tests(make_project) -> None:
    project = make_project(ROBOT)
    result = project.run("add-tests", program="robotpy")
    assert result.code == 0, result.output
    assert (project.path / "tests/pyfrc_test.py").is_file()
