"""Each template is a project that passes what we ask of robots: its tests, its workflow, types, style."""

from __future__ import annotations

import functools
import json
import re
import shlex
import shutil
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml
from conftest import SHORT_MATCH, MakeProject, RobotProject, add_settings
from test_virtual_robot import deploy, started

from pyfrc_cli.main import COMMANDS
from pyfrc_core.scaffold import TEMPLATES
from pyfrc_core.season import CURRENT

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

SOURCES = Path(__file__).parents[1] / "templates"
GITHUB = SOURCES.with_name("docs") / "how_to" / "test_on_github.md"


#: The first command of the workflows.
INSTALLING = ["pip", "install", "--find-links", "wheels", "-r", "requirements.txt"]


@pytest.fixture(scope="module")
def project_of(make_shared_project: MakeProject) -> Callable[[str], RobotProject]:
    """Makes a new project of a template, which all tests share."""

    @functools.cache
    def project_of(template: str) -> RobotProject:
        project = make_shared_project({})
        made = project.run_here("init", "--template", template)
        assert made.code == 0, made.output
        return project

    return project_of


@pytest.fixture
def project(project_of: Callable[[str], RobotProject], request: pytest.FixtureRequest) -> RobotProject:
    """A new project of the template at hand."""
    return project_of(request.param)


@pytest.fixture
def template(request: pytest.FixtureRequest) -> str:
    """The template at hand."""
    return str(request.node.callspec.params["project"])


every_template = pytest.mark.parametrize("project", TEMPLATES, indirect=True)


def workflow(project: RobotProject) -> list[list[str]]:
    """The commands of a project's workflow for tests: each what stands behind ``python -m``."""
    steps = yaml.safe_load((project.path / ".github/workflows/test.yml").read_text("utf-8"))
    commands = [shlex.split(step["run"]) for job in steps["jobs"].values() for step in job["steps"] if "run" in step]
    assert all(command[:2] == ["python", "-m"] for command in commands)
    return [command[2:] for command in commands]


@every_template
@pytest.mark.slow
def test_its_workflow_passes_as_it_stands_in_the_file(project: RobotProject, tmp_path: Path) -> None:
    """Checking the config, and the tests with more than 80 % of the robot's lines run, when all is installed.

    In less than a whole match, for the sake of the suite's time; the simulator goes through a whole one.
    """
    installing, *rest = workflow(project)
    shorter = shutil.copytree(project.path, tmp_path / "shorter")
    add_settings(shorter, SHORT_MATCH)
    assert installing == INSTALLING
    assert rest[-1] == ["pyfrc", "test", "--coverage", "--fail-under", "80"]
    for program, *arguments in rest:
        result = project.run(*arguments, program=program, cwd=shorter)
        assert result.code == 0, result.output
    own_tests = [file for file in project.path.glob("tests/test_*.py") if f"tests/{file.name} ." in result.stdout]
    assert own_tests, result.stdout
    assert "tests/pyfrc_test.py ....." in result.stdout


def test_the_page_on_github_shows_the_workflow(project_of: Callable[[str], RobotProject]) -> None:
    written = yaml.safe_load((project_of("timed").path / ".github/workflows/test.yml").read_text("utf-8"))
    (block,) = re.findall(r"```yaml\n(.*?)```", GITHUB.read_text("utf-8"), re.DOTALL)
    (shown,) = yaml.safe_load(block)["jobs"].values()
    for step in written["jobs"]["test"]["steps"]:
        for key in ("cache", "cache-dependency-path"):  # only make it faster
            step.get("with", {}).pop(key, None)
    assert shown == written["jobs"]["test"]


@pytest.mark.slow
@pytest.mark.parametrize("project", ["elevator-arm", "swerve"], indirect=True)
def test_it_goes_through_a_match_in_the_simulator(project: RobotProject, template: str) -> None:
    """That the others drive is in their own tests."""
    result = project.run("sim", "--ui", "none", "--mode", "practice")
    assert result.code == 0, result.output
    driven = re.search(r"distance driven: .* \(([0-9.]+) m\)", result.stdout)
    assert driven is not None, result.output
    assert (float(driven[1]) > 1) == (template != "elevator-arm")  # which has no wheels


@pytest.mark.slow
@pytest.mark.parametrize("project", ["magic"], indirect=True)
def test_a_magic_robot_does_not_report_its_start_on_a_virtual_robot(project: RobotProject, tmp_path: Path) -> None:
    """That of the default template starts on one in the tutorial (`test_docs`)."""
    with started(project, tmp_path / "robot") as robot:
        assert "does not report the end of its start" in deploy(robot, project)


@pytest.mark.slow
def test_types_and_style_are_clean(pytestconfig: pytest.Config, make_shared_project: MakeProject) -> None:
    # The types of wpilib and of pyfrc, which take mypy most of its time, are kept from run to run.
    cache = pytestconfig.cache
    assert cache is not None
    kept = cache.mkdir("mypy-of-templates")
    project = make_shared_project({})
    for template in TEMPLATES:
        assert project.run_here("init", template, "--template", template).code == 0
        result = project.run("--cache-dir", str(kept), ".", program="mypy", cwd=project.path / template)
        assert result.code == 0, f"{template}: {result.output}"
    for arguments in (["check"], ["format", "--check"]):
        result = project.run(*arguments, "--no-cache", ".", program="ruff")
        assert result.code == 0, result.output


@every_template
def test_todays_tools_and_pip_read_what_it_needs(project: RobotProject, template: str) -> None:
    settings = tomllib.loads((project.path / "pyproject.toml").read_text("utf-8"))["tool"]["robotpy"]
    assert re.fullmatch(r"2026\.\d+\.\d+", settings["robotpy_version"])
    needed = TEMPLATES[template].packages
    if settings["components"]:
        assert settings["components"] == ["commands2"]
        assert settings["requires"] == []
    else:
        assert settings["requires"] == list(needed)
    lines = (project.path / "requirements.txt").read_text("utf-8").splitlines()
    assert [line for line in lines if not line.startswith("#")] == ["pyfrc>=2026.1", CURRENT.requirement, *needed]
    readme = (project.path / "README.md").read_text("utf-8")
    for package in needed:
        assert package.partition("~")[0] in readme


def test_the_editor_finds_its_tests_its_schema_and_the_commands(make_project: MakeProject) -> None:
    project = make_project({})
    assert project.run_here("init").code == 0
    settings, launch, config = (
        json.loads((project.path / file).read_text("utf-8"))
        for file in (".vscode/settings.json", ".vscode/launch.json", "sim/config.json")
    )
    assert settings["python.testing.pytestEnabled"]
    assert all((project.path / directory).is_dir() for directory in settings["python.testing.pytestArgs"])
    (association,) = settings["json.schemas"]
    assert association["fileMatch"] == ["/sim/config.json"]
    schema = project.path / association["url"]
    assert (project.path / "sim" / config["$schema"]).samefile(schema)
    assert schema.read_text("utf-8").strip() == project.run_here("config", "schema").stdout.strip()
    assert {entry["args"][0] for entry in launch["configurations"]} == {"sim", "test", "deploy"}
    assert all(entry["args"][0] in COMMANDS and entry["module"] == "pyfrc" for entry in launch["configurations"])


def overlay(template: str) -> dict[str, str]:
    """A template's own files."""
    files = (file for file in (SOURCES / template).rglob("*") if file.is_file() and "__pycache__" not in file.parts)
    return {file.relative_to(SOURCES / template).as_posix(): file.read_text("utf-8") for file in files}


def test_no_two_templates_share_a_file_and_none_replaces_one_of_the_base() -> None:
    where = defaultdict(list)
    base = overlay("base")
    for template in TEMPLATES:
        own = overlay(template)
        assert {"robot.py", "physics.py", "sim/config.json", "README.md"} <= own.keys()
        assert not own.keys() & base.keys()
        for file, text in own.items():
            where[text].append(f"{template}/{file}")
    assert [files for files in where.values() if len(files) > 1] == []


def test_a_new_robot_is_held_by_the_walls_of_the_field() -> None:
    configs = [json.loads(file.read_text("utf-8")) for file in SOURCES.rglob("sim/config.json")]
    assert len(configs) >= len(TEMPLATES)
    assert all(config["pyfrc"]["field"] == {"walls": True} for config in configs)


def test_every_directory_of_templates_is_one() -> None:
    names = {path.name for path in SOURCES.iterdir() if path.is_dir()}
    assert names - {"2027"} == {"base", *TEMPLATES} - {"opmode"}
    assert {path.name for path in (SOURCES / "2027").iterdir()} == {*TEMPLATES, "opmode"}


def test_a_season_has_only_the_files_that_differ() -> None:
    for template in TEMPLATES:
        others, own = overlay(template), overlay(f"2027/{template}")
        assert [file for file, text in own.items() if others.get(file) == text] == []
        assert own.keys() <= others.keys()


def test_the_texts_are_as_python_on_every_computer_reads_them() -> None:
    for template in ("base", *TEMPLATES, "2027"):
        for file, text in overlay(template).items():
            assert "\r" not in text, file
            assert text.endswith("\n"), file
            assert text.isascii() or file.endswith((".py", ".md")), file
