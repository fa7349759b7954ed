"""Which motors answer which joystick axis, and how: found by driving the robot, one axis after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from ...hal import HalData, modes
from ...runtime.robot import RobotRun

#: A joystick's port and the index of one of its axes.
Axis = tuple[int, int]

#: For each axis that motors answer: how much the output of each changes when that axis is pushed to -1, which for a
#: stick is forward or left. By the motors' paths in `hal_data`.
Responses = dict[Axis, dict[str, float]]

Output = Callable[[HalData], float]

#: The axes that are a stick's forward and backward: of a joystick or a gamepad's left stick, and of its right stick.
FORWARD_AXES = (1, 5)

_PORTS, _AXES = 6, 6
_PUSHED_US, _STEADY_US = 200_000, 100_000
#: How often to wait for motors to come to rest, for code that lets them speed up and slow down gently.
_PATIENCE = 40
#: Changes of an output smaller than this are not an answer.
_SMALL = 0.04


def try_sticks(run: RobotRun, outputs: Mapping[str, Output]) -> Responses:
    """Drive the robot in teleop, pushing each axis there may be to both its ends.

    An axis that moves nothing by itself is tried again while the robot drives forward, for robots that steer only then.

    :param outputs: what to look at, by name
    """
    trial = _Trial(run, outputs)
    trial.begin()
    responses = {axis: answers for axis in _axes() if (answers := trial.response(axis))}
    forward = next((axis for axis in responses if axis[1] in FORWARD_AXES and len(responses[axis]) > 1), None)
    if forward is not None and not any(
        axis != forward and answers.keys() == responses[forward].keys() for axis, answers in responses.items()
    ):
        silent = [axis for axis in _axes() if axis not in responses]
        responses |= {axis: answers for axis in silent if (answers := trial.response(axis, held=forward))}
    trial.end()
    return responses


def _axes() -> Iterator[Axis]:
    return ((port, axis) for port in range(_PORTS) for axis in range(_AXES))


class _Trial:
    """The robot enabled, with a hand on its sticks."""

    def __init__(self, run: RobotRun, outputs: Mapping[str, Output]) -> None:
        self._run = run
        self._hal_data = run.hal_data
        self._outputs = dict(outputs)
        self._at_rest: dict[str, float] = {}

    def begin(self) -> None:
        modes.set_mode(enabled=True)
        self._wait(5 * _STEADY_US)
        self._at_rest = self._read()

    def end(self) -> None:
        modes.set_mode(enabled=False)
        self._wait(_STEADY_US)

    def response(self, axis: Axis, held: Axis | None = None) -> dict[str, float]:
        """Half the difference of the outputs with the axis at -1 and at 1, of those that change.

        :param held: an axis that is at -1 meanwhile
        """
        if not self._run.alive:
            return {}
        ends = []
        for value in (-1.0, 1.0):
            if held is not None:
                self._push(held, -1.0)
            self._push(axis, value)
            self._wait(_PUSHED_US)
            ends.append(self._read())
            self._push(axis, 0.0)
            if held is not None:
                self._push(held, 0.0)
            self._come_to_rest()
        back, forth = ends
        answers = {name: (back[name] - forth[name]) / 2 for name in self._outputs}
        return {name: answer for name, answer in answers.items() if abs(answer) >= _SMALL}

    def _come_to_rest(self) -> None:
        """Wait until all outputs are as they were. Those that never are move by themselves: they are left out then."""
        for _ in range(_PATIENCE):
            self._wait(_STEADY_US)
            now = self._read()
            restless = {name for name, value in now.items() if abs(value - self._at_rest[name]) >= _SMALL}
            if not restless:
                return
        for name in restless:
            del self._outputs[name]

    def _push(self, axis: Axis, value: float) -> None:
        port, index = axis
        self._hal_data["joysticks"][port]["axes"][index] = value

    def _wait(self, us: int) -> None:
        self._run.run_until(self._run.clock.now_us + us)

    def _read(self) -> dict[str, float]:
        return {name: output(self._hal_data) for name, output in self._outputs.items()}
