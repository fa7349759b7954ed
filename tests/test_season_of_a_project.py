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
from conftest import MakeProject, Result
from loops import for_each

from pyfrc_core.config.robotpy import load_season_settings
from pyfrc_core.doctor.installed import find_installed
from pyfrc_core.doctor.robot_project import check_project
from pyfrc_core.errors import ProjectError
from pyfrc_core.project import find_project
from pyfrc_core.season import CURRENT, SEASONS, SeasonSetting, refuse_other_season
from pyfrc_core.test_support import autoload

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""
HERE = version("wpilib")
#: The other season, and a version of its WPILib.
OTHER = next(season for season in SEASONS.values() if season is not CURRENT)
THERE = OTHER.packages.wpilib

#: Commands that import WPILib.
COMMANDS = {
    "test": ("test", "--builtin"),
    "sim": ("sim", "--ui", "none", "--seconds", "1"),
    "fuzz": ("fuzz", "--time", "1"),
    "deploy": ("deploy", "--team", "1"),
    "replay": ("replay", "any.jsonl"),
    "coverage": ("coverage", "sim"),
    "create-physics": ("create-physics",),
}
FILES = {"robot.py": ROBOT, "tests/pyfrc_test.py": "from pyfrc.tests import *\n", "any.jsonl": ""}


def asks_for(wanted: str, *requires: str) -> str:
    return f'[tool.robotpy]\nrobotpy_version = "{wanted}"\nrequires = {list(requires)}\n'


def refused(result: Result, code: int = 2) -> None:
    assert result.code == code, result.output
    assert "Traceback" not in result.output
    assert "ImportError" not in result.output
    errors = [line for line in result.stderr.splitlines() if line.strip()]
    assert len(errors) == 2, errors  # what is wrong, and what to do


def sentence(tmp_path: Path, installed: str | None, wanted: str, *requires: str) -> str:
    """Return what is said of a project beside an installed WPILib; nothing: it fits."""
    pyproject = tmp_path / "pyproject.toml"
    pyproject.write_text(asks_for(wanted, *requires), "utf-8")
    try:
        refuse_other_season(installed, load_season_settings(pyproject))
    except ProjectError as error:
        return str(error)
    return ""


def test_what_is_said_of_two_seasons(tmp_path: Path) -> None:
    for wanted, installed, own, other in ((HERE, THERE, CURRENT, OTHER), (THERE, HERE, OTHER, CURRENT)):
        said = sentence(tmp_path, installed, wanted)
        assert said.startswith(f"pyproject.toml:2: robotpy_version is {wanted}, but wpilib {installed} is installed")
        instead = f'if its code is for {other.year}, write: robotpy_version = "{installed}"'
        assert f'Install the project\'s: pip install "{own.requirement}"; or, {instead}' in said
    library = OTHER.packages.commands
    said = sentence(tmp_path, HERE, HERE, library)
    assert said.startswith(f"pyproject.toml:2: robotpy_version is {HERE}, but requires has {library!r} in pyproject.to")
    assert "Write packages of one season there." in said
    said = sentence(tmp_path, "2027.0.0a7", "2025.3.2")  # a season from before them needs the oldest
    assert 'pip install "wpilib>=2026.2.2,<2027"; or, ' in said
    assert said.endswith(": pyfrc migrate")
    said = sentence(tmp_path, "2027.0.0a7", "2028.1.1")
    assert "robotpy_version is 2028.1.1, and this pyfrc runs robots of 2026 and 2027" in said


def test_what_is_said_of_wpilib_itself(tmp_path: Path) -> None:
    unknown = "wpilib 2028.1.1 is installed here, and this pyfrc runs robots of 2026 and 2027"
    old = "wpilib 2027.0.0a6 is installed here, and this pyfrc needs 2027.0.0a7 or newer"
    for installed, said in (("2028.1.1", unknown), ("2027.0.0a6", old), (None, "WPILib is not installed here")):
        assert sentence(tmp_path, installed, THERE).startswith(f"{said}\n")
    for season in SEASONS.values():
        to_install = f'Install the one of {season.year}: pip install "{season.requirement}"'
        assert sentence(tmp_path, None, season.packages.wpilib).endswith(to_install)


def test_what_fits(tmp_path: Path) -> None:
    """Earlier seasons are like the oldest that pyfrc knows."""
    for season in SEASONS.values():
        for wanted in (f"{season.year}.1.1", season.packages.wpilib, "newest", "ignored"):
            assert sentence(tmp_path, season.packages.wpilib, wanted) == "", wanted
    assert sentence(tmp_path, SEASONS[min(SEASONS)].packages.wpilib, "2025.3.2.0") == ""


def test_settings_of_two_seasons_are_refused_and_of_one_are_not() -> None:
    first = SeasonSetting("robotpy_version is 2026.2.2", 2026, "pyproject.toml:2")
    same, other = (SeasonSetting(f"requires has {year}", year, "pyproject.toml:3") for year in (2026, 2027))
    refuse_other_season("2026.2.2", [first, same])
    with pytest.raises(ProjectError, match=r"but requires has 2027 in .+, which is of another season"):
        refuse_other_season("2026.2.2", [first, same, other])


# -- what refuses it -------------------------------------------------------------------------------------------------


@for_each("command", COMMANDS)
def test_each_command_refuses_another_season(command: str, make_shared_project: MakeProject) -> None:
    project = make_shared_project(FILES | {"pyproject.toml": asks_for(THERE)})
    result = project.run_here(*COMMANDS[command])
    refused(result)
    assert result.first_error.startswith(f"pyproject.toml:2: robotpy_version is {THERE}, but wpilib {HERE} is ")


def test_so_do_the_doctor_and_plain_pytest(make_project: MakeProject) -> None:
    project = make_project(FILES | {"pyproject.toml": asks_for(THERE)})
    settings = load_season_settings(project.path / "pyproject.toml")
    first, *others = check_project(find_project(project.path), find_installed(), settings)
    assert first.text == f"pyproject.toml:2: robotpy_version is {THERE}, but wpilib {HERE} is installed here"
    assert "program" not in {each.topic for each in others}, "its import would fail by this"
    with pytest.raises(pytest.UsageError, match=f"^pyproject.toml:2: robotpy_version is {THERE}, but wpilib"):
        autoload._register(None, project.path)  # type: ignore[arg-type]


@pytest.mark.parametrize("commands", [["test"], pytest.param([*COMMANDS][1:], marks=pytest.mark.slow)], ids=len)
def test_without_wpilib(commands: list[str], make_project: MakeProject, tmp_path: Path) -> None:
    project = make_project(FILES | {"pyproject.toml": asks_for(THERE)})
    path = packages_without_wpilib(tmp_path / "site")
    to_install = f'Install the one of {OTHER.year}: pip install "{OTHER.requirement}"'
    for command in commands:
        result = run_with(path, project.path, "pyfrc", *COMMANDS[command])
        refused(result)
        assert result.first_error == "WPILib is not installed here"
        assert to_install in result.stderr
    if commands == ["test"]:
        result = run_with(path, project.path, "pytest")
        refused(result, code=4)
        assert to_install in result.output
        result = run_with(path, project.path, "pyfrc", "doctor", "--no-robot")
        assert result.code == 1
        assert to_install in result.output
        assert "Traceback" not in result.output


def run_with(path: str, directory: Path, program: str, *arguments: str) -> Result:
    """Run a program whose Python looks in no directory of packages but those that are named."""
    done = subprocess.run(
        [sys.executable, "-S", "-m", program, *arguments],
        cwd=directory,
        env=os.environ | {"PYTHONPATH": path},
        capture_output=True,
        encoding="utf-8",
    )
    return Result(done.returncode, done.stdout, done.stderr)


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


def test_ready_made_tests_beside_an_unknown_wpilib(make_project: MakeProject, tmp_path: Path) -> None:
    information = tmp_path / "wpilib-2027.0.0a6.dist-info"
    information.mkdir()
    (information / "METADATA").write_text("Metadata-Version: 2.1\nName: wpilib\nVersion: 2027.0.0a6\n", "utf-8")
    result = make_project(FILES).run(program="pytest", env={"PYTHONPATH": str(tmp_path)}, cold=True)
    assert result.code == 2
    text = "pyfrc: wpilib 2027.0.0a6 is installed here, and this pyfrc needs 2027.0.0a7 or newer"
    assert text in result.blocks()["ERROR collecting tests/pyfrc_test.py"]
    assert "Traceback" not in result.output
    assert "import *" not in result.output
