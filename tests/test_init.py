"""`pyfrc init`: templates, team numbers, names, what is in the way. `pyfrc add-tests`: the ready-made tests, once."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace

import pytest
from click.testing import CliRunner
from conftest import MakeProject, RobotProject
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from loops import for_each

import pyfrc_cli
from pyfrc_core.errors import UsageError
from pyfrc_core.scaffold import DEFAULT, TEMPLATES, Template, create_project

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROBOT = "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"


def files_in(directory: Path) -> dict[str, bytes]:
    return {
        file.relative_to(directory).as_posix(): file.read_bytes() for file in directory.rglob("*") if file.is_file()
    }


# -- templates ------------------------------------------------------------------------------------------------------


def test_the_list_tells_each_template_and_what_it_needs(make_project: MakeProject) -> None:
    project = make_project({})
    shown = project.run_here("init", "--list")
    assert shown.code == 0
    listed = re.findall(r"^(\S+)  +(\S.*)$", shown.stdout, re.MULTILINE)
    assert [name for name, _ in listed] == list(TEMPLATES)
    for (name, text), template in zip(listed, TEMPLATES.values(), strict=True):
        assert template.description in text
        assert text.endswith("(default)") == (name == DEFAULT)
    assert "robotpy-commands-v2" in shown.stdout
    assert files_in(project.path) == {}


def test_without_a_template_it_is_the_default(make_project: MakeProject) -> None:
    project = make_project({})
    assert project.run_here("init", "one").code == 0
    assert project.run_here("init", "two", "--template", DEFAULT).code == 0
    assert files_in(project.path / "one") == files_in(project.path / "two")


def test_a_template_that_there_is_not_is_told_with_those_there_are(make_project: MakeProject) -> None:
    project = make_project({})
    result = project.run_here("init", "--template", "tnak")
    assert result.code == 2
    assert all(name in result.stderr for name in TEMPLATES)
    assert files_in(project.path) == {}


def test_what_is_not_installed_is_told_with_how_to_install_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from pyfrc_cli.init import command

    needy = Template("needs something", packages=("no-such-package-for-robots~=1.0", "click>=1"))
    monkeypatch.setitem(TEMPLATES, DEFAULT, needy)
    shown = CliRunner().invoke(command, [str(tmp_path / "robot")])
    assert shown.exit_code == 0, shown.output
    assert "packages that are not installed: no-such-package-for-robots~=1.0\n" in shown.output
    assert f"cd {tmp_path / 'robot'}\nInstall them with: python -m pip install -r requirements.txt\n" in shown.output
    assert "no-such-package-for-robots~=1.0\nclick>=1\n" in (tmp_path / "robot/requirements.txt").read_text("utf-8")


@pytest.mark.parametrize(
    ("record", "shown"),
    [
        (None, None),
        ('{"url": "https://robots.example/pyfrc.whl", "archive_info": {}}', None),
        (
            '{"url": "file:///home/you/my%20files/pyfrc", "dir_info": {}}',
            "wheel --no-deps -w wheels '/home/you/my files/pyfrc'",
        ),
    ],
)
@pytest.mark.skipif(os.name == "nt", reason="the paths are those of other systems")
def test_how_github_gets_a_pyfrc_that_is_not_from_the_index(
    record: str | None, shown: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pyfrc_cli import init

    monkeypatch.setattr(init, "distribution", lambda name: SimpleNamespace(read_text=lambda file: record))
    printed = CliRunner().invoke(init.command, [str(tmp_path / "robot")]).output
    assert ("GitHub" in printed) == (shown is not None)
    assert shown is None or f"{shown}\n" in printed


@for_each("name", TEMPLATES)
def test_what_the_templates_need_is_installed_for_these_tests(name: str) -> None:
    assert TEMPLATES[name].missing == []


# -- the team's number ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("team", [1, 4711, 25599])
def test_the_teams_number_is_where_deploys_and_todays_tools_look(make_project: MakeProject, team: int) -> None:
    from pyfrc_core.deploy.team import find_target
    from pyfrc_core.project import find_project

    project = make_project({})
    assert project.run_here("init", "--team", str(team)).code == 0
    project_settings = tomllib.loads((project.path / "pyproject.toml").read_text("utf-8"))
    assert project_settings["tool"]["robotpy"]["team_number"] == team
    assert find_target(find_project(project.path)).team == team


def test_without_a_number_nothing_claims_one(make_project: MakeProject) -> None:
    from pyfrc_core.deploy.team import find_target
    from pyfrc_core.project import find_project

    project = make_project({})
    assert project.run_here("init").code == 0
    with pytest.raises(UsageError, match="no team number"):
        find_target(find_project(project.path))


@pytest.mark.parametrize("team", ["0", "-3", "25600"])
def test_a_number_that_no_team_can_have_is_refused(make_project: MakeProject, team: str) -> None:
    project = make_project({})
    result = project.run_here("init", f"--team={team}")
    assert result.code == 2
    assert result.first_error == f"--team: {team} is no team number: one is from 1 to 25599"
    assert files_in(project.path) == {}


# -- names and places -----------------------------------------------------------------------------------------------


def test_a_name_that_looks_like_an_option_is_refused(make_project: MakeProject) -> None:
    project = make_project({})
    assert project.run_here("init", "--", "-robot").code == 2
    assert list(project.path.iterdir()) == []


@settings(max_examples=20)
@given(st.text(st.characters(exclude_categories=["Cs"], exclude_characters="/\x00"), min_size=1, max_size=20))
@example("équipe 4711")
@example("console")
@example("aux.py")
def test_a_name_is_taken_or_refused_and_nothing_of_it_is_left(name: str) -> None:
    assume(name not in (".", ".."))
    reserved = {"con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in range(1, 10))}
    refused = (
        bool(set(name) & set('<>:"|?*\\'))
        or min(name) < " "
        or name[0] == "-"
        or name[-1] in ". "
        or name.partition(".")[0].lower() in reserved
    )
    with TemporaryDirectory() as temporary:
        if refused:
            with pytest.raises(UsageError, match="no name for a directory"):
                create_project(Path(temporary, name), Path(pyfrc_cli.__path__[0]), "timed")
            assert list(Path(temporary).iterdir()) == []
        else:
            create_project(Path(temporary, name), Path(pyfrc_cli.__path__[0]), "timed")
            assert (Path(temporary, name) / "robot.py").is_file()


@pytest.mark.parametrize("place", ["tests", "sim", ".github", ".vscode"])
def test_a_file_where_a_directory_has_to_be_is_in_the_way(make_project: MakeProject, place: str) -> None:
    project = make_project({place: "mine\n"})
    before = files_in(project.path)
    result = project.run_here("init")
    assert result.code == 2
    assert f"nothing was written: {place} exists already" in result.stderr
    assert files_in(project.path) == before


def test_other_files_in_the_directory_are_left_alone(make_project: MakeProject) -> None:
    project = make_project({"notes.txt": "mine\n", "tests/notes.txt": "mine too\n"})
    before = files_in(project.path)
    result = project.run_here("init", "--template", "timed", "--yes")
    assert result.code == 0, result.output
    assert before.items() <= files_in(project.path).items()


def test_beside_other_files_it_writes_nothing_where_it_cannot_ask(make_project: MakeProject) -> None:
    project = make_project({"b.txt": "mine\n", "letters/a.txt": "", "1.txt": "", "2.txt": ""})
    before = files_in(project.path)
    result = project.run_here("init")
    assert result.code == 2
    assert result.first_error == (
        f"nothing was written: {project.path} has other files: 1.txt, 2.txt, b.txt and 1 more"
    )
    assert "pyfrc init my-robot. To create the project beside them, add --yes." in result.stderr
    assert files_in(project.path) == before
    assert project.run_here("init", "new").code == 0


@pytest.mark.parametrize(("typed", "written"), [("y\n", True), ("n\n", False)])
def test_beside_other_files_it_asks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, typed: str, written: bool) -> None:
    from pyfrc_cli import init

    monkeypatch.setattr(init, "can_ask", lambda: True)
    (tmp_path / "essay.txt").touch()
    done = CliRunner().invoke(init.command, [str(tmp_path)], input=typed)
    assert isinstance(done.exception, UsageError) == (not written)
    assert f"{tmp_path} has other files: essay.txt.\nCreate the robot project beside them? [y/N]" in done.output
    assert (tmp_path / "robot.py").exists() == written


def test_hidden_files_and_environments_are_no_other_files(make_project: MakeProject) -> None:
    project = make_project({".git/config": "", ".wpilib/x.json": "{}", "venv/pyvenv.cfg": ""})
    assert project.run_here("init").code == 0


def test_every_file_that_is_there_is_named(make_project: MakeProject) -> None:
    project = make_project({"physics.py": "", "sim/config.json": "{}", ".gitignore": ""})
    before = files_in(project.path)
    result = project.run_here("init")
    assert result.code == 2
    assert ".gitignore, physics.py, sim/config.json exist already" in result.stderr
    assert files_in(project.path) == before


# -- pyfrc add-tests ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", ["add-tests", "create-tests"])  # its name of before
def test_add_tests_writes_the_documented_file_once(make_project: MakeProject, command: str) -> None:
    project = make_project({"robot.py": ROBOT, "deeper/notes.txt": ""})
    first = RobotProject(project.path / "deeper", project.temporary).run_here(command)
    assert first.code == 0, first.output
    assert first.stdout.startswith("wrote ../tests/pyfrc_test.py\n")
    assert "from pyfrc.tests import *" in (project.path / "tests/pyfrc_test.py").read_text("utf-8")

    (project.path / "tests/pyfrc_test.py").write_text("# mine\n")
    second = project.run_here(command)
    assert second.code == 0
    assert second.stdout.startswith("unchanged: tests/pyfrc_test.py (exists)\n")
    assert (project.path / "tests/pyfrc_test.py").read_text() == "# mine\n"


def test_add_tests_goes_where_the_tests_are(make_project: MakeProject) -> None:
    project = make_project({"src/robot.py": ROBOT, "tests/test_mine.py": "def test_it():\n    pass\n"})
    assert RobotProject(project.path / "src", project.temporary).run_here("add-tests").code == 0
    assert (project.path / "tests/pyfrc_test.py").is_file()
    assert not (project.path / "src/tests").exists()


def test_add_tests_does_not_take_a_file_for_a_directory(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests": "a file\n"})
    result = project.run_here("add-tests")
    assert result.code == 2
    assert "tests is a file" in result.first_error
    assert (project.path / "tests").read_text() == "a file\n"


def test_add_tests_needs_a_project(make_project: MakeProject) -> None:
    project = make_project({})
    result = project.run_here("add-tests")
    assert result.code == 2
    assert "no robot project found" in result.first_error
    assert list(project.path.iterdir()) == []
