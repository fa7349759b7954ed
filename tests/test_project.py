"""Where the robot is: found from anywhere in the project, chosen by options or settings."""

from __future__ import annotations

from pathlib import Path

import pytest
from conftest import MakeProject, RobotProject
from loops import for_each

from pyfrc import __version__
from pyfrc_core.errors import ProjectError
from pyfrc_core.project import find_project

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        name = "found"
"""

FINDS_IT = """
    def test_found(control, robot):
        control.run_test(lambda tm: tm < 1)
        assert robot.name == "found"
"""


def assert_finds_it(project: RobotProject, *args: str | Path, cwd: Path | None = None) -> None:
    result = project.run("test", *args, cwd=cwd)
    assert result.code == 0, result.output
    assert "1 passed" in result.stdout


NAMED = '[tool.pyfrc]\nmain = "src/practice.py"\n'


@for_each(
    "files, here, options, found",
    [
        ({"robot.py": ""}, "deploy/paths", {}, "robot.py"),
        ({"robot.py": ""}, None, {"start": "."}, "robot.py"),
        ({"practice.py": ""}, ".", {"main": "practice.py"}, "practice.py"),
        ({"src/practice.py": ""}, None, {"start": "src", "main": "practice.py"}, "src/practice.py"),
        ({"src/practice.py": "", "pyproject.toml": NAMED}, ".", {}, "src/practice.py"),
        ({"src/practice.py": "", "pyproject.toml": NAMED}, "src", {}, "src/practice.py"),
        # Settings win over a robot.py beside them.
        ({"robot.py": "", "src/practice.py": "", "pyproject.toml": NAMED}, ".", {}, "src/practice.py"),
    ],
)
def test_a_program_is_found_from_below_by_an_option_and_by_settings(
    files: dict[str, str],
    here: str | None,
    options: dict[str, str],
    found: str,
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A directory that the user names is one of the project, from which `here` may be far away."""
    root = tmp_path_factory.mktemp("project")
    for name, text in files.items():
        (root / name).parent.mkdir(exist_ok=True)
        (root / name).write_text(text)
    place = tmp_path_factory.mktemp("elsewhere") if here is None else root / here
    place.mkdir(parents=True, exist_ok=True)
    monkeypatch.chdir(place)
    given = {name: root / value if name == "start" else Path(value) for name, value in options.items()}
    assert find_project(**given).main_file.resolve() == (root / found).resolve()


def test_a_program_that_the_settings_name_wrongly_is_told(make_project: MakeProject) -> None:
    project = make_project({"pyproject.toml": '[tool.pyfrc]\nmain = "practise.py"\n'})
    with pytest.raises(ProjectError, match=r"main = 'practise.py' under \[tool.pyfrc\], but there is no such file"):
        find_project(project.path)


def test_all_settings_hold_for_a_program_deep_in_the_project(make_project: MakeProject) -> None:
    """In a directory with spaces and accents in its name, from another one."""
    another = "\n\n    class Another(wpilib.TimedRobot):\n        pass\n"
    project = make_project(
        {
            "équipe 4711/src/robots/practice.py": ROBOT + another,
            "équipe 4711/src/robots/tests/test_a.py": FINDS_IT,
            "équipe 4711/pyproject.toml": '[tool.pyfrc]\nmain = "src/robots/practice.py"\nrobot_class = "MyRobot"\n',
        }
    )
    root = project.path / "équipe 4711"
    assert_finds_it(project, "--isolation", "auto", cwd=root / "src")
    assert_finds_it(project, "--isolation", "reuse", "--project", root, cwd=project.temporary)


def test_a_program_of_another_name_is_found_where_an_option_says(make_project: MakeProject) -> None:
    project = make_project({"practice.py": ROBOT, "tests/test_a.py": FINDS_IT})
    assert_finds_it(project, "--main", "practice.py")


def test_the_version_is_told(make_project: MakeProject) -> None:
    result = make_project({}).run_here("--version")
    assert result.code == 0
    assert result.stdout.strip() == f"pyfrc, version {__version__}"
