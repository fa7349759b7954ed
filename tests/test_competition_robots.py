"""Competition robots with vendors' devices: their tests pass quietly, and say why these devices do not repeat."""

from __future__ import annotations

from pathlib import Path

import pytest
from conftest import MakeProject, RobotProject
from skips import missing_python, requires

pytestmark = [pytest.mark.slow, requires("robots with vendors' packages", missing_python())]

ROBOTS = Path(__file__).parent / "robots" / "competition"
NAMES = sorted(path.name for path in ROBOTS.iterdir() if (path / "robot.py").is_file())

#: Why the devices of a robot do not repeat.
REAL_TIME = "do not repeat exactly, because phoenix6 simulates them in real time"
NOISE = "do not repeat exactly, because REV's library draws the noise of their velocities by chance"

#: A match that is shorter than the real one, for the sake of the suite's time.
SETTINGS = "\n[tool.pyfrc.match]\nautonomous = 2\npause = 0.1\nteleop = 2\n"


@pytest.fixture(params=NAMES)
def project(request: pytest.FixtureRequest, make_project: MakeProject) -> RobotProject:
    made = make_project({})
    made.copy(ROBOTS / request.param)
    with (made.path / "pyproject.toml").open("a") as settings:
        settings.write(SETTINGS)
    return made


def test_a_match_passes_quietly(project: RobotProject, request: pytest.FixtureRequest) -> None:
    result = project.run("test", "--trace", "traces", "-q", "--", "-k", "test_practice")
    assert result.code == 0, result.output
    assert "1 passed" in result.stdout
    assert [line for line in result.output.splitlines() if "arning" in line or "rror" in line] == []
    is_ctre = request.node.callspec.params["project"] == "ctre_swerve"
    assert " ".join(result.stdout.split()).count(REAL_TIME if is_ctre else NOISE) == 1


@pytest.mark.parametrize("project", ["rev_swerve"], indirect=True)
def test_a_passing_test_without_isolation_ends_with_success(project: RobotProject) -> None:
    # REV's library ended the process by SIGABRT when the interpreter destroyed the robot's objects.
    result = project.run("test", "--no-isolation", "-q", "--", "-k", "test_practice", cold=True)
    assert (result.code, result.complaints) == (0, "")
    assert "1 passed" in result.stdout
