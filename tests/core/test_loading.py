"""Importing a robot program: its class, and what is said of a program that cannot be imported."""

from __future__ import annotations

import builtins
import sys
from collections.abc import Callable, Generator, Mapping
from pathlib import Path
from textwrap import dedent

import pytest

from pyfrc_core.config.settings import Settings
from pyfrc_core.errors import ProjectError, RobotCodeError
from pyfrc_core.project import Project
from pyfrc_core.runtime import keyboard_input
from pyfrc_core.runtime.loading import import_file, load_robot

ROBOT = """
import wpilib

class MyRobot(wpilib.TimedRobot):
    pass
"""

MakeProject = Callable[..., Project]


@pytest.fixture
def make_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Generator[MakeProject]:
    """Makes projects; what importing them changes in this process is undone."""
    monkeypatch.setattr(sys, "path", sys.path.copy())
    monkeypatch.setattr(builtins, "input", builtins.input)
    monkeypatch.setattr(keyboard_input, "_files", [])

    def make_project(
        main: str | bytes, files: Mapping[str, str | bytes] = {}, settings: Settings | None = None
    ) -> Project:
        for name, text in {"robot.py": main, **files}.items():
            file = tmp_path / name
            file.parent.mkdir(exist_ok=True)
            file.write_bytes(text if isinstance(text, bytes) else dedent(text).lstrip("\n").encode())
        project = Project(tmp_path / "robot.py")
        vars(project)["settings"] = settings or Settings()
        return project

    yield make_project
    for name, module in list(sys.modules.items()):
        if (getattr(module, "__file__", None) or "").startswith(str(tmp_path)):
            del sys.modules[name]


def refusal(project: Project) -> RobotCodeError | ProjectError:
    with pytest.raises((RobotCodeError, ProjectError)) as caught:
        load_robot(project)
    return caught.value


def test_a_robot_program_is_imported_once(make_project: MakeProject) -> None:
    project = make_project(ROBOT + "import helper\n", {"helper.py": "number = 7"})
    robot = load_robot(project)
    assert robot.__name__ == "MyRobot"
    assert robot.__module__ == "robot"
    assert sys.path[0] == str(project.root)
    assert sys.modules["helper"].number == 7
    assert load_robot(project) is robot
    assert sys.path.count(str(project.root)) == 1


def test_a_module_of_the_same_name_from_elsewhere_is_not_taken(make_project: MakeProject, tmp_path: Path) -> None:
    other = tmp_path / "other"
    other.mkdir()
    (other / "robot.py").write_text("here = 'other'")
    project = make_project("here = 'project'")
    assert import_file(project, other / "robot.py").here == "other"
    assert import_file(project, tmp_path / "robot.py").here == "project"


@pytest.mark.parametrize(
    ("text", "where", "message", "remedy"),
    [
        ("x = 1\ny = 1 / 0\n", "robot.py:2", "ZeroDivisionError: division by zero", "imported."),
        ("x = 1\n\ndef f(:\n", "robot.py:3", "SyntaxError: invalid syntax\n    def f(:", ""),
        (
            "import sys\nsys.exit(3)\n",
            "robot.py:2",
            "exit(3)",
            "A robot program must not end by itself: remove that line.",
        ),
        ("import wpilib\nwpilib.run(None)\n", "robot.py:2", "wpilib.run() is called", "Remove this line"),
        ("import none_such\n", "robot.py:1", "there is no module none_such", "is the name right"),
        ("x = wpilib.Timer()\n", "robot.py:1", "name 'wpilib' is not defined", "at the top: import wpilib"),
        ("x = math.pi\n", "robot.py:1", "name 'math' is not defined", "at the top: import math"),
        ("x = mine\n", "robot.py:1", "name 'mine' is not defined", "did you mean min?"),
        ("import broken\n", "broken.py:2", "x has no key 'key'", "There is nothing here"),
        ("input('name? ')\n", "robot.py:1", "input() waits for a keyboard", "Ask the driver station instead"),
        (
            b"x = 1\ny = 'caf\xe9'\n",
            "robot.py:2",
            "it has the byte 0xe9, probably the character 'é'",
            "Save it as UTF-8",
        ),
        ("x = 1\n".encode("utf-16"), "robot.py", "this file is in UTF-16", "Save it as UTF-8"),
        ("x = 1\n".encode("utf-16-le"), "robot.py", "this file is in UTF-16", "Save it as UTF-8"),
        (b"x = 1\nx = '\0'\n", "robot.py:2", "this file contains null bytes", "The file is damaged"),
        ("import strange\n", "strange.py:1", "this line is not UTF-8", "Save it as UTF-8"),
        ("raise ValueError('null bytes')\n", "robot.py:1", "ValueError: null bytes", "imported."),
    ],
)
def test_a_program_that_cannot_be_imported(
    text: str | bytes, where: str, message: str, remedy: str, make_project: MakeProject
) -> None:
    others: dict[str, str | bytes] = {"broken.py": "x = {}\nx['key']\n"}
    if isinstance(text, str) and "strange" in text:
        others["strange.py"] = b"x = '\xe9'\n"
    project = make_project(text, others)
    error = refusal(project)
    assert error.where == where
    assert message in error.message
    assert remedy.lower() in (error.remedy or "").lower()
    assert "robot" not in sys.modules


def test_what_is_missing_may_be_among_the_requirements(make_project: MakeProject) -> None:
    project = make_project("import none_such")
    assert "requirements.txt" not in (refusal(project).remedy or "")
    (project.root / "requirements.txt").write_text("pyfrc\n")
    assert "requirements.txt" not in (refusal(project).remedy or "")
    (project.root / "requirements.txt").write_text("none_such>=3\n")
    assert (refusal(project).remedy or "").endswith("python -m pip install -r requirements.txt")


def test_a_file_that_hides_a_library_is_named(make_project: MakeProject, monkeypatch: pytest.MonkeyPatch) -> None:
    project = make_project("from random import choice\n", {"random.py": ""})
    monkeypatch.delitem(sys.modules, "random")
    assert "random.py hides a library" in (refusal(project).remedy or "")
    failing = make_project("raise KeyError\n", {"random.py": ""})
    assert "random.py" not in (refusal(failing).remedy or "")


# -- the robot's class -------------------------------------------------------------------------------------------------


def test_a_robot_class_of_this_file_counts_before_those_of_others(make_project: MakeProject) -> None:
    elsewhere = "import wpilib\nclass Elsewhere(wpilib.TimedRobot): ...\n"
    main = "import wpilib\nfrom other import Elsewhere\nclass Here(wpilib.TimedRobot): ...\n"
    assert load_robot(make_project(main, {"other.py": elsewhere})).__name__ == "Here"


@pytest.mark.parametrize(
    ("main", "module"),
    [
        ("import wpilib\nclass Base(wpilib.TimedRobot): ...\nclass MyRobot(Base): ...\n", "robot"),
        ("from frame.chassis import MyRobot\n", "frame.chassis"),
        (f'{ROBOT}\nif __name__ == "__main__":\n    wpilib.run(MyRobot)\n', "robot"),
    ],
    ids=["derived", "of another file", "run as a program"],
)
def test_a_robot_class_is_found(main: str, module: str, make_project: MakeProject) -> None:
    robot = load_robot(make_project(main, {"frame/__init__.py": "", "frame/chassis.py": ROBOT}))
    assert (robot.__name__, robot.__module__) == ("MyRobot", module)


@pytest.mark.parametrize(
    ("text", "where", "message", "remedy"),
    [
        (
            "import os\n\nclass Helper: ...\n\nclass MyRobot:\n    def teleopInit(self): ...\n",
            "robot.py:5",
            "the class MyRobot is not derived from a robot class",
            "Write: class MyRobot(wpilib.TimedRobot):",
        ),
        ("class Helper:\n    def drive(self): ...\n", "robot.py", "there is no robot class in this file", "Define one"),
        (
            "class Sub(dict):\n    def teleopInit(self): ...\n",
            "robot.py",
            "there is no robot class in this file",
            "Define one",
        ),
    ],
)
def test_a_file_without_a_robot_class(
    text: str, where: str, message: str, remedy: str, make_project: MakeProject
) -> None:
    error = refusal(make_project(text))
    assert (error.where, error.message) == (where, message)
    assert (error.remedy or "").startswith(remedy)
