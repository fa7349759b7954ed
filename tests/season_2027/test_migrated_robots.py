"""Robots of 2026, after `pyfrc migrate` and the few changes by hand of a patch, pass their own tests in 2027."""

from __future__ import annotations

import shutil
from importlib.util import find_spec
from pathlib import Path

import pytest
from conftest import SHORT_MATCH, MakeProject, RobotProject, add_settings, sampled
from skips import require

pytest.importorskip("libcst")

from make_2027 import apply_patch, migrate, texts

ROBOTS = Path(__file__).parents[1] / "robots"


def migrated(make_project: MakeProject, robot: Path) -> RobotProject:
    project = make_project({})
    shutil.copytree(
        robot, project.path, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__", ".*", "since_*")
    )
    migrate(project.path).write()
    files = dict(texts(project.path))
    apply_patch(f"robots/{robot.name}", files)
    for name, text in files.items():
        (project.path / name).write_text(text, "utf-8")
    return project


@pytest.mark.parametrize(
    "name",
    sampled(
        ["command", "magic", "pneumatics", "sleeper", "square", "timed", "worker"], "command", "magic", "pneumatics"
    ),
)
def test_a_sample_robot(make_project: MakeProject, name: str) -> None:
    result = migrated(make_project, ROBOTS / name).run("test")
    assert result.code == 0, result.output


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "module", "package"), [("magic_swerve", "rev", "robotpy-rev"), ("ctre_swerve", "phoenix6", "phoenix6")]
)
def test_a_competition_robot(make_project: MakeProject, name: str, module: str, package: str) -> None:
    """What its vendor's package needs is in docs/reference/migrate.md."""
    require("a robot with a vendor's devices", [] if find_spec(module) else [package])
    project = migrated(make_project, ROBOTS / "competition" / name)
    add_settings(project.path, SHORT_MATCH)  # phoenix6 goes on in real time: the whole match took 14 minutes
    result = project.run("test")
    assert result.code == 0, result.output
