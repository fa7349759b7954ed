"""Robots of magicbot and commands2 of 2027."""

from __future__ import annotations

from conftest import MakeProject

MAGIC_ROBOT = """
    import magicbot
    import wpilib
    import wpilib_drivers


    class Arm:
        motor: wpilib_drivers.PWMSparkMax
        power = magicbot.will_reset_to(0.0)

        def up(self):
            self.power = 0.5

        def execute(self):
            self.motor.set_throttle(self.power)


    class MyRobot(magicbot.MagicRobot):
        arm: Arm

        def create_objects(self):
            self.motor = wpilib_drivers.PWMSparkMax(0)
            self.stick = wpilib.Joystick(0)

        def teleop_periodic(self):
            if self.stick.get_raw_button(1):
                self.arm.up()
"""

MAGIC_TEST = """
    def test_m(control, hal_data, robot):
        with control.run_robot():
            control.step_timing(seconds=0.5, autonomous=False, enabled=True)
            hal_data["joysticks"][0]["buttons"][1] = True
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert hal_data["pwm"][0]["value"] == 0.5
"""

COMMAND_ROBOT = """
    import commands2
    import wpilib
    import wpilib_drivers


    class Arm(commands2.Subsystem):
        def __init__(self):
            super().__init__()
            self.motor = wpilib_drivers.PWMSparkMax(0)
            self.periodics = 0

        def periodic(self):
            self.periodics += 1

        def up(self):
            return self.run_end(lambda: self.motor.set_throttle(0.5), lambda: self.motor.set_throttle(0))


    class MyRobot(commands2.TimedCommandRobot):
        def __init__(self):
            super().__init__()
            self.arm = Arm()
            self.pad = commands2.button.CommandGenericHID(0)
            self.pad.button(2).while_true(self.arm.up().with_timeout(0.3))
"""

COMMAND_TEST = """
    def test_c(control, hal_data, robot):
        with control.run_robot():
            control.step_timing(seconds=0.5, autonomous=False, enabled=True)
            assert robot.arm.periodics == 24  # 5 ms after the loop
            hal_data["joysticks"][0]["buttons"][2] = True
            control.step_timing(seconds=0.2, autonomous=False, enabled=True)
            assert hal_data["pwm"][0]["value"] == 0.5
            control.step_timing(seconds=0.2, autonomous=False, enabled=True)
            assert hal_data["pwm"][0]["value"] == 0
"""


def test_a_magic_robots_components_run(make_project: MakeProject) -> None:
    project = make_project({"robot.py": MAGIC_ROBOT, "tests/test_robot.py": MAGIC_TEST})
    result = project.run("test")
    assert result.code == 0, result.output


def test_commands_and_triggers_run(make_project: MakeProject) -> None:
    project = make_project({"robot.py": COMMAND_ROBOT, "tests/test_robot.py": COMMAND_TEST})
    result = project.run("test")
    assert result.code == 0, result.output
