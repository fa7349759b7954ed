"""Mistakes in opmodes that WPILib hides: the user's line comes first."""

from __future__ import annotations

import pytest
from conftest import MakeProject

ROBOT = """
    import wpilib


    class MyRobot(wpilib.OpModeRobot):
        pass


    @wpilib.teleop
    class Drive(wpilib.PeriodicOpMode):
        def __init__(self, robot):
            {constructor}
"""


@pytest.mark.parametrize(
    ("constructor", "line", "message"),
    [
        ("self.robot = robot", 9, "class Drive does not call super().__init__()"),
        ('super().__init__(); self.speed = "fast" + 1', 11, "TypeError: can only concatenate str"),
        ("super().__init__(); self.speed = robot.speed", 11, "AttributeError: 'MyRobot' object has no attribute"),
    ],
)
def test_a_constructor_that_fails(constructor: str, line: int, message: str, make_project: MakeProject) -> None:
    # WPILib calls the constructor again, without the robot, after a TypeError.
    project = make_project({"robot.py": ROBOT.replace("{constructor}", constructor)})
    result = project.run("test", "--builtin", "--", "-k", "opmode")
    assert result.code == 1
    assert f"\nrobot.py:{line}: {message}" in result.stdout, result.output


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("SPEED = 1 / 0", "opmodes/drive.py:4: ZeroDivisionError: division by zero"),
        ("def speed()", "opmodes/drive.py:4: SyntaxError: expected ':'"),
    ],
)
@pytest.mark.parametrize("command", ["test --builtin", "sim --ui none --mode teleop --seconds 1", "fuzz --runs 2"])
def test_a_file_that_cannot_be_imported(command: str, code: str, message: str, make_project: MakeProject) -> None:
    opmode = f"import wpilib\n\n\n{code}\n\n\n@wpilib.teleop\nclass Drive(wpilib.PeriodicOpMode):\n    pass\n"
    robot = "import wpilib\n\n\nclass MyRobot(wpilib.OpModeRobot):\n    pass\n"
    project = make_project({"robot.py": robot, "opmodes/__init__.py": "", "opmodes/drive.py": opmode})
    result = project.run(*command.split())
    assert result.code in (1, 2)
    assert message in result.output, result.output


def test_an_opmode_without_a_decorator(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": """
                import wpilib
                from wpilib import PeriodicOpMode


                class MyRobot(wpilib.OpModeRobot):
                    def __init__(self):
                        super().__init__()
                        self.add_opmode(ByHand, wpilib.RobotState.get_robot_mode(), "by hand")


                class Forgotten(PeriodicOpMode):
                    pass


                class ByHand(wpilib.OpMode):
                    pass


                class Base(wpilib.PeriodicOpMode):
                    pass


                @wpilib.teleop
                class Drive(Base):
                    pass
            """,
            "opmodes/auto.py": "import wpilib\n\n\nclass Auto(wpilib.OpMode):\n    pass\n",
        }
    )
    result = project.run("doctor", "--no-robot")
    never = [line for line in result.output.splitlines() if "WPILib never runs" in line]
    assert [line.partition("program: ")[2].partition(": nothing")[0] for line in never] == [
        "opmodes/auto.py:4: WPILib never runs Auto",
        f"{project.place('robot.py', 'class Forgotten')}: WPILib never runs Forgotten",
    ]


def test_methods_that_wpilib_never_calls(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": """
                import wpilib


                class MyRobot(wpilib.OpModeRobot):
                    def robot_init(self): ...

                    def teleop_periodic(self): ...

                    def autonomous_periodic(self): ...


                @wpilib.teleop
                class Drive(wpilib.PeriodicOpMode):
                    def __init__(self, robot):
                        super().__init__()
                        robot.autonomous_periodic()

                    def strat(self): ...

                    def test_periodic(self): ...

                    def ends(self): ...

                    def shoot(self): ...


                @wpilib.autonomous
                class Auto(wpilib.OpMode):
                    def perodic(self): ...

                    def end(self):
                        self.send()

                    def send(self): ...
            """
        }
    )
    output = project.run("doctor", "--no-robot").output
    for method, message, remedy in (
        ("robot_", "does not call MyRobot.robot_init", "Move its lines to __init__, after super().__init__()."),
        (
            "teleop_",
            "does not call MyRobot.teleop_periodic",
            "Move its lines to periodic of an opmode, a class with",
        ),
        ("strat", "never calls Drive.strat: did you mean start?", "Rename it to start."),
        ("test_", "does not call Drive.test_periodic", "Move its lines to periodic."),
        ("ends", "never calls Drive.ends: did you mean end?", "Rename it to end."),
        ("perodic", "never calls Auto.perodic: did you mean periodic?", "Rename it to periodic."),
    ):
        where = project.place("robot.py", f"def {method}")
        assert f"{where}: WPILib {message}\n          {remedy}" in output, output
    assert output.count(": WPILib ") == 6, output


OPMODES = """
    import wpilib


    class MyRobot(wpilib.OpModeRobot):
        pass


    @wpilib.teleop
    class Drive(wpilib.PeriodicOpMode):
        pass


    @wpilib.autonomous(name="Go")
    class GoForward(wpilib.PeriodicOpMode):
        pass


    @wpilib.utility(name="Go")
    class GoSlowly(wpilib.PeriodicOpMode):
        pass
"""


def test_an_opmode_that_a_test_cannot_choose(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": OPMODES,
            "tests/test_robot.py": """
                import pytest

                import robot as code


                @pytest.mark.parametrize("opmode, mode, message", [
                    ("drive", "", "there is no opmode 'drive': .*'Drive' .teleop.*Did you mean 'Drive'?"),
                    ("Drive", "autonomous", "the opmode 'Drive' is for teleop, not for autonomous"),
                    ("Go", "", "opmodes 'Go' for .*Choose one: mode='.* or mode='"),
                    (code.Drive, "", "an opmode is chosen by its name, not by the class Drive"),
                ])
                def test_wrong(control, robot, opmode, mode, message):
                    with control.run_robot():
                        with pytest.raises(Exception, match="(?s)" + message):
                            control.step_timing(seconds=1, opmode=opmode, mode=mode, enabled=True)


                def test_mode(control, hal_data, robot):
                    with control.run_robot():
                        control.step_timing(seconds=1, opmode="Go", mode="utility", enabled=True)
                        assert (control.get_mode(), hal_data["control"]["opmode"]) == ("test", "Go")
            """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output


def test_a_failed_test_that_has_chosen_no_opmode(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": OPMODES,
            "tests/test_robot.py": """
                def test_none(control, robot):
                    with control.run_robot():
                        control.step_timing(seconds=1, autonomous=True, enabled=True)
                        assert False, "none"


                def test_one(control, robot):
                    with control.run_robot():
                        control.step_timing(seconds=1, opmode="Drive", enabled=True)
                        assert False, "one"
            """,
        }
    )
    output = project.run("test").stdout
    assert output.count("No opmode was selected in this test") == 1, output
    assert output.index("No opmode was selected") < output.index("AssertionError: one")


def test_two_opmodes_of_one_name(make_project: MakeProject) -> None:
    second = '@wpilib.teleop(name="Drive")\nclass Again(wpilib.PeriodicOpMode):\n    pass\n'
    project = make_project({"robot.py": OPMODES, "opmodes/again.py": f"import wpilib\n\n\n{second}"})
    result = project.run("sim", "--ui", "none", "--mode", "utility", "--seconds", "1")
    assert "modes: test 1.0 s" in result.output
    assert result.output.count("only one of") == 1, result.output
    first = project.place("robot.py", "class Drive")
    message = f"{first}: WPILib runs only one of the opmodes 'Drive' for teleop: another one is at opmodes/again.py:5"
    assert message in result.output, result.output
