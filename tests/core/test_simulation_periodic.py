"""Robot code's own physics sees the outputs of a disabled robot as off, and is followed by what waits for it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from pyfrc_core.runtime.time import simulation_periodic
from pyfrc_core.runtime.time.simulation_periodic import gate_robot, gate_subsystems
from pyfrc_core.wpi import commands, robots, station


class Gate:
    closed = False

    @contextmanager
    def closed_while_disabled(self) -> Iterator[None]:
        self.closed = True
        yield
        self.closed = False


class Simulated:
    """A robot, or a subsystem."""

    def __init__(self, log: list[object], gate: Gate) -> None:
        self._log, self._gate = log, gate

    def simulate(self) -> None:
        self._log.append("off" if self._gate.closed else "on")


@pytest.mark.parametrize("of_robot", [True, False])
def test_outputs_are_off_while_the_robot_is_disabled(monkeypatch: pytest.MonkeyPatch, of_robot: bool) -> None:
    log: list[object] = []
    gate: Any = Gate()
    simulated = Simulated(log, gate)
    enabled = True
    monkeypatch.setattr(station, "is_enabled", lambda: enabled)
    monkeypatch.setattr(robots, "own_simulation", lambda robot: "simulate")
    monkeypatch.setattr(commands, "simulated_subsystems", lambda: [(simulated, "simulate")])
    assert simulation_periodic.station is station
    if of_robot:
        gate_robot(simulated, lambda: gate, lambda: log.append("after"))
    else:
        gate_subsystems(lambda: gate, lambda: log.append("after"))
    simulated.simulate()
    enabled = False
    simulated.simulate()
    assert log == ["on", "after", "off", "after"]
    assert not gate.closed


def test_a_robot_without_physics_of_its_own_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robots, "own_simulation", lambda robot: None)
    robot = Simulated([], Gate())
    gate_robot(robot, Gate, lambda: None)  # type: ignore[arg-type]
    assert "simulate" not in vars(robot)
