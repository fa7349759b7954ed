"""The season of a project, and that of the installed WPILib: where they contradict, one sentence says what to do."""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path

import pytest
from conftest import MakeProject

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""
HERE = version("wpilib")

COMMANDS = {
    "test": ("test", "--builtin"),
    "sim": ("sim", "--ui", "none", "--seconds", "1"),
    "fuzz": ("fuzz", "--time", "1"),
    "deploy": ("deploy", "--team", "1"),
}


def asks_for(wanted: str) -> str:
    return f'[tool.robotpy]\nrobotpy_version = "{wanted}"\n'


@pytest.mark.parametrize("command", COMMANDS)
def test_an_installed_wpilib_of_an_unknown_season_is_refused(
    command: str, make_project: MakeProject, tmp_path: Path
) -> None:
    information = tmp_path / "wpilib-2027.0.0a7.dist-info"
    information.mkdir()
    (information / "METADATA").write_text("Metadata-Version: 2.1\nName: wpilib\nVersion: 2027.0.0a7\n", "utf-8")
    project = make_project({"robot.py": ROBOT})
    result = project.run(*COMMANDS[command], env={"PYTHONPATH": str(tmp_path)})
    assert result.code == 2
    assert "wpilib 2027.0.0a7 is installed here, and this pyfrc runs robots of 2026" in result.stderr
    assert 'pip install "wpilib>=2026.2.2,<2027"' in result.stderr
    assert "Traceback" not in result.output


@pytest.mark.parametrize("command", COMMANDS)
def test_a_project_of_a_later_season_is_refused(command: str, make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": asks_for("2027.1.1")})
    result = project.run(*COMMANDS[command])
    assert result.code == 2
    assert "pyproject.toml:2: robotpy_version is 2027.1.1, and this pyfrc runs robots of 2026" in result.stderr
    assert f'or write: robotpy_version = "{HERE}"' in result.stderr


def test_doctor_reports_it(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": asks_for("2027.1.1")})
    result = project.run("doctor")
    assert result.code == 1
    assert "pyproject.toml:2: robotpy_version is 2027.1.1" in result.output


@pytest.mark.parametrize("wanted", ["2025.3.2.0", "2026.1.1", "newest"])
def test_a_project_of_this_season_or_an_earlier_one_runs(wanted: str, make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": asks_for(wanted)})
    assert project.run("test", "--builtin").code == 0
