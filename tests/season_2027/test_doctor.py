"""`pyfrc doctor` in season 2027: the steps from a blank SystemCore to a driving robot."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import MakeProject, RobotProject
from package_index import PackageIndex, package_index
from ports import refusing_port

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""


@pytest.fixture
def index(tmp_path: Path) -> Iterator[PackageIndex]:
    with package_index(tmp_path / "index") as index:
        index.add_wpilib()
        yield index


def next_step(project: RobotProject, environment: dict[str, str]) -> tuple[str, str]:
    result = project.run("doctor", "--json", env=environment)
    (step,) = (each for each in json.loads(result.stdout)["findings"] if each["topic"] == "next step")
    return step["text"], step["remedy"]


@pytest.mark.slow
def test_from_a_blank_controller_to_the_deploy(make_project: MakeProject, index: PackageIndex, tmp_path: Path) -> None:
    project = make_project({"robot.py": ROBOT})
    environment = index.environment(tmp_path / "home")
    assert next_step(project, environment)[0] == "1 of 6, the team number"
    with refusing_port() as port:
        preferences = json.dumps({"robotHostname": f"127.0.0.1:{port}"})
        project.write({".wpilib/wpilib_preferences.json": preferences})
        text, remedy = next_step(project, environment)
        assert text == "2 of 6, the downloads for the robot"
        assert remedy.startswith("With internet: pyfrc sync")
        assert project.run("sync", env=environment).code == 0
        text, remedy = next_step(project, environment)
    assert text == "3 of 6, the controller: its image, and the connection to it"
    assert "A radio VH-109 needs firmware 2.0.0 or newer, in SystemCore mode" in remedy
    assert "On its web page (http://robot.local), set your team number, and update its image" in remedy
    assert '"OS Update" (image 14)' in remedy
