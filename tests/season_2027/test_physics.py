"""Physics of a 2027 robot: outputs of PWM motors, which are off while it is disabled, encoders, and the IMU."""

from __future__ import annotations

from conftest import MakeProject
from test_docs import files
from test_physics_numbers import test_a_template_drives_the_same_way, test_numbers

__all__ = ["test_a_template_drives_the_same_way", "test_numbers"]

ROBOT = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.left_motor, self.right_motor = wpilib_drivers.PWMSparkMax(0), wpilib_drivers.PWMSparkMax(1)
            self.right_motor.set_inverted(True)
            self.drive = wpilib.DifferentialDrive(self.left_motor, self.right_motor)
            self.left_encoder = wpilib.Encoder(0, 1)
            self.left_encoder.set_distance_per_pulse(0.001)
            self.imu = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)

        def autonomous_periodic(self):
            self.drive.arcade_drive(0.5, 0.2)

        def disabled_periodic(self):
            self.drive.arcade_drive(1, 0)
"""


def test_what_create_physics_writes_moves_the_robot(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_robot.py": """
                from pytest import approx


                def test_moves(control, hal_data, robot, physics_controller):
                    with control.run_robot():
                        control.step_timing(seconds=1, autonomous=False, enabled=False)
                        before = physics_controller.get_pose()
                        assert hal_data["pwm"][0]["value"] != 0  # what the code has set
                        control.step_timing(seconds=1, autonomous=False, enabled=False)
                        assert physics_controller.get_pose() == before
                        control.step_timing(seconds=2, autonomous=True, enabled=True)
                        turned = physics_controller.get_pose().rotation().radians()
                        assert turned > 0.2
                        assert robot.imu.get_yaw() == hal_data["onboard_imu"]["yaw"] == approx(turned)
                        assert robot.imu.get_gyro_rate_z() > 0.1
                        assert robot.left_encoder.get_distance() > 0.5
                        assert "onboard_imu.yaw" in dict(hal_data.leaves())
                        assert not any("PWMMotorController" in path for path, _ in hal_data.leaves())
            """,
        }
    )
    assert project.run("create-physics").code == 0
    result = project.run("test")
    assert result.code == 0, result.output


#: The robot and the test of the physics that the page shows.
DRIVES_IN_A_CURVE = {
    "robot.py": """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.left_motor = wpilib_drivers.PWMSparkMax(0)
            self.right_motor = wpilib_drivers.PWMSparkMax(1)
            self.right_motor.set_inverted(True)
            self.drive = wpilib.DifferentialDrive(self.left_motor, self.right_motor)
            self.imu = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)

        def autonomous_periodic(self):
            self.drive.arcade_drive(0.5, 0.2)
""",
    "tests/test_turning.py": """
    from pytest import approx


    def test_drives_in_a_curve(control, hal_data, robot, physics_controller):
        start = physics_controller.get_pose()
        with control.run_robot():
            control.step_timing(seconds=1, autonomous=True, enabled=True)
            moved = physics_controller.get_pose().relative_to(start)
            assert moved.x > 0.7
            assert robot.imu.get_yaw() == approx(moved.rotation().radians())
            assert 0 < hal_data["pwm"][0]["value"] < 0.5
""",
}


def test_the_example_in_the_physics_guide_passes(make_project: MakeProject) -> None:
    place = "wpilib_2027/"
    examples = files("docs/reference/wpilib_2027.md").items()
    shown = {file.removeprefix(place): text for file, text in examples if file.startswith(place)}
    project = make_project(shown | DRIVES_IN_A_CURVE)
    result = project.run("test")
    assert result.code == 0, result.output
    assert "tests/test_turning.py ." in result.stdout
