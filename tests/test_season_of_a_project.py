"""The season of a project, and that of the installed WPILib: where they contradict, one sentence says what to do.

The tests of `tests/season_2027` do the same where WPILib 2027 is installed.
"""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from conftest import MakeProject, Result, RobotProject, sampled

from pyfrc_core.config.robotpy import load_season_settings
from pyfrc_core.errors import ProjectError
from pyfrc_core.season import CURRENT, SEASONS, SeasonSetting, refuse_other_season

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""
HERE = version("wpilib")
#: The other season, and a version of its WPILib.
OTHER = next(season for season in SEASONS.values() if season is not CURRENT)
THERE = OTHER.packages.wpilib

#: Exit code 1 is a doctor's problem, 4 is pytest's usage error.
COMMANDS = {
    "test": ("pyfrc", ("test", "--builtin"), 2),
    "sim": ("pyfrc", ("sim", "--ui", "none", "--seconds", "1"), 2),
    "fuzz": ("pyfrc", ("fuzz", "--time", "1"), 2),
    "deploy": ("pyfrc", ("deploy", "--team", "1"), 2),
    "doctor": ("pyfrc", ("doctor", "--no-robot"), 1),
    "pytest": ("pytest", (), 4),
}
#: Further commands that import WPILib.
OTHERS = {
    "replay": ("pyfrc", ("replay", "any.jsonl"), 2),
    "coverage": ("pyfrc", ("coverage", "sim"), 2),
    "create-physics": ("pyfrc", ("create-physics",), 2),
}
FILES = {"robot.py": ROBOT, "tests/pyfrc_test.py": "from pyfrc.tests import *\n"}


def asks_for(wanted: str, *requires: str) -> str:
    return f'[tool.robotpy]\nrobotpy_version = "{wanted}"\nrequires = {list(requires)}\n'


def with_wpilib(directory: Path, number: str) -> dict[str, str]:
    """Make WPILib's metadata of another version, and return the environment in which it is the installed one."""
    information = directory / f"wpilib-{number}.dist-info"
    information.mkdir()
    (information / "METADATA").write_text(f"Metadata-Version: 2.1\nName: wpilib\nVersion: {number}\n", "utf-8")
    return {"PYTHONPATH": str(directory)}


def run(project: RobotProject, command: str, env: dict[str, str] | None = None) -> Result:
    """Run a command, and check what is the same of each that is refused."""
    program, arguments, code = COMMANDS[command]
    result = project.run(*arguments, program=program, env=env, cold=program == "pytest")
    refused(command, result, code)
    return result


def refused(command: str, result: Result, code: int) -> None:
    assert result.code == code, result.output
    assert "Traceback" not in result.output
    assert "ImportError" not in result.output
    if command != "doctor":
        errors = [line for line in result.stderr.splitlines() if line.strip()]
        assert len(errors) == 2, errors  # what is wrong, and what to do


@pytest.mark.parametrize("command", sampled(COMMANDS, *list(COMMANDS)[:1]))
def test_a_project_of_this_season_beside_wpilib_of_the_other(
    command: str, make_project: MakeProject, tmp_path: Path
) -> None:
    project = make_project(FILES | {"pyproject.toml": asks_for(HERE)})
    result = run(project, command, with_wpilib(tmp_path, THERE))
    assert f"pyproject.toml:2: robotpy_version is {HERE}, but wpilib {THERE} is installed here" in result.output
    assert f'Install the project\'s: pip install "{CURRENT.requirement}"; or, if its code' in result.output


@pytest.mark.parametrize("command", sampled(COMMANDS, *list(COMMANDS)[:1]))
def test_a_project_of_the_other_season_beside_this_wpilib(command: str, make_project: MakeProject) -> None:
    project = make_project(FILES | {"pyproject.toml": asks_for(THERE)})
    result = run(project, command)
    assert f"pyproject.toml:2: robotpy_version is {THERE}, but wpilib {HERE} is installed here" in result.output
    assert (
        f'Install the project\'s: pip install "{OTHER.requirement}"; or, if its code is for {CURRENT.year}, '
        f'write: robotpy_version = "{HERE}"' in result.output
    )


@pytest.mark.parametrize("command", sampled(COMMANDS, *list(COMMANDS)[:1]))
def test_settings_that_contradict_each_other(command: str, make_project: MakeProject) -> None:
    library = SEASONS[OTHER.year].packages.commands
    project = make_project(FILES | {"pyproject.toml": asks_for(HERE, library)})
    result = run(project, command)
    assert f"pyproject.toml:2: robotpy_version is {HERE}, but requires has {library!r} in pyproject.toml:3" in (
        result.output
    )
    assert "Write packages of one season there." in result.output


@pytest.mark.parametrize("command", sampled([*COMMANDS, *OTHERS], "test", "pytest", "doctor"))
def test_without_wpilib(command: str, make_project: MakeProject, tmp_path: Path) -> None:
    project = make_project(FILES | {"pyproject.toml": asks_for(THERE), "any.jsonl": ""})
    program, arguments, code = (COMMANDS | OTHERS)[command]
    done = subprocess.run(
        # Python looks in no directory of packages but the one that is named.
        [sys.executable, "-S", "-m", program, *arguments],
        cwd=project.path,
        env=os.environ | {"PYTHONPATH": packages_without_wpilib(tmp_path / "site")},
        capture_output=True,
        encoding="utf-8",
    )
    result = Result(done.returncode, done.stdout, done.stderr)
    refused(command, result, code)
    assert "WPILib is not installed here" in result.output
    assert f'Install the one of {OTHER.year}: pip install "{OTHER.requirement}"' in result.output


def packages_without_wpilib(directory: Path) -> str:
    """Make a directory with links to the installed packages except WPILib, and return the path of modules."""
    directory.mkdir()
    path = [directory]
    for place in (Path(each) for each in sys.path if Path(each).is_dir()):
        if place.name != "site-packages":
            path.append(place)  # the standard library, and where pyfrc is
            continue
        for each in place.iterdir():
            link = directory / each.name
            if not each.name.startswith("wpilib") and not link.exists():
                link.symlink_to(each)
    return os.pathsep.join(map(str, path))


@pytest.mark.parametrize("command", sampled(COMMANDS, *list(COMMANDS)[:1]))
def test_wpilib_of_an_unknown_season(command: str, make_project: MakeProject, tmp_path: Path) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": "def test_a():\n    pass\n"})
    env = with_wpilib(tmp_path, "2028.1.1")
    text = "wpilib 2028.1.1 is installed here, and this pyfrc runs robots of 2026 and 2027"
    if command == "pytest":  # its own tool may have fixtures of the same names
        result = project.run(program="pytest", env=env, cold=True)
        assert result.code == 0, result.output
        assert f"pyfrc: not active: {text}" in result.stdout
    else:
        result = run(project, command, env)
        assert text in result.output
        assert 'pip install "wpilib>=2026.2.2,<2027"' in result.output


def test_ready_made_tests_beside_an_unknown_wpilib(make_project: MakeProject, tmp_path: Path) -> None:
    result = make_project(FILES).run(program="pytest", env=with_wpilib(tmp_path, "2027.0.0a6"), cold=True)
    assert result.code == 2
    text = "pyfrc: wpilib 2027.0.0a6 is installed here, and this pyfrc needs 2027.0.0a7 or newer"
    assert text in result.blocks()["ERROR collecting tests/pyfrc_test.py"]
    assert "Traceback" not in result.output
    assert "import *" not in result.output


#: Earlier seasons are like the oldest that pyfrc knows.
FITTING = [f"{CURRENT.year}.1.1", "newest", "ignored", *(["2025.3.2.0"] if CURRENT.year == min(SEASONS) else [])]


@pytest.mark.parametrize("wanted", sampled(FITTING, *list(FITTING)[:1]))
def test_a_project_of_this_season_or_an_earlier_one_runs(wanted: str, make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": asks_for(wanted)})
    assert project.run("test", "--builtin").code == 0


def test_a_project_from_before_them_needs_the_oldest(tmp_path: Path) -> None:
    pyproject = tmp_path / "pyproject.toml"
    pyproject.write_text(asks_for("2025.3.2"), "utf-8")
    refuse_other_season("2026.2.2", load_season_settings(pyproject))
    with pytest.raises(ProjectError, match=r'"wpilib>=2026[.]2[.]2,<2027"; or, .+: pyfrc migrate$'):
        refuse_other_season("2027.0.0a7", load_season_settings(pyproject))


def test_a_project_of_a_season_that_pyfrc_does_not_know(tmp_path: Path) -> None:
    pyproject = tmp_path / "pyproject.toml"
    pyproject.write_text(asks_for("2028.1.1"), "utf-8")
    with pytest.raises(ProjectError, match=r"robotpy_version is 2028.* runs robots of 2026 and 2027"):
        refuse_other_season("2027.0.0a7", load_season_settings(pyproject))


def test_settings_of_two_seasons_are_refused_and_of_one_are_not() -> None:
    first = SeasonSetting("robotpy_version is 2026.2.2", 2026, "pyproject.toml:2")
    same, other = (SeasonSetting(f"requires has {year}", year, "pyproject.toml:3") for year in (2026, 2027))
    refuse_other_season("2026.2.2", [first, same])
    with pytest.raises(ProjectError, match=r"but requires has 2027 in .+, which is of another season"):
        refuse_other_season("2026.2.2", [first, same, other])
