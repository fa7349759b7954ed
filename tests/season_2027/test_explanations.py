"""What WPILib 2027 and its libraries complain of is explained, with the robot's line first."""

from __future__ import annotations

from conftest import MakeProject

ROBOT = """
    import commands2
    import wpilib
    import wpilib_drivers

    KEPT = []


    class MyRobot(wpilib.TimedRobot):
        pass


    class Arm(commands2.Subsystem):
        pass


    def taken():
        KEPT.append(wpilib_drivers.PWMSparkMax(3))
        KEPT.append(wpilib_drivers.PWMSparkMax(3))


    def again():
        for _ in range(2):
            KEPT.append(wpilib.DigitalInput(9))


    def too_high():
        wpilib_drivers.PWMSparkMax(33)


    def too_many():
        KEPT.extend(wpilib.Encoder(2 * each, 2 * each + 1) for each in range(9))


    def both():
        arm = Arm()
        commands2.cmd.parallel(commands2.InstantCommand(print, arm), commands2.InstantCommand(print, arm))


    def no_requirement():
        Arm().set_default_command(commands2.InstantCommand(print))
"""
EXPECTED = """
PWM channel 3 is used already, since robot.py:17
  Each device needs a channel of its own: change one of the two to the number that it is wired to.
DIO channel 9 is used already, since robot.py:23
  This line runs more than once, and makes the device each time. Make it once, in the __init__ of the robot
there is no channel 33 for PWM: they are 0 to 19
  Change it to the number of the channel that it is wired to.
the SystemCore has no more devices of this kind
  It has 8 encoders: create each once, and not in a method that is called again.
two commands that run at the same time both need Arm
  A subsystem does one command at a time. Run them one after the other, with one.and_then(other)
the default command of Arm does not require it
self.add_requirements(subsystem) in the command's __init__.
"""


def test_explanations(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_it.py": """
                import pytest
                import robot as code

                NAMES = ["taken", "again", "too_high", "too_many", "both", "no_requirement"]


                @pytest.mark.parametrize("name", NAMES)
                def test_it(robot, name):
                    getattr(code, name)()
            """,
        }
    )
    result = project.run("test")
    assert result.stdout.count("\nrobot.py:") >= 6, result.output
    for line in EXPECTED.strip().splitlines():
        assert line in result.stdout, result.output


def test_reports_of_wpilib_come_with_the_robots_lines(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": """
                import wpilib


                class MyRobot(wpilib.TimedRobot):
                    def teleop_periodic(self):
                        wpilib.DriverStationBackend.get_stick_axis(0, 13)
            """
        }
    )
    result = project.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "0.5")
    assert "axis 13 out of range" in result.output
    assert 'robot.py", line 6, in teleop_periodic' in result.output
    assert "pyfrc_core" not in result.output


def test_a_device_of_two_opmodes_belongs_to_the_robot(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": """
                import wpilib
                import wpilib_drivers

                KEPT = []


                class MyRobot(wpilib.OpModeRobot):
                    pass


                @wpilib.teleop
                class Drive(wpilib.PeriodicOpMode):
                    def __init__(self, robot):
                        super().__init__()
                        KEPT.append(wpilib_drivers.PWMSparkMax(3))


                @wpilib.autonomous
                class Go(wpilib.PeriodicOpMode):
                    def __init__(self, robot):
                        super().__init__()
                        KEPT.append(wpilib_drivers.PWMSparkMax(3))  # the same one
            """,
            "tests/test_it.py": "from pyfrc.tests import test_practice\n",
        }
    )
    result = project.run("test")
    assert result.code == 1, result.output
    assert (
        "robot.py:22: PWM channel 3 is used already, since robot.py:15\n"
        "  Two opmodes make it. If it is one device, make it once, in the __init__ of the robot, and use it in both; "
        "else change one of the two to the number that it is wired to.\n"
    ) in result.stdout
