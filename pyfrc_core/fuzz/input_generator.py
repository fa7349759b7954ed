"""Mashes a robot for a whole match: says at each packet what changes, from a generator of random numbers only."""

from __future__ import annotations

import random
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import wpilib

from ..config.settings import MatchSettings
from ..runtime.clock import PACKET_US, to_us
from ..runtime.scripts.targets import MODE
from .dashboard_generator import DashboardGenerator, find_dashboard
from .gamepads import find_gamepads
from .inputs import Input, find_controls, find_sensors
from .joystick_generator import JoystickGenerator
from .match_plan import plan_match
from .sensor_generator import SensorGenerator

if TYPE_CHECKING:
    from ..runtime.robot import RobotRun

_SECOND_US = 1_000_000

#: Robots make their joysticks when they start: they are not looked for any longer than this.
_GAMEPADS_UNTIL_US = 2 * _SECOND_US

#: How often to look whether the robot's simulation moves what it measures.
_LOOK_EVERY_US = 5 * PACKET_US

#: A robot with a simulation is driven for so long, enabled, before its sensors are mashed: the simulation moves them.
_DRIVEN_US = 5 * _SECOND_US

_PLUGGED = re.compile(r"joysticks\[(\d)\]\.plugged")


class InputGenerator:
    """One match's fuzz_run. The same numbers mash the same robot in the same way.

    :param chance: where all its randomness comes from
    :param run: the robot's run, only to look at
    :param seconds: how long the match is, before, autonomous, pause and all
    :param physics_inputs: targets of sensors that are left alone, since the robot's physics drives them; others that
        are found to be driven during the match are left alone from then on
    :param settings: how long the match's periods are at most
    :param game_messages: those that the field may send, if that is known
    """

    def __init__(
        self,
        rng: random.Random,
        run: RobotRun,
        *,
        seconds: float,
        physics_inputs: frozenset[str] = frozenset(),
        settings: MatchSettings | None = None,
        game_messages: Sequence[str] = (),
    ) -> None:
        #: What it has found to mash, by target.
        self.inputs: dict[str, Input] = {}
        self._rng = rng
        self._run = run
        self._hal_data = run.hal_data
        self._end_us = to_us(seconds)
        self._plan = plan_match(rng, seconds, settings or MatchSettings(), game_messages)
        self._planned = 0
        self._sticks = JoystickGenerator(rng)
        self._sensors = SensorGenerator(rng, self._hal_data)
        self._dashboard = DashboardGenerator(rng)
        self._driven = set(physics_inputs)
        self._sensors.waits = not physics_inputs and _is_simulated(run)
        self._enabled_since_us: int | None = None
        self._enabled_us = 0
        self._attached = True
        self._find_us = self._look_us = PACKET_US
        self._next_us = 0

    @property
    def driven_by_physics(self) -> frozenset[str]:
        """The targets that are left alone, since the robot's simulation drives them; as far as it has shown."""
        return frozenset(self._driven)

    def over(self, now_us: int) -> bool:
        """Whether the match is over."""
        return now_us >= self._end_us

    def writes(self, now_us: int) -> Mapping[str, Any]:
        """What to write before the packet of this moment, by target; most often nothing."""
        found: dict[str, Any] = {}
        if now_us < self._next_us:
            return found
        while self._planned < len(self._plan) and self._plan[self._planned].at_us <= now_us:
            self._happen(now_us, self._plan[self._planned].writes, found)
            self._planned += 1
        if now_us == 0:  # the robot has not started
            return found
        if now_us >= self._find_us:
            self._find_inputs(now_us)
        if now_us >= self._look_us:
            self._look_for_physics(now_us)
        parts: list[JoystickGenerator | SensorGenerator | DashboardGenerator] = [self._sensors]
        if self._attached:  # else nothing that people do arrives
            parts += [self._sticks, self._dashboard]
        for part in parts:
            if part.next_us <= now_us:
                part.write(now_us, found)
        plan = self._plan[self._planned].at_us if self._planned < len(self._plan) else self._end_us
        self._next_us = min(self._find_us, self._look_us, plan, *(part.next_us for part in parts))
        return found

    def _happen(self, now_us: int, event: Mapping[str, Any], found: dict[str, Any]) -> None:
        found |= event
        for target, value in event.items():
            if target == MODE:
                self._enter(value, now_us)
            elif target == "control.dsAttached":
                self._attached = value
            elif (stick := _PLUGGED.fullmatch(target)) is not None:
                (self._sticks.plug_in if value else self._sticks.unplug)(int(stick[1]))

    def _enter(self, mode: str, now_us: int) -> None:
        if self._enabled_since_us is not None:
            self._enabled_us += now_us - self._enabled_since_us
        self._enabled_since_us = None if mode.startswith("disabled") else now_us
        if self._rng.random() < 0.3:  # in the very packet
            self._sticks.change_pose(now_us)

    def _find_inputs(self, now_us: int) -> None:
        """Robots make devices, and entries of their dashboard, whenever they like."""
        self._find_us += _SECOND_US
        if now_us <= _GAMEPADS_UNTIL_US and not self._sticks.unplugged:  # those have no controls
            gamepads = find_gamepads(self._run.robot)
            controls = list(find_controls(self._hal_data, gamepads))
            self._sticks.know(controls, gamepads)
            self._remember(controls)
        sensors = sorted(find_sensors(self._hal_data))
        self._remember(sensors)
        self._sensors.know(sensors)
        self._sensors.left_alone = {each.device for each in sensors if each.target in self._driven}
        self._dashboard.know(sorted(find_dashboard()))

    def _remember(self, inputs: list[Input]) -> None:
        self.inputs |= {each.target: each for each in inputs}

    def _look_for_physics(self, now_us: int) -> None:
        self._look_us += _LOOK_EVERY_US
        for each in self._sensors.look():
            self._driven.add(each.target)
            self._sensors.left_alone.add(each.device)
        if self._sensors.waits:
            since_us = now_us if self._enabled_since_us is None else self._enabled_since_us
            self._sensors.waits = self._enabled_us + now_us - since_us < _DRIVEN_US


def _is_simulated(run: RobotRun) -> bool:
    """Whether something may drive the robot's sensors."""
    own = getattr(type(run.robot), "_simulationPeriodic", None)
    return run.physics is not None or own not in (None, wpilib.IterativeRobotBase._simulationPeriodic)
