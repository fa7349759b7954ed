"""Each template of 2027 is a project that passes its own tests, and a match with random inputs."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from conftest import SHORT_MATCH, MakeProject, add_settings, sampled

from pyfrc_core.scaffold import TEMPLATES

SOURCES = Path(__file__).parents[2] / "templates"


def test_there_is_one_for_robots_with_opmodes(make_project: MakeProject) -> None:
    shown = make_project({}).run("init", "--list")
    assert shown.code == 0, shown.output
    listed = re.findall(r"^(\S+)  +\S", shown.stdout, re.MULTILINE)
    assert listed == list(TEMPLATES)
    assert "opmode" in listed


@pytest.mark.parametrize("template", sampled(TEMPLATES, "opmode"))
def test_it_passes_its_tests_and_a_match_with_random_inputs(make_project: MakeProject, template: str) -> None:
    project = make_project({})
    made = project.run("init", "--template", template)
    assert made.code == 0, made.output
    add_settings(project.path, SHORT_MATCH)
    for command in (
        ("config", "check", "--strict"),
        ("test", "--coverage", "--fail-under", "80"),
        ("fuzz", "--runs", "1", "--seed", "7", "--jobs", "1"),
    ):
        result = project.run(*command)
        assert result.code == 0, result.output
    assert "Nothing was found." in result.stdout


def test_what_the_seasons_share_is_there_once(make_project: MakeProject) -> None:
    """A 2027 project has the season's own files, and the others of the template."""
    project = make_project({})
    assert project.run("init", "--template", "command").code == 0
    for file in ("README.md", "subsystems/__init__.py"):
        assert not (SOURCES / "2027/command" / file).exists()
        assert (project.path / file).read_text("utf-8") == (SOURCES / "command" / file).read_text("utf-8")
    for file in ("requirements.txt", "pyproject.toml"):
        assert "wpilib-drivers~=2027.0.0a7" in (project.path / file).read_text("utf-8")
    labels = json.loads((project.path / "sim/config.json").read_text("utf-8"))["pyfrc"]["joysticks"]["0"]
    assert labels["buttons"]["0"] == "take in"  # buttons count from 0


@pytest.mark.parametrize("template", sampled(["mecanum", "opmode"], "opmode"))
@pytest.mark.slow
def test_create_physics_finds_its_drivetrain(make_project: MakeProject, template: str) -> None:
    """What it writes passes the template's tests; a robot with opmodes is driven in one."""
    project = make_project({})
    assert project.run("init", "--template", template).code == 0
    (project.path / "physics.py").unlink()
    result = project.run("create-physics")
    assert result.code == 0, result.output
    assert "The project's tests pass." in result.stdout
    assert "No stick drove" not in result.stdout


def test_no_opmode_lets_the_drive_time_out(make_project: MakeProject) -> None:
    project = make_project({})
    assert project.run("init", "--template", "opmode").code == 0
    result = project.run("sim", "--ui", "none", "--mode", "practice", "--opmode", "Stay", "--seconds", "25")
    assert (result.code, re.search("not updated often enough", result.output)) == (0, None), result.output
