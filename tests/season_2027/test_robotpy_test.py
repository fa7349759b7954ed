"""Beside `robotpy test` of WPILib 2027: it works as without pyfrc, and its tests run unchanged in `pyfrc test`.

A black box: both tools run the same project here, in an environment in which pyfrc is installed.
"""

from __future__ import annotations

import re
from importlib.metadata import entry_points

import pytest
from conftest import MakeProject, Result, RobotProject

ROBOT = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.OpModeRobot):
        def __init__(self):
            super().__init__()
            self.motor, self.stick = wpilib_drivers.PWMSparkMax(1), wpilib.Joystick(0)
            self.started = []


    @wpilib.autonomous
    class Forward(wpilib.PeriodicOpMode):
        def __init__(self, robot: MyRobot):
            super().__init__()
            self.robot = robot

        def start(self):
            self.robot.started.append("Forward")

        def periodic(self):
            self.robot.motor.set_throttle(0.25)

        def end(self):
            self.robot.motor.set_throttle(0)


    @wpilib.teleop
    class Drive(wpilib.PeriodicOpMode):
        def __init__(self, robot: MyRobot):
            super().__init__()
            self.robot = robot

        def start(self):
            self.robot.started.append("Drive")

        def periodic(self):
            self.robot.motor.set_throttle(-self.robot.stick.get_y())


    @wpilib.utility(name="Check motors")
    class Check(wpilib.OpMode):
        def __init__(self, robot: MyRobot):
            super().__init__()
            self.robot = robot

        def start(self):
            self.robot.started.append("Check motors")

        def periodic(self):
            pass
"""

#: As `robotpy add-tests` writes it.
READY_MADE = "from wpilib.testing.robot_tests import *\n"

OWN = """
    import hal
    import pytest
    import wpilib
    from wpilib.simulation import DriverStationSim, JoystickSim
    from wpilib.testing import OpMode
    from wpilib.testing.controller import RobotTestController


    def test_each(control: RobotTestController, robot, opmode: OpMode):
        assert isinstance(opmode.mode, hal.RobotMode)
        with control.run_robot():
            control.step_timing(seconds=0.5, opmode=opmode, enabled=False)
            assert robot.started == []
            control.step_timing(seconds=1.0, opmode=opmode, enabled=True)
            assert robot.started == [opmode.name]
            assert wpilib.RobotState.get_opmode() == opmode.name
            assert control.robot_is_alive


    def test_one(control, robot):
        stick = JoystickSim(0)
        with control.run_robot():
            control.step_timing(seconds=0.2, opmode=OpMode(hal.RobotMode.TELEOPERATED, "Drive"), enabled=False)
            stick.set_y(-0.5)
            stick.notify_new_data()
            drive = OpMode(hal.RobotMode.TELEOPERATED, "Drive")
            assert control.step_timing(seconds=0.5, opmode=drive, enabled=True) >= 0.5
            assert robot.motor.get_throttle() == pytest.approx(0.5, abs=0.01)
            control.step_timing(seconds=1.0, opmode=OpMode(hal.RobotMode.AUTONOMOUS, "Forward"), enabled=True)
            assert robot.started == ["Drive", "Forward"]
            assert robot.motor.get_throttle() == pytest.approx(0.25, abs=0.01)


    def test_modes_without_opmodes(control, robot):
        with control.run_robot():
            control.step_timing(seconds=0.5, autonomous=True, enabled=True)
            assert wpilib.RobotState.is_autonomous()
            control.step_timing(seconds=0.5, autonomous=False, enabled=True)
            assert wpilib.RobotState.is_teleop()
            assert wpilib.RobotState.is_enabled()


    def test_either_or(control, robot, robot_file, robot_path):
        assert str(robot_file).startswith(str(robot_path))
        with control.run_robot():
            with pytest.raises(Exception):
                control.step_timing(seconds=0.5, enabled=True)


    def test_the_clock(control, robot):
        with control.run_robot():
            before = wpilib.Timer.get_timestamp()
            control.step_timing(seconds=2.0, autonomous=True, enabled=False)
            assert wpilib.Timer.get_timestamp() - before == pytest.approx(2.0, abs=0.3)  # theirs: 2.2


    def test_fails(control, robot):
        with control.run_robot():
            control.step_timing(seconds=0.2, autonomous=True, enabled=True)
            assert robot.started == ["nothing"]


    def test_of_no_robot():
        assert 1 + 1 == 2
"""

BUG = ROBOT.replace("self.robot.motor.set_throttle(0.25)", "1 / 0")


@pytest.fixture
def project(make_project: MakeProject) -> RobotProject:
    return make_project({"robot.py": ROBOT, "tests/robot_test.py": READY_MADE, "tests/test_own.py": OWN})


def test_tests_for_robotpy_run_unchanged(project: RobotProject) -> None:
    ours = project.run("test", "--", "-v")
    theirs = project.run("test", "--", "-v", program="robotpy")
    assert (ours.code, theirs.code) == (1, 1), ours.output + theirs.output
    assert outcomes(ours) == outcomes(theirs)
    assert set(outcomes(ours).values()) == {"PASSED", "FAILED"}
    assert [name for name, what in outcomes(ours).items() if what == "FAILED"] == ["tests/test_own.py::test_fails"]
    opmodes = ("Forward", "Drive", "Check motors")
    assert {name for name in outcomes(ours) if "[" in name} == {
        f"tests/{test}[{opmode}]"
        for test in ("robot_test.py::test_opmode", "test_own.py::test_each")
        for opmode in opmodes
    }


@pytest.mark.slow
def test_plain_pytest_runs_them_too(project: RobotProject) -> None:
    result = project.run("-v", program="pytest", cold=True)
    assert result.code == 1, result.output
    assert [name for name, what in outcomes(result).items() if what != "PASSED"] == ["tests/test_own.py::test_fails"]


@pytest.mark.slow
def test_a_line_of_the_robot_that_fails_is_named_by_both(make_project: MakeProject) -> None:
    project = make_project({"robot.py": BUG, "tests/robot_test.py": READY_MADE})
    ours = project.run("test", "--", "-v")
    theirs = project.run("test", "--", "-v", program="robotpy")
    assert outcomes(ours) == outcomes(theirs)
    assert outcomes(ours)["tests/robot_test.py::test_opmode[Forward]"] == "FAILED"
    assert project.place("robot.py", "1 / 0") in ours.stdout


@pytest.mark.slow
def test_beside_pyfrc_it_is_as_without(make_project: MakeProject) -> None:
    """Also in a project that pyfrc would refuse. ``-p no:pyfrc`` leaves pyfrc out."""
    files = {"robot.py": ROBOT, "tests/test_own.py": OWN}
    project = make_project(files | {"pyproject.toml": '[tool.robotpy]\nrobotpy_version = "2026.2.2"\n'})
    runs = [project.run("test", "--", "-v", *more, program="robotpy") for more in ((), ("-p", "no:pyfrc"))]
    shown = [outcomes(result) for result in runs]
    assert shown[0] == shown[1]
    assert len(shown[0]) == 9
    assert "pyfrc: " not in runs[0].output


@pytest.mark.slow
def test_a_test_with_our_fixtures_says_which_tool_runs_it(make_project: MakeProject) -> None:
    """Unless the project has a fixture of that name."""
    test = "def test_{0}(control, robot, {0}):\n    pass\n"
    names = ("fake_time", "gamedata", "hal_data", "physics_controller")
    project = make_project(
        {
            "robot.py": ROBOT,
            "conftest.py": "import pytest\n\n\n@pytest.fixture\ndef gamedata():\n    return 'mine'\n",
            "tests/test_own.py": "\n\n".join(test.format(name) for name in names),
        }
    )
    result = project.run("test", program="robotpy")
    assert result.code == 1
    assert "1 passed" in result.stdout
    for name in sorted({*names} - {"gamedata"}):
        text = f"{name} is a fixture of pyfrc, which robotpy test does not have. Run: pyfrc test."
        assert text in " ".join(result.stdout.split()), result.stdout
    assert "available fixtures" not in result.stdout


def test_the_names_of_the_commands_are_ours_or_theirs() -> None:
    names: dict[str, list[str]] = {}
    for point in entry_points(group="robotpy_cli.2027"):
        assert point.dist is not None
        names.setdefault(point.name, []).append(point.dist.name)
    assert {name for name, whose in names.items() if whose == ["pyfrc"]} == {"coverage", "create-physics", "profiler"}
    assert {"test", "sim", "add-tests", "init", "deploy"} <= set(names)
    assert all(len(whose) == 1 for whose in names.values())


def test_robotpy_has_our_commands(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/pyfrc_test.py": "from pyfrc.tests import test_opmode\n"})
    helped = project.run("--help", program="robotpy")
    assert "Measure which lines of the robot run in another" in helped.stdout
    measured = project.run("coverage", "test", program="robotpy")
    assert measured.code == 0, measured.output
    assert re.search(r"^robot\.py .* 100%", measured.stdout, re.MULTILINE), measured.output


def outcomes(result: Result) -> dict[str, str]:
    """Each test's outcome. Its opmode has the mode's name in front, in each tool's own way: that is left out."""
    found = re.findall(r"^(\S+::\w+)(?:\[\w+-(.*?)\])? (PASSED|FAILED|ERROR|SKIPPED)\b", result.stdout, re.MULTILINE)
    return {f"{name}[{opmode}]" if opmode else name: outcome for name, opmode, outcome in found}
