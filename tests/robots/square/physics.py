"""The square robot's physics as documented in 2019: feet, clockwise, hal_data."""

from pyfrc.physics import drivetrains

TICKS_PER_FT = 360


class PhysicsEngine:
    """A tank drive with encoders; the analog gyro turns with the robot by itself."""

    def __init__(self, physics_controller):
        """The wheels are 2 ft apart, and go at 6 ft/s."""
        self.physics_controller = physics_controller
        self.drivetrain = drivetrains.TwoMotorDrivetrain(
            x_wheelbase=2, speed=6, deadzone=drivetrains.linear_deadzone(0.02)
        )
        self.left = self.right = 0.0

    def update_sim(self, hal_data, now, tm_diff):
        """Motors to movement, movement to encoders."""
        # To this drivetrain a left motor is forward at -1; this robot's is at 1.
        l_motor = -hal_data["pwm"][0]["value"]
        r_motor = -hal_data["pwm"][1]["value"]
        speed, rotation = self.drivetrain.get_vector(l_motor, r_motor)
        self.physics_controller.drive(speed, rotation, tm_diff)

        left, right = self.drivetrain.l_speed * tm_diff, self.drivetrain.r_speed * tm_diff
        hal_data["encoder"][0]["count"] += round((self.left + left) * TICKS_PER_FT) - round(self.left * TICKS_PER_FT)
        hal_data["encoder"][1]["count"] += round((self.right + right) * TICKS_PER_FT) - round(self.right * TICKS_PER_FT)
        self.left += left
        self.right += right
