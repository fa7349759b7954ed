"""Mistakes that students make first: each is explained in a sentence with its remedy, and without a traceback."""

from __future__ import annotations

import pytest
from conftest import MakeProject, Result
from test_failures import ANY_TEST, ROBOT

TESTS = {"tests/test_a.py": ANY_TEST}


def explained(result: Result, code: int) -> str:
    """The error of a command that ended with this exit code, in which there is no traceback."""
    assert result.code == code, result.output
    assert "Traceback" not in result.output
    assert "INTERNALERROR" not in result.output
    return result.output


# --- files that hide a library


@pytest.mark.parametrize("name", ["random.py", "wpilib.py", "queue/__init__.py"])
def test_a_file_that_hides_a_library_is_named_before_it_is_imported(make_project: MakeProject, name: str) -> None:
    library = name.partition("/")[0].removesuffix(".py")
    project = make_project({"robot.py": ROBOT, **TESTS, name: "1 / 0\n"})
    text = explained(project.run("test"), 2)
    assert f"error: {name} hides a library: import {library} finds it instead\n" in text
    assert "another name." in text


@pytest.mark.parametrize(
    "command", ["sim --ui none --seconds 1", "fuzz --runs 1", "replay x.jsonl", "deploy", "profile test", "--pytest"]
)
def test_each_command_that_runs_the_robot_names_such_a_file(make_project: MakeProject, command: str) -> None:
    project = make_project({"robot.py": ROBOT, **TESTS, "commands2.py": "1 / 0\n"})
    if command == "--pytest":
        text = explained(project.run(program="pytest", cold=True), 4)
    else:
        text = explained(project.run(*command.split()), 2)
    assert "commands2.py hides a library: import commands2 finds it instead" in text


def test_files_with_names_of_their_own_and_rarely_used_ones_hide_nothing(make_project: MakeProject) -> None:
    files = {
        "constants.py": "X = 1\n",
        "turtle.py": "Y = 1\n",
        "tests/__init__.py": "",
        "rev/notes.txt": "no package",
        "time/notes.txt": "no package",
        "robot.py": f"import constants\nimport turtle\nprint(turtle.Y){ROBOT}".replace("\n    ", "\n"),
    }
    assert make_project(files | TESTS).run("test").code == 0


def test_a_file_with_the_name_of_a_built_in_module_is_said_never_to_be_imported(make_project: MakeProject) -> None:
    text = explained(make_project({"robot.py": ROBOT, **TESTS, "time.py": ""}).run("test"), 2)
    assert "time.py has the name of a library: import time finds that, never this file" in text


# --- text files in other encodings


@pytest.mark.parametrize(
    ("content", "place", "what"),
    [
        (ROBOT.encode("utf-16"), "robot.py", "this file is in UTF-16"),
        (ROBOT.encode("utf-16-le"), "robot.py", "this file is in UTF-16"),
        (b"import wpilib\n\n# \0\0\0\n", "robot.py:3", "null bytes"),
        ("import wpilib\nNAME = 'Jos\xe9'\n".encode("latin-1"), "robot.py:2", "0xe9, probably the character 'é'"),
    ],
    ids=["utf-16", "utf-16-without-mark", "null-bytes", "latin-1"],
)
def test_a_robot_in_another_encoding_is_explained(
    make_project: MakeProject, content: bytes, place: str, what: str
) -> None:
    project = make_project({"robot.py": "", **TESTS})
    (project.path / "robot.py").write_bytes(content)
    result = project.run("test")
    explained(result, 1)
    assert result.first_error.startswith(f"{place}: ")
    assert what in result.first_error


def test_another_module_in_utf_16_is_named(make_project: MakeProject) -> None:
    project = make_project({"robot.py": f"import arm\n{ROBOT}".replace("\n    ", "\n"), **TESTS})
    (project.path / "arm.py").write_bytes("x = 1\n".encode("utf-16"))
    result = project.run("test")
    explained(result, 1)
    assert result.first_error.startswith("arm.py: this file is in UTF-16")
    assert "Save it as UTF-8" in result.stderr


@pytest.mark.parametrize("isolation", ["none", "spawn"])
def test_a_byte_order_mark_before_the_settings_does_no_harm(make_project: MakeProject, isolation: str) -> None:
    settings = "\ufeff[tool.pyfrc.test]\njobs = 1\n[tool.pytest.ini_options]\naddopts = '-v'\n"
    project = make_project({"robot.py": ROBOT, "pyproject.toml": settings, **TESTS})
    result = project.run("test", "--isolation", isolation)
    assert result.code == 0, result.output
    assert set(result.outcomes().values()) == {"PASSED"}  # so pytest has read -v in it


def test_settings_in_utf_16_are_explained(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, **TESTS})
    (project.path / "pyproject.toml").write_bytes("[tool.pyfrc]\n".encode("utf-16"))
    text = explained(project.run("test"), 2)
    assert "pyproject.toml: not valid TOML: this file is in UTF-16" in text
    assert "Save it as UTF-8" in text


# --- keys of the same name in several tables


def test_a_repeated_key_is_reported_at_its_own_tables_line(make_project: MakeProject) -> None:
    settings = """
        [tool.other]
        team = 1
        text = '''
        [tool.pyfrc]
        team = 2
        '''
        [tool.pyfrc]
        list = [  # ]
            "]",
        ]
        team = 3
        [tool.third]
        team = 4
        [tool.fourth]
        team = 5
        team = 6
    """
    project = make_project({"robot.py": ROBOT, "pyproject.toml": settings})
    result = project.run("test")
    explained(result, 2)
    assert result.first_error.startswith("pyproject.toml:16: not valid TOML: tool.fourth.team is there twice")


def test_a_wrong_value_is_reported_at_its_own_tables_line(make_project: MakeProject) -> None:
    settings = "[tool.other]\nteam = 'a'\n[tool.pyfrc.match]\nteleop = 1\n[tool.pyfrc]\nteam = 'b'\n"
    result = make_project({"robot.py": ROBOT, "pyproject.toml": settings}).run("test")
    explained(result, 2)
    assert result.first_error.startswith("pyproject.toml:6: tool.pyfrc.team = 'b'")


# --- where the project is


def test_one_directory_too_high_names_the_projects_below(make_project: MakeProject) -> None:
    project = make_project({"myrobot/robot.py": ROBOT, "myrobot/tests/test_a.py": ANY_TEST})
    result = project.run("test")
    explained(result, 2)
    assert f"there is no robot.py in or above {project.path}, but there is one in ./myrobot" in result.first_error
    assert "Go there with: cd myrobot. Or name it with: --project myrobot" in result.stderr
    assert project.run("test", "--project", "myrobot").code == 0


# --- mistakes in the robot's code

ASKS_THE_KEYBOARD = """
    import wpilib
    {}

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            {}

        def teleopPeriodic(self):
            {}
"""

IN_TELEOP = """
    def test_it(control, robot):
        with control.run_robot():
            control.step_timing(seconds=1, autonomous=False, enabled=True)
"""


@pytest.mark.parametrize("where", [0, 1, 2], ids=["at-import", "in-robotInit", "in-teleopPeriodic"])
def test_input_in_robot_code_is_refused_with_its_line(make_project: MakeProject, where: int) -> None:
    lines = ["pass"] * 3
    lines[where] = 'NAME = input("Speed? ")'
    project = make_project({"robot.py": ASKS_THE_KEYBOARD.format(*lines), "tests/test_a.py": IN_TELEOP})
    expected = f"{project.place('robot.py', 'input(')}: input() waits for a keyboard, and a robot has none"
    for command in (["test"], ["sim", "--ui", "none", "--mode", "teleop", "--seconds", "1"]):
        text = explained(project.run(*command, stdin="5\n"), 1)
        assert expected in text
        assert "SendableChooser" in text


@pytest.mark.parametrize(
    ("definition", "corrected"),
    [
        ("def teleopPeriodic():", "def teleopPeriodic(self):"),
        ("def helper(speed):", "def helper(self, speed):"),
        ("def __init__():", "def __init__(self):"),
    ],
)
def test_a_missing_self_is_named_with_the_methods_line(
    make_project: MakeProject, definition: str, corrected: str
) -> None:
    robot = f"""
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            {definition}
                pass

            def teleopInit(self):
                if hasattr(self, "helper"):
                    self.helper(1)
    """
    project = make_project({"robot.py": robot, "tests/test_a.py": IN_TELEOP})
    for command in (["test"], ["sim", "--ui", "none", "--mode", "teleop", "--seconds", "1"]):
        result = project.run(*command)
        assert result.code == 1
        assert f"{project.place('robot.py', definition)}: the method " in result.output
        assert f"has no parameter self: write {corrected}" in result.output
