"""Robots that are not ready for a deploy: `pyfrc deploy` and `pyfrc doctor` report the same problems and remedies."""

from __future__ import annotations

from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each
from roborio import Roborio, require_roborio
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY

from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.facts import RobotFacts
from pyfrc_core.deploy.robot_checks import NO_CHECK, PREPARE, refuse_installation, refuse_unfit_robot
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.doctor import CheckResult
from pyfrc_core.doctor.robot import RobotSearch, check_robot_facts, missing_on_robot
from pyfrc_core.doctor.steps import Step
from pyfrc_core.project import find_project

OURS = version("wpilib")
READY = RobotFacts(
    controller="roboRIO",
    not_controller=None,
    python="3.14.0",
    wpilib=OURS,
    image="FRC_roboRIO_2026_v1.2",
    wastes_memory=False,
    free_bytes=100_000_000,
    user="lvuser",
    current=None,
    releases=(),
    other_code=False,
    deploy_json={},
    command=None,
    debug=False,
    running=False,
    packages={"wpilib": OURS},
    missing_modules=(),
    machine="armv7l",
)


def doctor(project, robot: Roborio) -> list[CheckResult]:
    """Return the output of `pyfrc doctor` about the robot, after the line that it was found."""
    found, *others = RobotSearch(find_project(project.path), robot.where).findings()
    assert found.status == "ok"
    return others


# --- without Python


@pytest.mark.usefixtures("patient_doctor")
def test_a_robot_without_python(make_project) -> None:
    require_roborio()
    project = make_project({"robot.py": ROBOT_PY})
    with Roborio(python=None, image="FRC_roboRIO_2025_v2.0") as robot:
        found = doctor(project, robot)
        assert not (project.path / ".pyfrc/known_hosts").exists(), "the doctor changes nothing, here either"
        refused = project.run("deploy", "--skip-tests", "--robot", robot.where)
        assert refused.code == 1
        assert [each.text.partition(" (")[0] for each in found] == [
            "the robot's image is of 2025",
            "there is no Python on the robot",
        ]
        assert found[0].remedy in refused.stderr.replace(f" --robot {robot.where}", "")
        assert [each.status for each in found] == ["problem"] * len(found)
        assert all(each.text in refused.stderr for each in found)
        # The key of a robot that the project knows is compared.
        robot.power_off()
        robot.new_host_key()
        robot.power_on()
        (changed,) = doctor(project, robot)
        assert "the robot's key has changed" in changed.text
        assert "pyfrc deploy-info" in changed.remedy


# --- with Python


@for_each(
    "wrong, said, what_to_do",
    [
        (
            {"not_controller": "there is no frcKillRobot.sh on it"},
            "this is not a roboRIO: there is no frcKillRobot.sh on it",
            "Check the address, or name the robot with --robot HOST. For a new roboRIO: Image it with",
        ),
        ({"wpilib": None}, "there is no wpilib for Python on the robot", PREPARE),
        (
            {"python": "3.9.1"},
            f"the robot has Python 3.9.1, but wpilib {OURS} is for Python 3.14 there",
            "Image it with",
        ),
        (
            {"wpilib": "2026.1.1"},
            f"the robot has wpilib 2026.1.1, this computer has {OURS}: what passes here may fail there",
            f'Use the same version on both: robotpy_version = "{OURS}"',
        ),
        (
            {"image": "FRC_roboRIO_2025_v2.0"},
            f"the robot's image is of 2025 (2025_v2.0), but wpilib {OURS} needs the image of 2026",
            "Image it with the roboRIO Imaging Tool of this season (image 2026_v1.2)",
        ),
        (
            {"image": "FRC_roboRIO2_2026_v1.1"},
            "the robot's image is 2026_v1.1, but this season's image is 2026_v1.2",
            "Image it with the roboRIO Imaging Tool",
        ),
        ({"image": None}, "the robot's image is unknown (None)", "Image it with the roboRIO Imaging Tool"),
    ],
)
def test_the_doctor_reports_what_a_deploy_would_refuse(wrong: dict[str, Any], said: str, what_to_do: str) -> None:
    facts = replace(READY, **wrong)
    with pytest.raises(RefusedError) as refused:
        refuse_unfit_robot(facts, ROBORIO, "10.12.34.2", check_versions=True)
    (finding,) = check_robot_facts(facts, ROBORIO, None)
    assert finding.status == "problem"
    assert finding.text == refused.value.message
    assert finding.remedy is not None
    assert str(refused.value.remedy).startswith(finding.remedy)
    assert finding.text == said
    assert finding.remedy.startswith(what_to_do)
    certain = "not_controller" in wrong or wrong.get("wpilib", "") is None
    assert str(refused.value.remedy).endswith(NO_CHECK) is not certain
    if not certain:
        refuse_unfit_robot(facts, ROBORIO, "10.12.34.2", check_versions=False)


def test_only_what_an_installation_does_not_solve_prevents_it() -> None:
    connection: Any = SimpleNamespace(controller=ROBORIO, address="10.12.34.2")
    refuse_installation(connection, READY)
    refuse_installation(connection, replace(READY, wpilib=None))
    for wrong in ({"image": "FRC_roboRIO_2025_v2.0"}, {"python": "3.9.1"}):  # the system's Python stays
        with pytest.raises(RefusedError) as refused:
            refuse_installation(connection, replace(READY, **wrong))
        assert str(refused.value.remedy).endswith(NO_CHECK)


def test_a_robot_that_is_ready() -> None:
    for image in ("FRC_roboRIO_2026_v1.2", "FRC_roboRIO2_2026_v1.2"):
        refuse_unfit_robot(replace(READY, image=image), ROBORIO, "10.12.34.2", check_versions=True)
    (finding,) = check_robot_facts(READY, ROBORIO, None)
    assert finding.status == "ok"


def test_the_doctor_reports_all_problems_at_once() -> None:
    facts = replace(READY, wpilib=None, python="3.9.1", image="FRC_roboRIO_2025_v2.0")
    assert [each.status for each in check_robot_facts(facts, ROBORIO, None)] == ["problem"] * 3


def test_packages_that_the_project_asks_for_and_the_robot_lacks(tmp_path: Path) -> None:
    (tmp_path / "robot.py").write_text(ROBOT_PY)
    (tmp_path / "pyproject.toml").write_text('[tool.robotpy]\ncomponents = ["commands2"]\n')
    (finding,) = check_robot_facts(READY, ROBORIO, find_project(tmp_path))
    assert (
        finding.text == "pyproject.toml:2: components has commands2, but the robot has no package robotpy-commands-v2"
    )


@for_each(
    "there, step, remedy",
    [
        ({"not_controller": "there is no frcKillRobot.sh on it"}, Step.CONTROLLER, "roboRIO Imaging Tool"),
        ({"image": "FRC_roboRIO_2025_v2.0", "wpilib": None}, Step.CONTROLLER, "roboRIO Imaging Tool"),
        ({"wpilib": None}, Step.PACKAGES, "Prepare the robot: "),
        ({"python": "3.9.1"}, Step.PACKAGES, "roboRIO Imaging Tool"),
        ({}, Step.PROGRAM, "pyfrc deploy"),
        ({"current": 1}, Step.PROGRAM, "pyfrc deploy-info"),
        ({"other_code": True, "running": True}, Step.DRIVE, ""),
        ({"current": 1, "running": True}, Step.DRIVE, ""),
    ],
)
def test_the_first_missing_step_of_a_robot(there: dict[str, Any], step: Step, remedy: str) -> None:
    facts = replace(READY, **there)
    missing = missing_on_robot(facts, ROBORIO, list(check_robot_facts(facts, ROBORIO, None)))
    assert missing[0] is step
    assert remedy in missing[1]
