"""What the user's own files are to the runtime: their lines in errors, their names, their waits and their time."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Generator
from dataclasses import replace
from pathlib import Path
from textwrap import dedent
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
import wpilib

from pyfrc_core.config.settings import Settings
from pyfrc_core.errors import RobotCodeError, UsageError
from pyfrc_core.hal import modes
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime.clock import KICKOFF
from pyfrc_core.runtime.failures import as_robot_code_error, headline, headline_is_the_robots, leave_out_libraries
from pyfrc_core.runtime.foreign_paths import find_foreign_paths
from pyfrc_core.runtime.loop_limit import LoopLimit, LoopWaitsError
from pyfrc_core.runtime.match import MatchPeriods
from pyfrc_core.runtime.misspelled_methods import find_misspelled_methods, refuse_unawaited_methods
from pyfrc_core.runtime.patches import patches
from pyfrc_core.runtime.robot import RobotRun

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


def test_a_method_without_self_is_named(import_text: Import, files: RobotFiles) -> None:
    robot = import_text(
        """
        class Robot:
            def teleopPeriodic():
                pass

            def drive(speed, turn):
                pass

            def stop(self):
                pass
        """
    )
    assert headline(raised_by(lambda: robot.Robot().teleopPeriodic()), files) == (
        "robot.py:2: the method teleopPeriodic() has no parameter self: write def teleopPeriodic(self):"
    )
    assert headline(raised_by(lambda: robot.Robot().drive(1, 2)), files) == (
        "robot.py:5: the method drive(speed, turn) has no parameter self: write def drive(self, speed, turn):"
    )
    more = headline(raised_by(lambda: robot.Robot().stop(1)), files)  # it has a self, and is called wrongly
    assert more == "robot.py:8: TypeError: Robot.stop() takes 1 positional argument but 2 were given"
    missing = headline(raised_by(lambda: robot.Robot().drive()), files)
    assert missing is not None
    assert missing.startswith("robot.py:5: TypeError: Robot.drive() missing 1 required positional argument")


def test_methods_whose_names_are_misspelled(import_text: Import, files: RobotFiles) -> None:
    import_text(
        """
        class Robot(wpilib.TimedRobot):
            def teleopPeriodc(self): ...
            def autoInit(self): ...
            def robot_init(self): ...
            def disabledPeriodic(self): ...
            def disabledPeriodik(self): ...
            def helper(self): ...
            def testInti(self): ...
            def autonomousPeriodc(self): self.called()
            def called(self): ...
            def simulationInnit(self): return self.robotPeriodec
            def robotPeriodec(self): ...

        class Other:
            def teleopPeriodc(self): ...
        """,
        wpilib=wpilib,
    )
    found = find_misspelled_methods(SimpleNamespace(files=files))  # type: ignore[arg-type]
    assert [str(each) for each in found] == [
        "robot.py:2: WPILib never calls Robot.teleopPeriodc: did you mean teleopPeriodic?",
        "robot.py:3: WPILib never calls Robot.autoInit: did you mean autonomousInit?",
        "robot.py:4: WPILib never calls Robot.robot_init: did you mean robotInit? "
        "(snake_case names are those of WPILib 2027)",
        "robot.py:8: WPILib never calls Robot.testInti: did you mean testInit?",
        "robot.py:9: WPILib never calls Robot.autonomousPeriodc: did you mean autonomousPeriodic?",
        "robot.py:11: WPILib never calls Robot.simulationInnit: did you mean _simulationInit?",
    ]
    assert found[0].remedy == "Rename it to teleopPeriodic."


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
                if wpilib.RobotBase.isSimulation():
                    open("/home/ada/path.json")
        """
    )
    project = SimpleNamespace(files=files, physics_file=tmp_path / "physics.py")
    found = [str(each) for each in find_foreign_paths(project)]  # type: ignore[arg-type]
    assert [each.partition(": on the")[0] for each in found] == [
        "robot.py:4: the robot program may not write /logs/robot.log",
        "robot.py:5: the robot program may not write /data/log.txt",
        "robot.py:6: the robot program may not write /data",
        "robot.py:7: the robot program may not write /logs",
        "robot.py:8: C:\\path.json is a path of this computer, which the robot does not have",
        "robot.py:9: /home/ada/path.json is a path of this computer, which the robot does not have",
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


# -- a loop that waits -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("mode", "waits", "exceeded"),
    [("teleop", 100, None), ("teleop", 100.001, 120.001), ("autonomous", 300, None), ("autonomous", 301, 320.001)],
)
def test_a_turn_of_the_loop_has_so_much_time(
    mode: str, waits: float, exceeded: float | None, run: RobotRun, import_text: Import, files: RobotFiles
) -> None:
    def wait(milliseconds: float) -> None:
        if milliseconds:
            run.threads.sleep_until(run.clock.now_us + round(milliseconds * 1000))

    robot = import_text(
        """
        class Robot(wpilib.TimedRobot):
            def teleopPeriodic(self):
                self.drive()

            def autonomousPeriodic(self):
                self.drive()

            def drive(self):
                wait(times.pop() if times else 0)
        """,
        wpilib=wpilib,
        wait=wait,
        times=[0, 0, 0, waits],
    )
    settings = Settings()
    settings = replace(
        settings, test=replace(settings.test, loop_seconds=0.1), match=replace(settings.match, autonomous=0.3)
    )
    found: list[tuple[float, LoopWaitsError]] = []
    LoopLimit(run, files, settings, lambda error: found.append((run.clock.now_us / 1000, error)))
    run.construct(robot.Robot)
    run.start()
    modes.set_mode_named(mode)
    run.run_until(360_000)
    assert [at for at, _ in found] == ([] if exceeded is None else [exceeded])
    for _, error in found:
        assert (error.place, error.begins_at, error.function) == ("robot.py:9", "robot.py:8", f"{mode}Periodic")
        assert error.note.startswith(f"robot.py:9: {mode}Periodic has not returned after 0.{3 if waits > 200 else 1} s")


# -- time --------------------------------------------------------------------------------------------------------------


@pytest.fixture
def patched(files: RobotFiles) -> Generator[None]:
    """The names are replaced for the project."""
    patches.install(files)
    try:
        yield
    finally:
        patches.uninstall()


def test_the_projects_files_have_robot_time(patched: None, run: RobotRun, import_text: Import) -> None:
    robot = import_text(
        """
        import threading, time, wpilib

        def read():
            return [getattr(time, name)() for name in names]

        names = ["time", "time_ns", "monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns"]

        def sleep(seconds):
            time.sleep(seconds)

        def wait(seconds):
            wpilib.wait(seconds)

        def lock():
            return threading.Lock().acquire(timeout=1), threading.Event().wait(0.25)
        """
    )
    run.clock.run_until(1_500_000)
    assert robot.read() == [
        KICKOFF + 1.5,
        KICKOFF * 10**9 + 1_500_000_000,
        1.5,
        1_500_000_000,
        1.5,
        1_500_000_000,
    ]
    assert abs(time.time() - KICKOFF) > 60  # here it is real
    real = time.monotonic()
    robot.sleep(30)
    assert run.clock.now_us == 31_500_000
    robot.sleep(0)
    assert run.clock.now_us == 31_500_001
    robot.wait(0.5)
    assert run.clock.now_us == 32_000_001
    assert robot.lock() == (True, False)
    assert run.clock.now_us == 32_250_001
    assert time.monotonic() - real < 20
    with pytest.raises(ValueError, match="sleep length must be non-negative"):
        robot.sleep(-1)
    assert repr(time.sleep) == "<built-in function sleep>"


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
