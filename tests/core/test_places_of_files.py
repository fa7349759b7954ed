"""All commands agree where the robot is, and name a physics module in a place where none of them reads it."""

from __future__ import annotations

from pathlib import Path

import pytest

from pyfrc_core.doctor.examine import DoctorOptions, _project
from pyfrc_core.errors import ProjectError, UsageError
from pyfrc_core.physics.create.files import create_physics
from pyfrc_core.project import Project, find_project
from pyfrc_core.runtime.checks.code_checks import find_misplaced_physics

ROBOT = "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
PHYSICS = "class PhysicsEngine:\n    pass\n"


def make(root: Path, **files: str) -> Path:
    for name, text in files.items():
        file = root / f"{name.replace('_', '/')}.py"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return root


@pytest.mark.parametrize("files", [{"src_robot": ROBOT}, {"main": ROBOT}, {}])
def test_doctor_says_where_the_robot_is_as_other_commands_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, files: dict[str, str]
) -> None:
    monkeypatch.chdir(make(tmp_path, **files))
    with pytest.raises(ProjectError) as error:
        find_project()
    project, result = _project(DoctorOptions())
    assert project is None
    assert result is not None
    assert (result.status, result.text, result.remedy) == ("hint", error.value.message, error.value.remedy)


@pytest.mark.parametrize(("place", "shown"), [("sim_physics", "sim/physics.py"), ("robot_physics", "robot/physics.py")])
def test_a_physics_module_elsewhere_is_named(tmp_path: Path, place: str, shown: str) -> None:
    project = Project(make(tmp_path, robot=ROBOT, **{place: PHYSICS}) / "robot.py")
    (warning,) = find_misplaced_physics(project)
    assert str(warning) == f"{shown}: pyfrc does not read this file: physics.py belongs beside robot.py"
    assert warning.remedy == f"Move it to {tmp_path}."
    with pytest.raises(UsageError, match=f"there is a {shown}, which pyfrc does not read"):
        create_physics(project)
    assert not project.physics_file.exists()


def test_one_above_the_code_is_named(tmp_path: Path) -> None:
    project = Project(make(tmp_path, src_robot=ROBOT, physics=PHYSICS) / "src" / "robot.py")
    (warning,) = find_misplaced_physics(project)
    assert warning.where == "../physics.py"


@pytest.mark.parametrize("files", [{"physics": PHYSICS, "sim_physics": PHYSICS}, {"lib_physics": "g = 9.81\n"}, {}])
def test_another_module_of_this_name_is_none_of_pyfrcs(tmp_path: Path, files: dict[str, str]) -> None:
    assert find_misplaced_physics(Project(make(tmp_path, robot=ROBOT, **files) / "robot.py")) == []
