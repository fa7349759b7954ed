"""Where the robot drives to, in the style documented in 2019: feet, and `hal_data`."""

from pyfrc.physics import drivetrains


class PhysicsEngine:
    """A tank drive; nothing measures it."""

    def __init__(self, physics_controller):
        """The wheels are 2 ft apart, and go at 9 ft/s."""
        self.physics_controller = physics_controller
        self.drivetrain = drivetrains.TwoMotorDrivetrain(
            x_wheelbase=2, speed=9, deadzone=drivetrains.linear_deadzone(0.1)
        )

    def update_sim(self, hal_data, now, tm_diff):
        """Motors to movement."""
        # To this drivetrain a left motor is forward at -1; this robot's is at 1.
        l_motor = -hal_data["pwm"][0]["value"]
        r_motor = -hal_data["pwm"][1]["value"]
        speed, rotation = self.drivetrain.get_vector(l_motor, r_motor)
        self.physics_controller.drive(speed, rotation, tm_diff)
