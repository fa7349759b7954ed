"""Where the robot is: found from anywhere in the project, chosen by options or settings, created by `pyfrc init`."""

from __future__ import annotations

from pathlib import Path

from conftest import MakeProject, RobotProject

from pyfrc import __version__

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


def test_a_project_is_found_from_a_directory_in_it(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": FINDS_IT, "deploy/paths/one.txt": "left\n"})
    assert_finds_it(project, cwd=project.path / "deploy" / "paths")


def test_a_project_is_found_where_an_option_says(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": FINDS_IT})
    assert_finds_it(project, "--project", project.path, cwd=project.temporary)


def test_a_program_of_another_name_is_found_where_an_option_says(make_project: MakeProject) -> None:
    project = make_project({"practice.py": ROBOT, "tests/test_a.py": FINDS_IT})
    assert_finds_it(project, "--main", "practice.py")


def test_a_program_of_another_name_is_found_by_the_settings(make_project: MakeProject) -> None:
    project = make_project(
        {
            "src/practice.py": ROBOT,
            "src/tests/test_a.py": FINDS_IT,
            "pyproject.toml": '[tool.pyfrc]\nmain = "src/practice.py"\n',
        }
    )
    assert_finds_it(project)


def test_all_settings_hold_for_a_program_deep_in_the_project(make_project: MakeProject) -> None:
    another = "\n\n    class Another(wpilib.TimedRobot):\n        pass\n"
    project = make_project(
        {
            "src/robots/practice.py": ROBOT + another,
            "src/robots/tests/test_a.py": FINDS_IT,
            "pyproject.toml": '[tool.pyfrc]\nmain = "src/robots/practice.py"\nrobot_class = "MyRobot"\n',
        }
    )
    for isolation in ("auto", "reuse"):
        assert_finds_it(project, "--isolation", isolation)


def test_settings_win_over_a_robot_py_beside_them(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT.replace("found", "not meant"),
            "practice.py": ROBOT,
            "tests/test_a.py": FINDS_IT,
            "pyproject.toml": '[tool.pyfrc]\nmain = "practice.py"\n',
        }
    )
    assert_finds_it(project)


def test_a_program_that_the_settings_name_wrongly_is_told(make_project: MakeProject) -> None:
    project = make_project({"pyproject.toml": '[tool.pyfrc]\nmain = "practise.py"\n'})
    result = project.run("test")
    assert result.code == 2
    assert "main = 'practise.py' under [tool.pyfrc], but there is no such file" in result.first_error


def test_a_robot_class_of_another_file_is_found(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": "from frame.chassis import MyRobot\n",
            "frame/__init__.py": "",
            "frame/chassis.py": ROBOT,
            "tests/test_a.py": FINDS_IT,
        }
    )
    assert_finds_it(project)


def test_of_a_base_class_and_its_derived_class_the_derived_is_the_robot(make_project: MakeProject) -> None:
    robot = """
        import wpilib


        class BaseRobot(wpilib.TimedRobot):
            name = "base"


        class MyRobot(BaseRobot):
            name = "found"
    """
    assert_finds_it(make_project({"robot.py": robot, "tests/test_a.py": FINDS_IT}))


def test_a_robot_run_as_a_program_is_not_started_by_its_import(make_project: MakeProject) -> None:
    robot = ROBOT + '\n\n    if __name__ == "__main__":\n        wpilib.run(MyRobot)\n'
    assert_finds_it(make_project({"robot.py": robot, "tests/test_a.py": FINDS_IT}))


def test_a_project_with_spaces_and_accents_in_its_name_is_found(make_project: MakeProject) -> None:
    project = make_project({"équipe 4711/robot.py": ROBOT, "équipe 4711/tests/test_a.py": FINDS_IT})
    assert_finds_it(project, cwd=project.path / "équipe 4711")


# -- pyfrc init -----------------------------------------------------------------------------------------------------


def contents(directory: Path) -> dict[str, bytes]:
    return {
        file.relative_to(directory).as_posix(): file.read_bytes() for file in directory.rglob("*") if file.is_file()
    }


# -- the command itself ---------------------------------------------------------------------------------------------


def test_the_version_is_told(make_project: MakeProject) -> None:
    result = make_project({}).run("--version")
    assert result.code == 0
    assert result.stdout.strip() == f"pyfrc, version {__version__}"
