"""A robot that works at three rates: 20 ms for driving, 10 ms for odometry, 5 ms for control."""

import wpilib


class MyRobot(wpilib.TimedRobot):
    """Holds a distance with a fast controller, and sums up how far it came."""

    CONTROL_PERIOD = 0.005
    ODOMETRY_PERIOD = 0.01

    def robotInit(self) -> None:
        """Create the devices, and start what runs beside the main loop."""
        self.motor = wpilib.PWMSparkMax(0)
        self.encoder = wpilib.Encoder(0, 1)
        self.encoder.setDistancePerPulse(0.001)  # 1000 counts are a metre
        self.target = 0.0

        self.slow_loops = 0
        self.control_loops = 0
        self.odometry_loops = 0
        self.last_distance = 0.0
        self.travelled = 0.0  # metres, forward and backward added up
        self.metre_seconds = 0.0  # the integral of the distance over time

        # Runs in the main loop's thread, between the calls of the periodic functions.
        self.addPeriodic(self.control, self.CONTROL_PERIOD)
        # Runs in a thread of its own: it only touches what nobody else writes.
        self.odometry_notifier = wpilib.Notifier(self.odometry)
        self.odometry_notifier.startPeriodic(self.ODOMETRY_PERIOD)

    def robotPeriodic(self) -> None:
        """Count the ordinary loops."""
        self.slow_loops += 1

    def teleopInit(self) -> None:
        """Go one metre from here."""
        self.target = self.encoder.getDistance() + 1.0

    def teleopPeriodic(self) -> None:
        """Nothing to do: the fast controller drives."""

    def disabledPeriodic(self) -> None:
        """Nothing to do: the fast controller stands still."""

    def autonomousPeriodic(self) -> None:
        """Nothing to do here either."""

    def control(self) -> None:
        """Drive towards the target, slower the nearer it is."""
        self.control_loops += 1
        if self.isTeleopEnabled():
            error = self.target - self.encoder.getDistance()
            self.motor.set(max(-1.0, min(1.0, 2.0 * error)))
        else:
            self.motor.set(0.0)

    def odometry(self) -> None:
        """Add up the way since the last time."""
        distance = self.encoder.getDistance()
        self.travelled += abs(distance - self.last_distance)
        self.last_distance = distance
        self.metre_seconds += distance * self.ODOMETRY_PERIOD
        self.odometry_loops += 1

    def endCompetition(self) -> None:
        """Stop the notifier before the devices go away."""
        if hasattr(self, "odometry_notifier"):
            self.odometry_notifier.stop()
        super().endCompetition()
