"""A daemon thread filters a sensor; the main loop takes the latest value and distrusts an old one."""

import threading
import time

import wpilib


class RangeReader:
    """Reads an ultrasonic sensor 50 times a second."""

    def __init__(self, sensor: wpilib.AnalogInput) -> None:
        self._sensor = sensor
        self._lock = threading.Lock()
        self._latest: tuple[float, float] | None = None
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="range", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        recent: list[float] = []
        while not self._stop.is_set():
            recent = [*recent[-4:], self._sensor.getVoltage()]
            value = sorted(recent)[len(recent) // 2]
            with self._lock:
                self._latest = (time.monotonic(), value)
            time.sleep(0.02)

    def metres(self) -> float | None:
        """Return the distance; None if there is none, or it is old."""
        with self._lock:
            latest = self._latest
        if latest is None or time.monotonic() - latest[0] > 0.3 or latest[1] < 0.05:
            return None
        return latest[1] * 1.024

    def stop(self) -> None:
        self._stop.set()


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        self.motor = wpilib.PWMSparkMax(0)
        self.reader = RangeReader(wpilib.AnalogInput(0))
        self.stick = wpilib.Joystick(0)

    def limited(self, power: float) -> float:
        """Return the power, less near a wall."""
        metres = self.reader.metres()
        if power > 0 and metres is not None and metres < 1.0:
            return min(power, 0.3 * metres)
        return power

    def autonomousPeriodic(self) -> None:
        self.motor.set(self.limited(0.4))

    def autonomousExit(self) -> None:
        self.motor.set(0.0)

    def teleopPeriodic(self) -> None:
        self.motor.set(self.limited(-self.stick.getY()))

    def teleopExit(self) -> None:
        self.motor.set(0.0)

    def disabledInit(self) -> None:
        self.motor.set(0.0)

    def endCompetition(self) -> None:
        if hasattr(self, "reader"):
            self.reader.stop()
        super().endCompetition()
