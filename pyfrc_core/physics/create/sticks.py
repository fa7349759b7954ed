"""Find the motors that react to each joystick axis, by driving the robot with one axis after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TypeVar

from ...hal import HalData
from ...runtime.robot import RobotRun
from ...wpi import joysticks, station

#: A joystick's port and the index of one of its axes.
Axis = tuple[int, int]

#: For each axis that moves motors: the change of each motor's output when the axis is pushed to -1, which for a stick
#: is forward or left. The keys are the motors' paths in `hal_data`.
Responses = dict[Axis, dict[str, float]]

Output = Callable[[HalData], float]

_Seen = TypeVar("_Seen")

#: The axes for forward and backward: of a joystick or a gamepad's left stick, and of its right stick.
FORWARD_AXES = (1, *joysticks.RIGHT_STICK_FORWARD)

_PORTS, _AXES = 6, 6
_PUSHED_US, _STEADY_US, _DRIVING_US = 200_000, 100_000, 1_000_000
#: How often to wait for motors to stop, for code that limits their acceleration.
_PATIENCE = 40
#: Smaller changes of an output are not a reaction.
_SMALL = 0.04


def try_sticks(run: RobotRun, outputs: Mapping[str, Output]) -> Responses:
    """Drive the robot in teleop, moving each possible axis to both ends.

    :param outputs: the outputs to observe, by name
    """
    trial = _Trial(run, outputs)
    trial.begin()
    responses = {axis: reactions for axis in _axes() if (reactions := trial.response(axis))}
    trial.end()
    return responses


def _axes() -> Iterator[Axis]:
    return ((port, axis) for port in range(_PORTS) for axis in range(_AXES))


def _enable() -> None:
    """Enable the robot in teleop; one with opmodes in the first that it publishes for that."""
    if (opmode := next((each for each in station.published_opmodes() if each.mode == "teleop"), None)) is not None:
        station.select_opmode(opmode)
    station.set_mode(enabled=True)


class _Trial:
    """Drives the enabled robot with joystick inputs."""

    def __init__(self, run: RobotRun, outputs: Mapping[str, Output]) -> None:
        self._run = run
        self._hal_data = run.hal_data
        self._outputs = dict(outputs)
        self._at_rest: dict[str, float] = {}

    def begin(self) -> None:
        _enable()
        self._wait(5 * _STEADY_US)
        self._at_rest = self._read()

    def end(self) -> None:
        station.set_mode(enabled=False)
        self._wait(_STEADY_US)

    def response(self, axis: Axis) -> dict[str, float]:
        """Return half the difference of the outputs with the axis at -1 and at 1, for the outputs that change."""
        if not self._run.alive:
            return {}
        ends = []
        for value in (-1.0, 1.0):
            self._push(axis, value)
            self._wait(_PUSHED_US)
            ends.append(self._read())
            self._push(axis, 0.0)
            self._come_to_rest()
        back, forth = ends
        reactions = {name: (back[name] - forth[name]) / 2 for name in self._outputs}
        return {name: reaction for name, reaction in reactions.items() if abs(reaction) >= _SMALL}

    def _come_to_rest(self) -> None:
        """Wait until all outputs have their initial values.

        Outputs that never do move by themselves, and are ignored from then on.
        """
        for _ in range(_PATIENCE):
            self._wait(_STEADY_US)
            now = self._read()
            moving = {name for name, value in now.items() if abs(value - self._at_rest[name]) >= _SMALL}
            if not moving:
                return
        for name in moving:
            del self._outputs[name]

    def _push(self, axis: Axis, value: float) -> None:
        port, index = axis
        self._hal_data["joysticks"][port]["axes"][index] = value

    def _wait(self, us: int) -> None:
        self._run.run_until(self._run.clock.now_us + us)

    def _read(self) -> dict[str, float]:
        return {name: output(self._hal_data) for name, output in self._outputs.items()}


def while_driving_forward(run: RobotRun, is_driving: Callable[[], bool], look: Callable[[], _Seen]) -> _Seen | None:
    """Push one forward axis after the other for a second, in teleop.

    :param is_driving: whether the robot drives
    :returns: what `look` returns while the first such axis drives the robot; None if none does
    """
    # Robots that drive relative to the field drive the other way in the red alliance.
    run.hal_data["alliance_station"] = "blue1"
    _enable()
    try:
        for port in range(_PORTS):
            for index in FORWARD_AXES:
                axes = run.hal_data["joysticks"][port]["axes"]
                axes[index] = -1.0
                run.run_until(run.clock.now_us + _DRIVING_US)
                seen = look() if is_driving() else None
                axes[index] = 0.0
                run.run_until(run.clock.now_us + _PUSHED_US)
                if seen is not None or not run.alive:
                    return seen
        return None
    finally:
        station.set_mode(enabled=False)
        run.run_until(run.clock.now_us + _STEADY_US)
