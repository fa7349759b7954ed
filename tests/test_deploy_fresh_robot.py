"""Robots that are not ready for a deploy: `pyfrc deploy` and `pyfrc doctor` report the same problems and remedies."""

from __future__ import annotations

from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest
from roborio import Roborio, require_roborio
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, Agents, LocalRobot

from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.facts import RobotFacts
from pyfrc_core.deploy.robot_checks import PREPARE, refuse_unfit_robot
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.doctor import CheckResult
from pyfrc_core.doctor.check_result import hint, ok
from pyfrc_core.doctor.robot import RobotSearch, check_robot_facts, missing_on_robot
from pyfrc_core.doctor.steps import Step, first_missing
from pyfrc_core.project import find_project

OURS = version("wpilib")
JAVA_COMMAND = "/usr/local/frc/JRE/bin/java -jar /home/lvuser/Robot.jar\n"
REMOVE = "To remove it: pyfrc undeploy --java-cpp"
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
    extension_suffixes=(".so",),
    machine="armv7l",
    other_languages=(),
)


def look_at(robot: LocalRobot) -> RobotFacts:
    with Agents() as agents:
        session = robot.start(agents)
        session.close()
    return session.facts


def doctor(project, robot: Roborio) -> list[CheckResult]:
    """Return the output of `pyfrc doctor` about the robot, after the line that it was found."""
    found, *others = RobotSearch(find_project(project.path), robot.where).findings()
    assert found.status == "ok"
    return others


# --- Java and C++


def test_programs_in_java_and_cpp_are_noticed(robot: LocalRobot) -> None:
    java = robot.root / "usr/local/frc/JRE/bin/java"
    libraries = robot.root / "usr/local/frc/third-party/lib"
    for each in (java, libraries / "libctre.so", robot.home / "Robot.jar", robot.home / "frcUserProgram"):
        each.parent.mkdir(parents=True, exist_ok=True)
        each.touch()
    (robot.home / "robotCommand").write_text(JAVA_COMMAND)
    assert look_at(robot).other_languages == (
        "/home/lvuser/robotCommand",
        "/home/lvuser/Robot.jar",
        "/home/lvuser/frcUserProgram",
        "/usr/local/frc/JRE/bin/java",
        "/usr/local/frc/third-party/lib",
    )


def test_a_robot_with_python_alone_has_nothing_of_other_languages(robot: LocalRobot) -> None:
    (robot.root / "usr/local/frc/third-party/lib").mkdir(parents=True)
    (robot.home / "robotCommand").write_text("python3 -m robotpy --main /home/lvuser/py/robot.py run\n")
    assert look_at(robot).other_languages == ()


@pytest.mark.slow
@pytest.mark.usefixtures("patient_doctor")
def test_a_deploy_suggests_removing_java_until_it_is_removed(make_project) -> None:
    require_roborio()
    project = make_project({"robot.py": ROBOT_PY})
    with Roborio(wpilib=OURS) as robot:
        robot.put("home/lvuser/Robot.jar", "content")
        robot.put("home/lvuser/robotCommand", "true\n")
        deploy = ["deploy", "--skip-tests", "--robot", robot.where, "--dry-run"]
        (line,) = (each for each in project.run(*deploy).stdout.splitlines() if "Java" in each)
        remove = f"To remove it: pyfrc undeploy --robot {robot.where} --java-cpp"
        assert line == f"  Java or C++ takes disk space and memory on the robot (/home/lvuser/Robot.jar). {remove}"
        (ready, java) = doctor(project, robot)
        assert (ready.status, ready.text) == (
            "ok",
            f"Python 3.14.0, wpilib {OURS}, image FRC_roboRIO_2026_v1.2",
        )
        assert (java.status, java.remedy) == ("hint", REMOVE)
        assert f"  {java.text}. {remove}" == line
        assert project.run("undeploy", "--java-cpp", "--yes", "--robot", robot.where).code == 0
        assert "Java" not in project.run(*deploy).stdout


# --- without Python


@pytest.mark.usefixtures("patient_doctor")
@pytest.mark.parametrize(
    ("image", "first"),
    [("2026_v1.2", "there is no Python on the robot"), ("2025_v2.0", "the robot's image is of 2025 (2025_v2.0)")],
)
def test_a_robot_without_python(image: str, first: str, make_project) -> None:
    require_roborio()
    project = make_project({"robot.py": ROBOT_PY})
    with Roborio(python=None, image=f"FRC_roboRIO_{image}") as robot:
        robot.put("home/lvuser/robotCommand", JAVA_COMMAND)
        robot.put("home/lvuser/Robot.jar", "content")
        found = doctor(project, robot)
        assert not (project.path / ".pyfrc/known_hosts").exists(), "the doctor changes nothing, here either"
        refused = project.run("deploy", "--skip-tests", "--robot", robot.where)
        assert refused.code == 1
        assert found[0].text.startswith(first)
        assert found[0].remedy in refused.stderr.replace(f" --robot {robot.where}", "")
        assert [each.status for each in found] == ["problem"] * (len(found) - 1) + ["hint"]
        assert all(each.text in refused.stderr for each in found)
        assert "(/home/lvuser/robotCommand, /home/lvuser/Robot.jar)" in found[-1].text
        assert found[-1].remedy == REMOVE
        assert f"To remove it: pyfrc undeploy --robot {robot.where} --java-cpp" in refused.stderr
        # The key of a robot that the project knows is compared.
        robot.power_off()
        robot.new_host_key()
        robot.power_on()
        (changed,) = doctor(project, robot)
        assert "the robot's key has changed" in changed.text
        assert "pyfrc deploy-info" in changed.remedy


# --- with Python


@pytest.mark.parametrize(
    "wrong",
    [
        {"not_controller": "there is no frcKillRobot.sh on it"},
        {"wpilib": None},
        {"python": "3.9.1"},
        {"wpilib": "2026.1.1"},
        {"image": "FRC_roboRIO_2025_v2.0"},
        {"image": "FRC_roboRIO2_2026_v1.1"},
    ],
    ids=lambda wrong: "-".join(map(str, *wrong.items())),
)
def test_the_doctor_reports_what_a_deploy_would_refuse(wrong: dict[str, Any]) -> None:
    facts = replace(READY, **wrong)
    with pytest.raises(RefusedError) as refused:
        refuse_unfit_robot(facts, ROBORIO, "10.12.34.2", check_versions=True)
    (finding,) = check_robot_facts(facts, ROBORIO, None)
    assert finding.status == "problem"
    assert finding.text == refused.value.message
    assert finding.remedy is not None
    assert str(refused.value.remedy).startswith(finding.remedy)


def test_a_robot_that_is_ready() -> None:
    refuse_unfit_robot(READY, ROBORIO, "10.12.34.2", check_versions=True)
    (finding,) = check_robot_facts(READY, ROBORIO, None)
    assert finding.status == "ok"


def test_the_doctor_reports_all_problems_at_once() -> None:
    facts = replace(READY, wpilib=None, python="3.9.1", image="FRC_roboRIO_2025_v2.0")
    assert [each.status for each in check_robot_facts(facts, ROBORIO, None)] == ["problem"] * 3


def test_with_the_downloads_at_hand_only_the_deploy_is_left() -> None:
    missing = (Step.PACKAGES, PREPARE)
    assert first_missing(hint("sync", "", "pyfrc sync"), missing).remedy == "pyfrc sync"
    assert str(first_missing(ok("sync", ""), missing).remedy).startswith("At the robot: pyfrc deploy")


def test_packages_that_the_project_asks_for_and_the_robot_lacks(tmp_path: Path) -> None:
    (tmp_path / "robot.py").write_text(ROBOT_PY)
    (tmp_path / "pyproject.toml").write_text('[tool.robotpy]\ncomponents = ["commands2"]\n')
    (finding,) = check_robot_facts(READY, ROBORIO, find_project(tmp_path))
    assert (
        finding.text == "pyproject.toml:2: components has commands2, but the robot has no package robotpy-commands-v2"
    )


@pytest.mark.parametrize(
    ("there", "step", "remedy"),
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
    ids=lambda value: "-".join(value) if isinstance(value, dict) else "",
)
def test_the_first_missing_step_of_a_robot(there: dict[str, Any], step: Step, remedy: str) -> None:
    facts = replace(READY, **there)
    missing = missing_on_robot(facts, ROBORIO, list(check_robot_facts(facts, ROBORIO, None)))
    assert missing[0] is step
    assert remedy in missing[1]
