"""Drive a square, to see whether the odometry is right."""

from magicbot import state
from wpimath.geometry import Rotation2d, Transform2d

from autonomous.base import Routine


class Square(Routine):
    """For the practice field."""

    MODE_NAME = "Square"

    def on_enable(self) -> None:
        """Lay out the corners, from where the robot is."""
        super().on_enable()
        here = self.swerve.pose()
        sides = ((-1.5, 0, 90), (-1.5, -1.5, 180), (0, -1.5, 270), (0, 0, 0))
        self.corners = [here + Transform2d(x, y, Rotation2d.fromDegrees(angle)) for x, y, angle in sides]

    @state(first=True)
    def drive(self) -> None:
        """Drive to the next corner."""
        if not self.corners:
            self.done()
        elif self.swerve.drive_to(self.corners[0], max_speed=2.0):
            self.corners.pop(0)
