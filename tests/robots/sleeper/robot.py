"""A robot that sleeps in autonomous: not how it should be done, but often done."""

import time

import wpilib


class MyRobot(wpilib.TimedRobot):
    """Drives, sleeps, turns, sleeps, and measures with every clock Python has."""

    def robotInit(self) -> None:
        """Create the devices; no clock has measured anything yet."""
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        self.measured: dict = {}
        self.autonomous_loops = 0
        self.teleop_loops = 0
        self.teleop_started = 0.0

    def now(self) -> dict:
        """Ask every clock there is; each counts in seconds, from a start of its own."""
        return {
            "monotonic": time.monotonic(),
            "time": time.time(),
            "perf_counter": time.perf_counter(),
            "monotonic_ns": time.monotonic_ns() / 1e9,
            "fpga": wpilib.Timer.getFPGATimestamp(),
        }

    def autonomousInit(self) -> None:
        """Forward for half a second, turn for half a second, and the whole loop waits."""
        before = self.now()
        self.left_motor.set(0.5)
        self.right_motor.set(0.5)
        time.sleep(0.5)
        self.right_motor.set(-0.5)
        time.sleep(0.5)
        self.left_motor.set(0.0)
        self.right_motor.set(0.0)
        after = self.now()
        self.measured = {clock: after[clock] - before[clock] for clock in before}

    def autonomousPeriodic(self) -> None:
        """Count the loops that are left of autonomous."""
        self.autonomous_loops += 1

    def teleopInit(self) -> None:
        """Remember the time, as it is done without a Timer."""
        self.teleop_started = time.monotonic()

    def teleopPeriodic(self) -> None:
        """Drive for two seconds by Python's own clock; no sleeping here."""
        self.teleop_loops += 1
        # Compared half way between two loops, so that rounding does not matter.
        if time.monotonic() - self.teleop_started < 1.99:
            self.left_motor.set(1.0)
        else:
            self.left_motor.set(0.0)
