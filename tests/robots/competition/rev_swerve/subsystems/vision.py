"""The camera measures where the robot is, by the tags on the field."""

import commands2
import ntcore
import wpilib
from wpimath.geometry import Pose2d, Rotation2d

from constants import Vision as Settings
from subsystems.drivetrain import Drivetrain


class Vision(commands2.Subsystem):
    """Reads the camera's measurements from NetworkTables: x, y, degrees, latency in ms, number of tags."""

    def __init__(self, drivetrain: Drivetrain) -> None:
        super().__init__()
        self.drivetrain = drivetrain
        table = ntcore.NetworkTableInstance.getDefault().getTable(Settings.TABLE)
        self.measurements = table.getDoubleArrayTopic("botpose").subscribe([])
        self.heading = table.getDoubleTopic("robot_orientation").publish()
        self.last_seen = -Settings.STALE_SECONDS
        self.used = 0
        self.ignored = 0
        self.alert = wpilib.Alert("The camera sees no tags", wpilib.Alert.AlertType.kInfo)

    def sees_tags(self) -> bool:
        """Return whether there was a measurement lately."""
        return wpilib.Timer.getFPGATimestamp() - self.last_seen < Settings.STALE_SECONDS

    def plausible(self, pose: Pose2d) -> bool:
        """Return whether the robot can be there: anywhere while it is disabled, else near where it was."""
        if wpilib.DriverStation.isDisabled():
            return True
        return pose.translation().distance(self.drivetrain.pose().translation()) < Settings.MAX_JUMP

    def periodic(self) -> None:
        """Pass new measurements on."""
        self.heading.set(self.drivetrain.pose().rotation().degrees())
        for measurement in self.measurements.readQueue():
            values = measurement.value
            if len(values) != 5 or values[4] < 1:
                continue
            x, y, degrees, latency, _ = values
            self.last_seen = wpilib.Timer.getFPGATimestamp()
            pose = Pose2d(x, y, Rotation2d.fromDegrees(degrees))
            if self.plausible(pose):
                self.drivetrain.add_vision(pose, self.last_seen - latency / 1000)
                self.used += 1
            else:
                self.ignored += 1
        self.alert.set(not self.sees_tags())
        wpilib.SmartDashboard.putNumber("Vision/Used", self.used)
        wpilib.SmartDashboard.putNumber("Vision/Ignored", self.ignored)
