"""The 2019 documentation's examples of physics run in a robot project as they are written, but for its misprints.

The misprints: a `PhysicsEngine` that uses `l_motor` without getting it (its TODO says so), `motors` for `motor_cfgs`,
`MOTOR_CFG_CIM_IMP` for `MOTOR_CFG_CIM`, `feet` for `units.feet`, `get_vector` of a tank model for `get_distance`, and
`pyfrc.physics.motion` where `motion` was imported.
"""

from __future__ import annotations

import re

import pytest

ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.left = wpilib.PWMSparkMax(0)
            self.right = wpilib.PWMSparkMax(1)
            self.left_encoder = wpilib.Encoder(0, 1)
            self.right_encoder = wpilib.Encoder(2, 3)

        def teleopPeriodic(self):
            self.left.set(-0.5)
            self.right.set(0.5)
    """

CONFIG = """
    {
      "pyfrc": {
        "robot": {
          "w": 2,
          "h": 3,
          "starting_x": 2,
          "starting_y": 20,
          "starting_angle": 0
        }
      }
    }
    """

MOTORS = 'l_motor, r_motor = (hal_data["pwm"][channel]["value"] for channel in (0, 1))'

EXAMPLES = {
    "drivetrains": f"""
        from pyfrc.physics import drivetrains

        class PhysicsEngine:

            def __init__(self, physics_controller):
                self.physics_controller = physics_controller
                self.drivetrain = drivetrains.TwoMotorDrivetrain(deadzone=drivetrains.linear_deadzone(0.2))

            def update_sim(self, hal_data, now, tm_diff):
                {MOTORS}
                speed, rotation = self.drivetrain.get_vector(l_motor, r_motor)
                self.physics_controller.drive(speed, rotation, tm_diff)

                # optional: compute encoder
                l_encoder = self.drivetrain.l_speed * tm_diff
                assert l_encoder >= 0
        """,
    "tankmodel": f"""
        from pyfrc.physics import motor_cfgs, tankmodel
        from pyfrc.physics.units import units

        ENCODER_TICKS_PER_FT = 360

        class PhysicsEngine:

            def __init__(self, physics_controller):
                self.physics_controller = physics_controller

                self.drivetrain = tankmodel.TankModel.theory(motor_cfgs.MOTOR_CFG_CIM,
                                                             robot_mass=90 * units.lbs,
                                                             gearing=10.71, nmotors=2,
                                                             x_wheelbase=2.0*units.feet,
                                                             wheel_diameter=6*units.inch)

            def update_sim(self, hal_data, now, tm_diff):
                {MOTORS}
                x, y, angle = self.drivetrain.get_distance(l_motor, r_motor, tm_diff)
                self.physics_controller.distance_drive(x, y, angle)

                # optional: compute encoder
                l_encoder = self.drivetrain.l_position * ENCODER_TICKS_PER_FT
                r_encoder = self.drivetrain.r_position * ENCODER_TICKS_PER_FT
                hal_data["encoder"][0]["count"] = int(l_encoder)
                hal_data["encoder"][1]["count"] = int(r_encoder)
        """,
    "camera": f"""
        import ntcore
        from pyfrc.physics import drivetrains
        from pyfrc.physics.visionsim import VisionSim

        class PhysicsEngine:

            def __init__(self, physics_controller):
                self.physics_controller = physics_controller
                self.drivetrain = drivetrains.TwoMotorDrivetrain()
                self.nt = ntcore.NetworkTableInstance.getDefault().getTable("")
                self.camera_enabled = True
                targets = [
                    VisionSim.Target(15, 20, 90, 270)
                ]
                self.vision_sim = VisionSim(targets, 61.0, 1.5, 15, 15, physics_controller=physics_controller)

            def update_sim(self, hal_data, now, tm_diff):
                {MOTORS}
                speed, rotation = self.drivetrain.get_vector(l_motor, r_motor)
                self.physics_controller.drive(speed, rotation, tm_diff)

                x, y, angle = self.physics_controller.get_position()

                if self.camera_enabled:
                    data = self.vision_sim.compute(now, x, y, angle)
                    if data is not None:
                        self.nt.putNumberArray('/camera/target', data[0])
                else:
                    self.vision_sim.dont_compute()
        """,
    "labels": f"""
        from pyfrc.physics import drivetrains

        class PhysicsEngine:

            def __init__(self, physics_controller):
                self.physics_controller = physics_controller

            def initialize(self, hal_data):
                # first time you set the data
                hal_data.setdefault('custom', {{}})['My Label'] = '---'

            def update_sim(self, hal_data, now, tm_diff):
                # All other times
                hal_data['custom']['My Label'] = 1
                {MOTORS}
                speed, rotation = drivetrains.TwoMotorDrivetrain().get_vector(l_motor, r_motor)
                self.physics_controller.drive(speed, rotation, tm_diff)
        """,
}

LOOKS = {
    "drivetrains": "assert abs(x - 2 - 0.375 * 5 * 0.98) < 0.05",
    "tankmodel": "assert robot.left_encoder.get() == robot.right_encoder.get() == int((x - 2) * 360)",
    "camera": "assert 10.5 < table.getNumberArray('/camera/target', [])[3] < 11",
    "labels": "assert hal_data['custom'] == {'My Label': 1}",
}


@pytest.mark.parametrize("example", EXAMPLES)
def test_a_documented_example_runs(example: str, make_project) -> None:
    test = f"""
        from ntcore import NetworkTableInstance

        def test_it(control, robot, hal_data, physics_controller):
            control.set_operator_control()
            control.run_test(lambda tm: tm < 1)
            table = NetworkTableInstance.getDefault().getTable("")
            x, y, angle = physics_controller.get_position()
            assert x > 2.5
            assert (y, angle) == (20, 0)
            {LOOKS[example]}
        """
    project = make_project(
        {
            "robot.py": ROBOT,
            "physics.py": EXAMPLES[example],
            "sim/config.json": CONFIG,
            "tests/test_it.py": test,
        }
    )
    result = project.run("test", "--", "-W", "error::DeprecationWarning:physics")
    assert result.code == 0, result.output


def test_the_successor_of_networktables_is_named(make_project) -> None:
    physics = """
        class PhysicsEngine:
            def __init__(self, physics_controller):
                pass

            def update_sim(self, hal_data, now, tm_diff):
                import networktables
        """
    project = make_project({"robot.py": ROBOT, "physics.py": physics})
    result = project.run("test", "--builtin")
    assert result.code == 1
    assert re.search(
        r"physics\.py:\d: there is no module networktables\n  Instead: import ntcore, and ntcore\.", result.output
    )
