"""What the user's own files are to the runtime: their lines in errors, their names, their waits and their time."""

from __future__ import annotations

import sys
from collections.abc import Callable, Generator
from pathlib import Path
from textwrap import dedent
from types import ModuleType, SimpleNamespace
from typing import Any

import commands2
import pytest
import wpilib

from pyfrc_core.errors import RobotCodeError, UsageError
from pyfrc_core.project import Project
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime.checks.failures import (
    as_robot_code_error,
    headline,
    headline_is_the_robots,
    leave_out_libraries,
)
from pyfrc_core.runtime.checks.foreign_paths import find_foreign_paths
from pyfrc_core.runtime.checks.misspelled_methods import find_misspelled_methods, refuse_unawaited_methods
from pyfrc_core.runtime.checks.sources import sources
from pyfrc_core.runtime.match import MatchPeriods
from pyfrc_core.runtime.patches.install import patches

Import = Callable[..., ModuleType]


@pytest.fixture
def import_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Import:
    """Imports a text as a file of the project."""

    def import_text(text: str, name: str = "robot", **names: object) -> ModuleType:
        file = tmp_path / f"{name}.py"
        file.parent.mkdir(exist_ok=True)
        file.write_text(dedent(text).lstrip("\n"))
        module = ModuleType(name)
        module.__file__ = str(file)
        vars(module).update(names)
        monkeypatch.setitem(sys.modules, name, module)
        exec(compile(file.read_text(), str(file), "exec"), vars(module))
        return module

    return import_text


@pytest.fixture
def files(tmp_path: Path) -> RobotFiles:
    """The project's."""
    return RobotFiles(tmp_path)


def raised_by(call: Callable[[], object]) -> BaseException:
    try:
        call()
    except Exception as error:
        return error
    raise AssertionError("it raises nothing")


# -- errors ------------------------------------------------------------------------------------------------------------


def test_an_error_is_told_by_the_users_line(import_text: Import, files: RobotFiles) -> None:
    robot = import_text(
        """
        def inner(call):
            call()

        def outer(call):
            inner(call)
        """
    )
    error = raised_by(lambda: robot.outer(lambda: {}["key"]))
    assert headline(error, files) == "robot.py:2: KeyError: 'key'"
    assert str(as_robot_code_error(error, files)) == "robot.py:2: KeyError: 'key'"
    leave_out_libraries(error, files)
    elsewhere = raised_by(lambda: {}["key"])
    assert headline(elsewhere, files) is None
    assert str(as_robot_code_error(elsewhere, files)).startswith("KeyError: 'key' (in ")
    named = UsageError("wrong", where="robot.py:7")
    assert headline(named, files) == "robot.py:7: wrong"
    assert as_robot_code_error(named, files) is named
    assert isinstance(as_robot_code_error(error, files), RobotCodeError)
    assert headline_is_the_robots("robot.py:2: KeyError", files)
    assert not headline_is_the_robots("tests/robot_test.py:2: KeyError", files)


@pytest.mark.parametrize(
    ("method", "word"),
    [("async def teleopPeriodic(self): ...", "async"), ("def teleopPeriodic(self): yield", "yield")],
)
def test_a_method_that_nothing_waits_for_is_refused(
    import_text: Import, files: RobotFiles, method: str, word: str
) -> None:
    import_text(f"class Robot(wpilib.TimedRobot):\n    async def helper(self): ...\n    {method}\n", wpilib=wpilib)
    with pytest.raises(RobotCodeError, match=f"robot.py:3: Robot.teleopPeriodic never runs.*{word}") as refused:
        refuse_unawaited_methods(SimpleNamespace(files=files))  # type: ignore[arg-type]
    assert "Write " in (refused.value.remedy or "")


def test_files_that_only_this_computer_has(import_text: Import, files: RobotFiles, tmp_path: Path) -> None:
    import_text(
        """
        PLACE = "/data/log.txt"
        class Robot:
            def write(self):
                logging.basicConfig(level=3, filename="/logs/robot.log")
                open(PLACE, "a")
                Path("/data").mkdir()
                wpilib.DataLogManager.start("/logs")
                open("C:\\\\path.json")
                open("/home/ada/path.json")
            def fine(self):
                logging.basicConfig(level=3)
                open("/home/lvuser/log.txt", "w")
                open("/tmp/log.txt", "w")
                open("/etc/hostname")
                open("log.txt", "w")
                self.timer.start("/logs")
                table.putNumber("/logs/number", 1)
                if wpilib.RobotBase.isSimulation() and self.enabled:
                    open("/home/ada/path.json")
                elif not self.isReal():
                    open("/home/ada/path.json")
                else:
                    open("/home/ada/robot.json")
                if not RobotBase.is_simulation():
                    open("/home/ada/robot.json")
                open("/home/ada/path.json") if is_simulation() else open("/home/ada/robot.json")
        """
    )
    project = SimpleNamespace(files=files, physics_file=tmp_path / "physics.py")
    found = [str(each) for each in find_foreign_paths(list(sources(project)))]  # type: ignore[arg-type]
    assert [each.partition(": on the")[0] for each in found] == [
        "robot.py:4: the robot program may not write /logs/robot.log",
        "robot.py:5: the robot program may not write /data/log.txt",
        "robot.py:6: the robot program may not write /data",
        "robot.py:7: the robot program may not write /logs",
        "robot.py:8: C:\\path.json is a path of this computer, which the robot does not have",
        "robot.py:9: /home/ada/path.json is a path of this computer, which the robot does not have",
        *(
            f"robot.py:{line}: /home/ada/robot.json is a path of this computer, which the robot does not have"
            for line in (23, 25, 26)
        ),
    ]


def test_a_method_of_a_mode_inside_another_method(import_text: Import, files: RobotFiles) -> None:
    import_text(
        """
        class Robot(wpilib.TimedRobot):
            def robotInit(self):
                self.count = 0
                def teleopPeriodic(self):
                    self.count += 1
                def robotPeriodic(self):
                    self.count += 1
                def autonomousPeriodic():
                    return self.count
                def helper(self):
                    return self.count
            def robotPeriodic(self):
                self.count += 1
        """,
        wpilib=wpilib,
    )
    (found,) = find_misspelled_methods(SimpleNamespace(files=files))  # type: ignore[arg-type]
    assert str(found) == "robot.py:4: WPILib never calls teleopPeriodic, which is inside Robot.robotInit"
    assert found.remedy == "Indent it as much as robotInit."


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (
            "Drive().periodic()",
            "robot.py:2: Drive.periodic(self, dt) has other parameters than the method that it replaces",
        ),
        (
            "Robot.teleopPeriodic(None)",
            "robot.py:4: Robot.teleopPeriodic(self, dt) has other parameters than the method",
        ),
        ("Go().end(True)", "robot.py:6: Go.end(self) has other parameters than the method that it replaces"),
    ],
)
def test_a_method_that_takes_other_values_than_a_library_passes(
    import_text: Import, files: RobotFiles, call: str, text: str
) -> None:
    robot = import_text(
        """
        class Drive(commands2.Subsystem):
            def periodic(self, dt): ...
        class Robot(wpilib.TimedRobot):
            def teleopPeriodic(self, dt): ...
        class Go(commands2.Command):
            def end(self): ...
        """,
        wpilib=wpilib,
        commands2=commands2,
    )
    error = raised_by(lambda: eval(call, vars(robot)))
    found = headline(error, files) or ""
    assert found.startswith(text)
    name, passed = text.partition(".py")[2].partition(".")[2].partition("(")[0], "interrupted" if "end" in call else ""
    assert found.endswith(f"Write def {name}({', '.join(filter(None, ['self', passed]))}):")


def test_a_test_reads_what_the_robot_does_not_have_yet(import_text: Import, files: RobotFiles) -> None:
    robot = import_text("class Robot:\n    def robotInit(self):\n        self.motor = 3\n")
    test = import_text("def look(robot):\n    return robot.motor\n", name="tests/test_it")
    assert headline(raised_by(lambda: test.look(robot.Robot())), files) == (
        "tests/test_it.py:2: the robot does not have motor yet: robotInit sets it (robot.py:3), which runs when the "
        "test runs the robot\n  Read it after control.run_test(...), or inside: with control.run_robot():"
    )


# -- time --------------------------------------------------------------------------------------------------------------


@pytest.fixture
def patched(files: RobotFiles) -> Generator[None]:
    """The names are replaced for the project."""
    patches.install(files)
    try:
        yield
    finally:
        patches.uninstall()


def test_a_match_and_its_periods() -> None:
    settings: Any = SimpleNamespace(before=1.0, autonomous=20.0, pause=3.0, teleop=140.0)
    match = MatchPeriods(settings)
    assert match.length_us == 164_000_000
    assert [match.at(us) for us in (0, 999_999, 1_000_000, 20_999_999)] == [
        ("disabled", 0.0),
        ("disabled", 0.0),
        ("autonomous", 20.0),
        ("autonomous", 1e-6),
    ]
    assert [match.at(us) for us in (21_000_000, 23_999_999, 24_000_000, 163_999_999, 164_000_000)] == [
        ("disabled", 0.0),
        ("disabled", 0.0),
        ("teleop", 140.0),
        ("teleop", 1e-6),
        None,
    ]


def test_a_project_in_a_directory_called_tests(tmp_path: Path) -> None:
    root = tmp_path / "tests"
    files = RobotFiles(root)
    assert files.is_robot_code(str(root / "robot.py"))
    assert not files.is_robot_code(str(root / "tests" / "test_a.py"))
    assert Project(root / "robot.py").test_directories == (root / "tests", root / "tests")
    assert RobotFiles(tmp_path / "code").relative(str(tmp_path / "tests" / "a.py")) == str(Path("..", "tests", "a.py"))
