"""Robots on `OpModeRobotBase`: a period of their own, opmodes added while they run; tests with WPILib's own opmodes."""

from __future__ import annotations

import pytest
from conftest import MakeProject

ROBOT = """
    import time

    import wpilib
    from hal import RobotMode


    class MyRobot(wpilib.OpModeRobotBase):
        def __init__(self):
            super().__init__(0.01)
            self.log, self.turns, self.calls = [], 0, 0
            self.add_opmode_factory(RobotMode.TELEOPERATED, "Drive", lambda: Drive(self))
            self.add_opmode_factory(RobotMode.UTILITY, "Check", factory=lambda: Check(self))
            self.publish_opmodes()

        def robot_periodic(self):
            self.turns += 1

        def add_late(self):
            self.add_opmode_factory(RobotMode.AUTONOMOUS, "Late", lambda: Check(self))
            self.publish_opmodes()


    class Drive(wpilib.PeriodicOpMode):
        def __init__(self, robot):
            super().__init__()
            self.robot = robot
            self.add_periodic(self.on_slow, 0.1)

        def on_slow(self):
            pass

        def periodic(self):
            self.robot.calls += 1


    class Check(wpilib.OpMode):
        def __init__(self, robot):
            super().__init__()
            self.robot = robot

        def start(self):
            self.robot.log.append("start")

        def periodic(self):
            pass
"""


def test_period_and_opmodes_that_are_added_later(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_robot.py": """
                from hal import RobotMode
                from wpilib.testing import OpMode


                def test_period(control, robot):
                    with control.run_robot():
                        control.step_timing(seconds=1, opmode=OpMode(RobotMode.TELEOPERATED, "Drive"), enabled=True)
                        assert (robot.turns, robot.calls) == (100, 98)  # the first packet comes after 20 ms


                def test_added(control, hal_data, robot):
                    with control.run_robot():
                        control.set_opmode("Check", mode="utility")
                        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
                        robot.add_late()
                        control.step_timing(seconds=0.1, opmode="Late", enabled=True)
                        assert (robot.log, hal_data["control"]["opmode"]) == (["start"], "Late")
            """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output
    assert "OpMode" not in result.output  # what WPILib prints of each is left out


def test_a_practice_match_has_the_first_opmode_of_each_mode(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": """
                import wpilib


                class MyRobot(wpilib.OpModeRobot):
                    def __init__(self):
                        super().__init__()
                        self.log = []


                class Logs(wpilib.PeriodicOpMode):
                    def __init__(self, robot):
                        super().__init__()
                        self.robot = robot

                    def start(self):
                        self.robot.log.append((type(self).__name__, wpilib.RobotState.is_autonomous()))

                    def end(self):
                        self.robot.ended = type(self).__name__


                @wpilib.autonomous(group="B")
                class Alpha(Logs):
                    pass


                @wpilib.autonomous(group="A")
                class Beta(Logs):
                    pass


                @wpilib.teleop
                class Drive(Logs):
                    pass


                @wpilib.teleop
                class Other(Logs):
                    pass
            """,
            "tests/test_robot.py": """
                def test_first(control, robot):
                    control.set_practice_match()
                    control.run_test()
                    assert robot.log == [("Beta", True), ("Drive", False)]
                    assert robot.ended == "Drive"  # the match ends disabled


                def test_chosen(control, robot):
                    control.set_opmode("Other")
                    control.set_practice_match()
                    control.run_test()
                    assert robot.log == [("Beta", True), ("Other", False)]
            """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output


def test_a_mark_chooses_the_opmodes_of_a_test(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_robot.py": """
                import pytest
                import wpilib.testing
                from hal import RobotMode


                @pytest.mark.opmode("Drive")
                def test_one(control, robot, opmode):
                    assert opmode == wpilib.testing.OpMode(RobotMode.TELEOPERATED, "Drive")
                    with control.run_robot():
                        control.step_timing(seconds=0.1, opmode=opmode, enabled=True)
                        assert robot.calls


                def test_all(opmode):
                    pass


                @pytest.mark.parametrize("opmode", ["Drive"])
                def test_of_its_own(opmode):
                    assert opmode == "Drive"
            """,
        }
    )
    result = project.run("test", "--", "-v", "--strict-markers")
    assert result.code == 0, result.output
    passed = [line.split("::")[1].split()[0] for line in result.stdout.splitlines() if "PASSED" in line]
    assert passed == [
        "test_one[teleop-Drive]",
        "test_all[teleop-Drive]",
        "test_all[test-Check]",
        "test_of_its_own[Drive]",
    ]


@pytest.mark.parametrize(
    ("mark", "argument", "message"),
    [
        ('("Drve")', "opmode", "test_it is marked with the opmode 'Drve': the robot has published 'Drive', 'Check'"),
        ('("Drive")', "robot", "test_it has the mark opmode, but no argument opmode"),
    ],
)
def test_a_wrong_mark_is_reported_before_the_tests(
    mark: str, argument: str, message: str, make_project: MakeProject
) -> None:
    test = f"import pytest\n\n\n@pytest.mark.opmode{mark}\ndef test_it({argument}):\n    pass\n"
    result = make_project({"robot.py": ROBOT, "tests/test_robot.py": test}).run("test")
    assert result.code != 0
    assert message in result.output
    assert "Traceback" not in result.output


def test_an_opmode_that_waits_is_named_with_its_class(make_project: MakeProject) -> None:
    waiting = "while True:\n                time.sleep(0.1)"
    robot = ROBOT.replace("self.robot.calls += 1", waiting)
    project = make_project({"robot.py": robot, "tests/test_robot.py": "from pyfrc.tests import test_opmode\n"})
    result = project.run("test")
    place = project.place("robot.py", "time.sleep(0.1)")
    assert f"{place}: Drive.periodic has not returned after" in result.output, result.output


def test_a_profile_has_the_functions_of_opmodes_by_their_names(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_robot.py": "from pyfrc.tests import test_opmode\n"})
    result = project.run("profile", "test")
    assert result.code == 0, result.output
    for name in ("Drive.periodic", "Drive.on_slow", "Check.start", "MyRobot.robot_periodic"):
        assert name in result.stdout
    assert "_Callbacks" not in result.stdout
    assert "pybind" not in result.stdout
    assert "The loop has 10 ms for each packet" in result.stdout or "10 ms" in result.stdout


def test_methods_that_are_never_called_are_named(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": """
                import wpilib


                class MyRobot(wpilib.OpModeRobot):
                    def robotInit(self):
                        pass

                    def robotPeriodic(self):
                        pass


                @wpilib.teleop
                class Drive(wpilib.PeriodicOpMode):
                    def perodic(self):
                        pass
            """
        }
    )
    result = project.run("doctor", "--no-robot")
    assert "robot.py:5: WPILib does not call MyRobot.robotInit\n" in result.output
    assert "Move its lines to __init__, after super().__init__()." in result.output
    assert "MyRobot.robotPeriodic: did you mean robot_periodic? (camelCase names are those of" in result.output
    assert "robot.py:14: WPILib never calls Drive.perodic: did you mean periodic?" in result.output


@pytest.mark.parametrize(("called", "named"), [("robot_init", False), ("is_enabled", True)])
def test_a_constructor_may_call_what_wpilib_does_not_call(called: str, named: bool, make_project: MakeProject) -> None:
    """So does a robot that `pyfrc migrate` has written. To be called by another method of its name is not enough."""
    robot = """
        import wpilib


        class MyRobot(wpilib.TimedRobot):
            def __init__(self):
                super().__init__()
                self.CALLED()

            def robot_init(self):
                pass


        class Practice(MyRobot):
            def robot_init(self):
                super().robot_init()
    """
    project = make_project({"robot.py": robot.replace("CALLED", called)})
    output = project.run("doctor", "--no-robot", "--robot-class", "MyRobot").output
    assert ("WPILib does not call MyRobot.robot_init" in output) is named
