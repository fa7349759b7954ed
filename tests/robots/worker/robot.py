"""A robot with two Python threads beside its main loop: a sampler and a heartbeat."""

import queue
import threading
import time

import wpilib


class MyRobot(wpilib.TimedRobot):
    """The threads hand over what they have through a queue, or under a lock."""

    def robotInit(self) -> None:
        """Create the devices, and start the threads."""
        self.sensor = wpilib.AnalogInput(0)
        self.stopping = threading.Event()
        self.lock = threading.Lock()
        self.samples: queue.Queue = queue.Queue()

        self.received: list = []  # only the main loop touches it
        self.beats = 0  # shared: only under the lock
        self.main_loops = 0  # shared: only under the lock
        self.loops_at_beat: list = []  # written by the heartbeat under the lock

        # Daemon threads do not keep the program alive when it wants to end.
        self.sampler = threading.Thread(target=self.sample, name="sampler", daemon=True)
        self.heartbeat = threading.Thread(target=self.beat, name="heartbeat", daemon=True)
        self.sampler.start()
        self.heartbeat.start()

    def sample(self) -> None:
        """Read the sensor ten times a second, and send each value to the main loop."""
        while not self.stopping.is_set():
            time.sleep(0.1)
            self.samples.put((wpilib.Timer.getFPGATimestamp(), self.sensor.getVoltage()))

    def beat(self) -> None:
        """Note twenty times a second how many main loops there were."""
        while not self.stopping.is_set():
            # Nobody ever sets this event: it is a pause, as people write it.
            threading.Event().wait(0.05)
            with self.lock:
                self.beats += 1
                self.loops_at_beat.append(self.main_loops)

    def robotPeriodic(self) -> None:
        """Take what is in the queue; never wait for it here."""
        with self.lock:
            self.main_loops += 1
        while True:
            try:
                self.received.append(self.samples.get_nowait())
            except queue.Empty:
                return

    def disabledPeriodic(self) -> None:
        """Nothing to do: all work is in robotPeriodic."""

    def autonomousPeriodic(self) -> None:
        """Nothing to do: all work is in robotPeriodic."""

    def teleopPeriodic(self) -> None:
        """Nothing to do: all work is in robotPeriodic."""

    def endCompetition(self) -> None:
        """Tell the threads to come to their end."""
        if hasattr(self, "stopping"):
            self.stopping.set()
        super().endCompetition()
