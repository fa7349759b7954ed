"""What the simulator's window costs: frames a second and its share of a core with 60 active channels; and whether the
robot's loop is held up by it.

    python benchmarks/sim_window.py [--seconds 60]

Needs Xvfb (Debian's package xvfb). The robot itself notes on the wall clock when each of its loops begins. Another one
without a window runs at the same time.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import dedent

from pyfrc_core.project import Project
from pyfrc_core.sim import Simulation
from pyfrc_core.sim.ui.tk.window import Window

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from virtual_display import virtual_display

#: 20 motors, 10 digital outputs, 2 analog ones, 4 relays, 8 and 16 solenoids; each changes at every packet.
ROBOT = """
    import ctypes
    import json
    import math
    from pathlib import Path

    import wpilib


    class TimeSpec(ctypes.Structure):
        _fields_ = [("seconds", ctypes.c_long), ("nanoseconds", ctypes.c_long)]


    clock_gettime = ctypes.CDLL(None).clock_gettime


    def wall():  # Python's own clocks tell robot time here
        now = TimeSpec()
        clock_gettime(1, ctypes.byref(now))
        return now.seconds + now.nanoseconds / 1e9


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.motors = [wpilib.PWMSparkMax(port) for port in range(20)]
            self.outputs = [wpilib.DigitalOutput(channel) for channel in range(10)]
            self.voltages = [wpilib.AnalogOutput(channel) for channel in range(2)]
            self.relays = [wpilib.Relay(channel) for channel in range(4)]
            modules = (wpilib.PneumaticsModuleType.CTREPCM, 8), (wpilib.PneumaticsModuleType.REVPH, 16)
            self.solenoids = [wpilib.Solenoid(kind, port) for kind, ports in modules for port in range(ports)]
            self.turn, self.began = 0, []

        def robotPeriodic(self):
            self.began.append(wall())
            if len(self.began) % 250 == 0:
                Path(__file__).with_name("loops.json").write_text(json.dumps(self.began))

        def teleopPeriodic(self):
            self.turn += 1
            for number, motor in enumerate(self.motors):
                motor.set(math.sin(self.turn / 10 + number))
            for number, output in enumerate(self.outputs):
                output.set((self.turn + number) % 2 == 0)
            for voltage in self.voltages:
                voltage.setVoltage(2.5 + 2 * math.sin(self.turn / 20))
            for number, relay in enumerate(self.relays):
                ways = wpilib.Relay.Value.kForward, wpilib.Relay.Value.kReverse
                relay.set(ways[(self.turn + number) % 2])
            for number, solenoid in enumerate(self.solenoids):
                solenoid.set((self.turn + number) % 2 == 0)
"""

PHYSICS = """
    class PhysicsEngine:
        def __init__(self, physics_controller):
            self.physics_controller = physics_controller

        def update_sim(self, now, tm_diff):
            self.physics_controller.drive(5.0, 0.5, tm_diff)
"""


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60.0, help="for how long to measure")
    parser.add_argument("--no-window", action="store_true", help="only the one without a window")
    options = parser.parse_args()
    if options.no_window:
        measure(options.seconds, None)
        return
    command = [sys.executable, __file__, "--no-window", "--seconds", str(options.seconds)]
    with virtual_display() as display, subprocess.Popen(command):  # side by side: what else runs here disturbs both
        measure(options.seconds, display.name)


def measure(seconds: float, display: str | None) -> None:
    """One simulation; with a window, where there is a display for it."""
    with TemporaryDirectory() as directory:
        project = Path(directory).resolve()
        (project / "robot.py").write_text(dedent(ROBOT), encoding="utf-8")
        (project / "physics.py").write_text(dedent(PHYSICS), encoding="utf-8")
        simulation = Simulation(Project(project / "robot.py"))
        window = None if display is None else Window(simulation, display)
        with simulation:
            if window is not None:
                window.begin()
            print(*watch(simulation, seconds, project, window), sep="\n")
            if window is not None:
                window.close()


def watch(simulation: Simulation, seconds: float, project: Path, window: Window | None) -> Iterator[str]:
    """Let the robot run for so long, and say how it went."""

    def until(time_of: float) -> None:
        if window is None:
            simulation.wait_for(lambda: simulation.snapshot is not None and simulation.snapshot.time >= time_of)
            return

        def check() -> None:
            if simulation.snapshot is not None and simulation.snapshot.time >= time_of:
                window.root.quit()
            else:
                window.root.after(100, check)

        check()
        window.root.mainloop()

    until(0.5)
    simulation.enable()
    until(2.0)
    began, used = time.perf_counter(), time.process_time()
    frames = 0 if window is None else window.frames
    snapshot = simulation.snapshot
    assert snapshot is not None
    until(snapshot.time + seconds)
    took = time.perf_counter() - began
    used = time.process_time() - used
    yield f"{'with' if window is not None else 'without'} the window, {took:.1f} s:"
    if window is not None:
        channels = sum(len(item.row.paths) for item in window.devices.items)
        yield f"  {(window.frames - frames) / took:.1f} frames a second, with {channels} values shown"
    yield f"  this process took {100 * used / took:.1f} % of a core"
    loops = json.loads((project / "loops.json").read_text())[100:]
    gaps = sorted((after - before) * 1000 for before, after in zip(loops, loops[1:], strict=False))  # noqa: RUF007
    late = [(wall - loops[0] - 0.02 * number) * 1000 for number, wall in enumerate(loops)]
    off = sorted(abs(gap - 20) for gap in gaps)
    pace = (len(loops) - 1) / (loops[-1] - loops[0])
    yield f"  {pace:.3f} loops a second; drift at the end {late[-1]:+.2f} ms, at most {max(map(abs, late)):.2f} ms"
    yield (
        f"  between loops: median {statistics.median(gaps):.2f} ms, "
        f"99 % within {off[len(off) * 99 // 100]:.2f} ms of 20, longest {gaps[-1]:.2f} ms"
    )


if __name__ == "__main__":
    main()
