"""The front end without a window, for continuous integration, dashboards and quick checks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from ...display import has_terminal
from ...errors import UsageError
from ...physics.pose import METRES_PER_FOOT
from ...processes.standstill import StandstillNotice
from ...repeated_lines import RepeatedLines
from ...runtime.match import MatchPeriods
from ...runtime.robot_time import PACKET_US, to_us
from ..engine.commands import ChosenMode
from ..engine.output_log import OutputCursor
from ..engine.simulation import Simulation
from ..engine.snapshot import Failure, Snapshot
from . import FrontEnd

#: What the robot is put through. ``auto`` is autonomous.
HeadlessMode = Literal["practice", "auto", "teleop", "test", "disabled"]

#: The default length of a mode, in seconds.
DEFAULT_SECONDS = 15.0

_CHOSEN: dict[str, ChosenMode] = {"auto": "autonomous", "teleop": "teleop", "test": "test"}
#: The interval of printing the robot's output, in wall seconds.
_PRINT_SECONDS = 0.25


@dataclass(frozen=True)
class Summary:
    """The result of a simulation.

    :param snapshot: the robot at the end; None when it did not start
    :param speed: robot seconds per wall second since the robot started; 0: it never ran
    """

    snapshot: Snapshot | None
    failure: Failure | None
    speed: float
    overruns: int
    worst_loop: float
    late_packets: int

    def lines(self) -> list[str]:
        """Return the result as lines of text for the user."""
        found = []
        snapshot = self.snapshot
        if snapshot is not None:
            speed = f", at {self.speed:.{0 if self.speed >= 9.95 else 1}f} times real time" if self.speed else ""
            seconds = snapshot.time
            if self.failure is not None and self.failure.time > seconds + PACKET_US / 1_000_000:
                # A process that is killed sends no last update.
                speed = f"; the figures below are of the first {seconds:.2f} s, the last that the robot reported"
                seconds = self.failure.time
            found.append(f"simulated {seconds:.2f} s of robot time{speed}")
            times = (f"{mode} {seconds:.1f} s" for mode, seconds in snapshot.mode_seconds.items())
            found.append(f"modes: {', '.join(times) or 'none'}")
            if snapshot.scene.robot is None:
                found.append("distance driven: not known without physics.py beside robot.py (pyfrc create-physics)")
            else:
                metres = snapshot.distance * METRES_PER_FOOT
                found.append(f"distance driven: {snapshot.distance:.1f} ft ({metres:.1f} m)")
            longest = f", the longest turn {self.worst_loop:.3f} s of robot time" if self.overruns else ""
            found.append(f"loop overruns: {self.overruns}{longest}")
            found.append(f"packets that took this machine longer than 20 ms: {self.late_packets}")
        if self.failure is not None:
            found.append(str(self.failure))
        return found


def _refuse_opmodes_of_other_modes(simulation: Simulation, mode: ChosenMode) -> None:
    """Refuse ``--opmode`` when no opmode with one of its names is for the mode that the robot is put through."""
    names = simulation.options.opmodes
    if not names:
        return
    simulation.wait_for(lambda: simulation.snapshot is not None or simulation.status.state == "failed")
    published = () if simulation.snapshot is None else simulation.snapshot.opmodes
    chosen = {each.mode: each.name for each in published if each.name in names}
    if not chosen or mode in chosen:  # a name that the robot has not published is refused by its process
        return
    there = ", ".join(repr(each.name) for each in published if each.mode == mode) or "none"
    raise UsageError(
        f"--mode runs opmodes for {mode}, and {min(chosen.values())!r} is not for it",
        remedy=f"Choose one of those that the robot has published for it: {there}.",
    )


class Headless(FrontEnd):
    """Runs the robot for some time, and prints a summary.

    :param say: prints
    :param mode: what to put the robot through; None: only scripts and dashboards control it
    :param seconds: for how long; None: until it is interrupted, or until the end of the script or match
    :param watching: whether a robot that fails gets new code, when no end is given
    :param quiet: print only the robot's output and what is wrong
    """

    def __init__(
        self,
        say: Callable[[str], object],
        mode: HeadlessMode | None = None,
        seconds: float | None = None,
        watching: bool = False,
        quiet: bool = False,
    ) -> None:
        self._say = say
        self._quiet = quiet
        self._mode = mode
        self._seconds = seconds
        self._watching = watching
        self._simulation: Simulation | None = None
        self._output: OutputCursor | None = None
        self._lines = RepeatedLines()
        #: Whether the robot's output has ended a line.
        self._at_line_start = True
        self._reported: Failure | None = None
        self._noted = ""
        self._notice = StandstillNotice()
        self.summary: Summary | None = None

    def run(self, simulation: Simulation) -> int:
        """Run the simulation, and return the exit code: that of the robot's failure, if it has failed."""
        self._simulation = simulation
        self._output = simulation.output_cursor()
        end = self._end(simulation)
        self._announce(simulation, end)
        interrupted = False
        try:
            simulation.start()
            self._drive(simulation, end)
        except KeyboardInterrupt:
            interrupted = True
        finally:
            status = simulation.status
            simulation.close()
        self.summary = Summary(
            simulation.snapshot,
            status.failure,
            status.average,
            status.overruns,
            status.worst_loop_seconds,
            status.late_packets,
        )
        self._print(simulation)
        self._show(self._lines.end())
        if not self._quiet:
            for line in self.summary.lines():
                self._say_line(line)
        elif status.failure is not None:
            self._say_line(str(status.failure))
        if interrupted and status.failure is None and simulation.snapshot is None:
            self._say_line(
                f"interrupted while {simulation.project.main_file.name} was still being imported and started"
            )
            return 2
        if interrupted and end is not None:
            self._say_line("interrupted")
            return 2
        return 0 if status.failure is None else status.failure.exit_code

    def _announce(self, simulation: Simulation, end: float | None) -> None:
        """Print that the robot runs, and how long: without a window, nothing else shows it."""
        if self._quiet:
            return
        what = f"in {self._mode} mode" if self._mode not in (None, "practice") else "through a practice match"
        if self._mode is None:
            what = (
                "by its script" if simulation.options.script is not None else "disabled, until a dashboard enables it"
            )
        until = "until you press Ctrl-C"
        if end is not None:
            until = f"for {round(end, 2):g} s of robot time; Ctrl-C ends it earlier"
        self._say(f"running {simulation.project.main_file.name} {what}, {until}\n")

    def saved(self, files: list[str]) -> None:
        """Print that the robot gets new code."""
        if self._quiet:
            return
        seconds = 0.0 if self._simulation is None else self._time_us(self._simulation) / 1_000_000
        verb = "was" if len(files) == 1 else "were"
        self._say_line(f"{', '.join(files)} {verb} saved: going on with the new code at {seconds:.2f} s")

    def _drive(self, simulation: Simulation, end: float | None) -> None:
        """Run the robot to the end."""
        if self._mode == "practice":
            simulation.practice()
        elif self._mode is not None and self._mode != "disabled":
            _refuse_opmodes_of_other_modes(simulation, _CHOSEN[self._mode])
            simulation.choose_mode(_CHOSEN[self._mode])
            simulation.enable()
        if end is None:
            simulation.resume()
        else:
            simulation.run_until(end)

        def over() -> bool:
            state = simulation.status.state
            return (state == "failed" and not (self._watching and end is None)) or (
                state == "paused" and end is not None and self._time_us(simulation) >= to_us(end)
            )

        while not simulation.wait_for(over, timeout=_PRINT_SECONDS):
            self._print(simulation)

    @staticmethod
    def _time_us(simulation: Simulation) -> int:
        return 0 if simulation.snapshot is None else to_us(simulation.snapshot.time)

    def _end(self, simulation: Simulation) -> float | None:
        end = self._natural_end(simulation)
        if end is not None and end < simulation.options.start_at:
            raise UsageError(
                f"--from {simulation.options.start_at:g} is after the end, at {end:g} s",
                remedy="Choose a later end by --seconds.",
            )
        return end

    def _natural_end(self, simulation: Simulation) -> float | None:
        script = simulation.options.script
        if self._seconds is not None:
            return self._seconds
        if script is not None:
            return (script.end_us - 1) / 1_000_000
        if self._mode == "practice":
            return (MatchPeriods(simulation.project.settings.match).length_us) / 1_000_000 + 0.5
        return None if self._mode is None else DEFAULT_SECONDS

    def _say_line(self, text: str) -> None:
        """Print a line of pyfrc's own, after the robot's."""
        self._say(f"{text}\n" if self._at_line_start else f"\n{text}\n")
        self._at_line_start = True

    def _show(self, output: str) -> None:
        if output:
            self._say(output)
            self._at_line_start = output.endswith("\n")

    def _print(self, simulation: Simulation) -> None:
        if self._output is not None and (output := self._lines.feed(self._output.read())):
            self._show(output)
        status = simulation.status
        if status.note not in ("", self._noted):
            self._noted = status.note
            for note in status.note.splitlines():
                self._say_line(f"warning: {note}")
        stands = status.standstill
        if stands is not None and stands.loading and (self._quiet or not has_terminal()):
            stands = None
        if (text := self._notice.look(stands)) is not None:
            self._say_line(text)
        if self._watching and status.failure is not None and status.failure is not self._reported:
            self._reported = status.failure
            if status.state == "failed":  # otherwise it is over, and the summary says so
                self._say_line(str(status.failure))
                if not self._quiet:
                    self._say_line("waiting for the correction to be saved")
