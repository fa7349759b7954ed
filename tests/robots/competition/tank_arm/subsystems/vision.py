"""Where the cameras see the robot: two PhotonVision cameras and a Limelight."""

import commands2
import ntcore
import wpilib
from constants import Vision
from photonlibpy import EstimatedRobotPose, PhotonCamera, PhotonPoseEstimator
from robotpy_apriltag import AprilTagField, AprilTagFieldLayout
from wpimath.geometry import Pose2d, Rotation2d, Transform3d

from subsystems.drivetrain import Drivetrain


class Cameras(commands2.Subsystem):
    """Passes what the cameras measure to the drivetrain's estimator."""

    def __init__(self, drivetrain: Drivetrain) -> None:
        super().__init__()
        self.drivetrain = drivetrain
        self.layout = AprilTagFieldLayout.loadField(AprilTagField.k2026RebuiltWelded)
        self.cameras = [
            self._camera(Vision.FRONT, Vision.FRONT_TRANSFORM),
            self._camera(Vision.REAR, Vision.REAR_TRANSFORM),
        ]
        self.limelight = ntcore.NetworkTableInstance.getDefault().getTable(Vision.LIMELIGHT)
        self.valid = self.limelight.getDoubleTopic("tv").subscribe(0.0)
        self.offset_x = self.limelight.getDoubleTopic("tx").subscribe(0.0)
        self.offset_y = self.limelight.getDoubleTopic("ty").subscribe(0.0)
        self.botpose = self.limelight.getDoubleArrayTopic("botpose_wpiblue").subscribe([])
        self.orientation = self.limelight.getDoubleArrayTopic("robot_orientation_set").publish()
        self.no_camera = [
            wpilib.Alert(f"The camera '{name}' is not connected.", wpilib.Alert.AlertType.kError)
            for name in (Vision.FRONT, Vision.REAR)
        ]
        self.accepted = 0
        self.last_pose: Pose2d | None = None

    def _camera(self, name: str, robot_to_camera: Transform3d) -> tuple[PhotonCamera, PhotonPoseEstimator]:
        return PhotonCamera(name), PhotonPoseEstimator(self.layout, robot_to_camera)

    def periodic(self) -> None:
        """Read all cameras."""
        for (camera, estimator), alert in zip(self.cameras, self.no_camera, strict=True):
            alert.set(not camera.isConnected())
            for result in camera.getAllUnreadResults():
                estimate = estimator.estimateCoprocMultiTagPose(result)
                if estimate is None:
                    estimate = estimator.estimateLowestAmbiguityPose(result)
                if estimate is not None and self._plausible(estimate):
                    self._accept(estimate.estimatedPose.toPose2d(), estimate.timestampSeconds, estimate)
        heading = self.drivetrain.pose().rotation().degrees()
        self.orientation.set([heading, 0, 0, 0, 0, 0])
        for change in self.botpose.readQueue():
            self._read_limelight(change.value, change.time / 1e6)
        wpilib.SmartDashboard.putNumber("Vision/accepted", self.accepted)
        wpilib.SmartDashboard.putBoolean("Vision/sees goal", self.sees_goal())

    def _read_limelight(self, values: list[float], received: float) -> None:
        if len(values) < 8 or values[7] < 1 or not self.sees_goal():
            return
        pose = Pose2d(values[0], values[1], Rotation2d.fromDegrees(values[5]))
        self.drivetrain.add_vision(pose, received - values[6] / 1000, (0.5, 0.5, 1e6))

    def _plausible(self, estimate: EstimatedRobotPose) -> bool:
        pose = estimate.estimatedPose
        on_field = 0 < pose.X() < self.layout.getFieldLength() and 0 < pose.Y() < self.layout.getFieldWidth()
        clear = len(estimate.targetsUsed) > 1 or estimate.targetsUsed[0].getPoseAmbiguity() < Vision.MAX_AMBIGUITY
        return on_field and clear and abs(pose.Z()) < 0.5

    def _accept(self, pose: Pose2d, timestamp: float, estimate: EstimatedRobotPose) -> None:
        distances = [target.getBestCameraToTarget().translation().norm() for target in estimate.targetsUsed]
        distance = sum(distances) / len(distances)
        if distance > Vision.MAX_DISTANCE and len(distances) == 1:
            return
        deviation = 0.05 * (1 + distance**2 / 3) / len(distances)
        self.drivetrain.add_vision(pose, timestamp, (deviation, deviation, deviation * 2))
        self.accepted += 1
        self.last_pose = pose

    def sees_goal(self) -> bool:
        """Return whether the Limelight sees its target."""
        return self.valid.get() >= 1

    def goal_offset(self) -> float:
        """Return how far the goal is to the right, in degrees."""
        return self.offset_x.get()
