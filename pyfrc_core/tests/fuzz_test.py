"""Mashes the buttons and switches in random ways, to find the control situations that nobody thinks of.

Its random numbers start from the run's seed, so a failure can be had again: the report names the seed.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

from ..hal import HalData
from ..test_support.controller import TestController
from ..test_support.fake_time import FakeTime

__all__ = ["test_fuzz"]

# How many of a robot's inputs change at each packet, on average: enough to chord buttons, few enough to hold them.
_CHANGES_PER_PACKET = 0.5

# What people and their gamepads produce: the ends, the middle, the edges of dead bands, and anything in between.
_STICK_POSITIONS = (-1.0, -0.05, -0.02, 0.0, 0.02, 0.05, 1.0)
_POV_ANGLES = (-1, 0, 45, 90, 135, 180, 225, 270, 315)


def test_fuzz(hal_data: HalData, control: TestController, fake_time: FakeTime, robot: Any) -> None:
    """Runs through a whole game randomly setting components."""
    __tracebackhide__ = True
    control.set_practice_match()
    control.run_test(_Masher(hal_data).on_step)


class _Masher:
    """Changes inputs of what the robot has made, at random."""

    def __init__(self, hal_data: HalData) -> None:
        self._hal_data = hal_data
        self._inputs: list[str] = []

    def on_step(self, now: float) -> bool:
        if round(now * 50) % 50 == 1:  # once a second: the robot may have made more
            self._inputs = sorted(self._find_inputs())
        while random.random() < _CHANGES_PER_PACKET / (1 + _CHANGES_PER_PACKET):
            path = random.choice(self._inputs)
            self._hal_data.write(path, self._new_value(path))
        return True

    def _find_inputs(self) -> Iterator[str]:
        """The paths of the inputs that there are: all controls, and the sensors that the robot reads."""
        for number, stick in enumerate(self._hal_data["joysticks"]):
            yield from (f"joysticks[{number}].axes[{axis}]" for axis in range(stick["axis_count"]))
            yield from (f"joysticks[{number}].buttons[{button}]" for button in range(1, stick["button_count"] + 1))
            yield from (f"joysticks[{number}].povs[{pov}]" for pov in range(stick["pov_count"]))
        for kind, value in (("dio", "value"), ("analog_in", "voltage"), ("encoder", "count")):
            for number, device in enumerate(self._hal_data[kind]):
                if device["initialized"] and device.get("is_input", True):
                    yield f"{kind}[{number}].{value}"

    def _new_value(self, path: str) -> float | int | bool:
        if ".axes" in path:
            return random.choice((*_STICK_POSITIONS, random.uniform(-1, 1)))
        if ".povs" in path:
            return random.choice(_POV_ANGLES)
        if path.startswith("analog_in"):
            return random.uniform(0, 5)  # volts
        if path.startswith("encoder"):
            return int(self._hal_data.read(path)) + random.randint(-200, 200)
        return random.random() < 0.5
