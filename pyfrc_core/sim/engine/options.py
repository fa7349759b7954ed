"""The options of a simulation."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ...errors import UsageError
from ...runtime.scripts.script import InputScript
from ...season import CURRENT
from .extensions import check_installed

#: The port where dashboards look for a robot's NetworkTables.
NT4_PORT = 5810


@dataclass(frozen=True)
class SimOptions:
    """How to simulate.

    :param speed: robot seconds per second; 0 is as fast as possible
    :param paused: whether to begin with time paused
    :param script: inputs of the robot, besides the commands
    :param start_at: replay to this moment before anything is shown, in seconds of robot time
    :param run_until: pause at this moment, in seconds of robot time
    :param recording: whether to record inputs and outputs; going back in time is possible only then
    :param nt_port: where to serve NetworkTables to dashboards; None: nowhere
    :param nt_shared: whether dashboards on other computers can connect, and change every value
    :param wpilog: where to write WPILib's data log
    :param extensions: WPILib's simulation extensions to load, by name
    :param start_position: where the robot starts, one of the field's `starts`
    :param opmodes: the names of opmodes to choose, each for its mode; the robot is put into the mode of the first
    :param fork: False starts each robot in a new interpreter, as on systems where processes cannot be forked
    :param network_values: whether to report the values of NetworkTables, for `Simulation.network_cursor`
    """

    speed: float = 1.0
    paused: bool = False
    script: InputScript | None = None
    start_at: float = 0.0
    run_until: float | None = None
    recording: bool = True
    nt_port: int | None = None
    nt_shared: bool = False
    wpilog: Path | None = None
    extensions: tuple[str, ...] = ()
    start_position: str | None = None
    opmodes: tuple[str, ...] = ()
    fork: bool | None = None
    network_values: bool = False

    def check(self) -> None:
        """Check that these options are possible together.

        :raises UsageError: naming the option that is impossible
        """
        check_speed(self.speed)
        check_installed(self.extensions)
        if self.opmodes and not CURRENT.opmodes:
            raise UsageError(f"the WPILib of {CURRENT.year} has no opmodes", remedy="Leave out --opmode.")
        if self.opmodes and self.script is not None:
            raise UsageError(
                "--opmode and --script are mutually exclusive",
                remedy='A script selects opmodes by "control.opmode", beside "mode".',
            )
        if self.run_until is not None and self.run_until < self.start_at:
            raise UsageError(
                f"--seconds {self.run_until:g} is before --from {self.start_at:g}",
                remedy="--seconds is the robot time to end at, not for how long.",
            )
        if self.script is None:
            return
        end = self.script.end_us / 1_000_000
        for name, when in (("--from", self.start_at), ("--seconds", self.run_until)):
            if when is not None and when > end:
                raise UsageError(
                    f"{name} {when:g} is after the script's end, at {end:g} s",
                    where=self.script.file,
                    remedy='A script ends at the "end" in its first line; raise that for the robot to run longer.',
                )


def check_speed(factor: float) -> None:
    """Check that a speed is possible.

    :raises UsageError: when it is not
    """
    if not (factor == 0 or 0.01 <= factor <= 1000):
        raise UsageError(
            f"the speed cannot be {factor:g}",
            remedy="1 is real time, 0.1 slow motion, 0 as fast as it goes; at most 1000.",
        )
