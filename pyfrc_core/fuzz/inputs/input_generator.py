"""Generate the inputs of a whole match, packet by packet, from one random number generator."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Container, Mapping, Sequence
from typing import TYPE_CHECKING

from ...hal.paths import join
from ...hal.rows import all_rows
from ...runtime.clock import PACKET_US, to_us
from ...runtime.scripts.targets import MODE, OPMODE, PLUGGED, RESTART
from ...wpi import robots, station
from ...wpi.opmodes import PublishedOpmode
from .dashboard_generator import DashboardGenerator, find_dashboard_inputs
from .drivers import choose_models
from .finders import SensorFinder, find_controls
from .gamepads import find_gamepads
from .joystick_generator import JoystickGenerator
from .left_out import LeftOut, one_of, without
from .match_plan import BaseMatch, MatchEvent
from .network_reads import NetworkReads
from .network_values import NetworkRead
from .sensor_generator import SensorGenerator
from .values import UNKNOWN, Input, RobotConstants, Value

if TYPE_CHECKING:
    from ...runtime.robot import RobotRun

_SECOND_US = 1_000_000

#: Robots create their joysticks when they start: they are not searched for later than this time after that.
_GAMEPADS_WITHIN_US = 2 * _SECOND_US

#: For how long after the start everything is searched for in each second; later, in every other one.
_OFTEN_FOR_US = 4 * _SECOND_US

#: Interval of the checks whether the robot's simulation drives its sensors; and where none is known.
_CHECK_EVERY_US, _CHECK_SELDOM_US = 5 * PACKET_US, 25 * PACKET_US

#: How long a robot with a simulation is enabled before its sensors are written: the simulation drives some of them.
_DRIVEN_US = 5 * _SECOND_US

#: How often switches are closed before the program starts, and stay so; the roboRIO's own digital inputs.
_HELD, _CHANNELS = 0.2, 10

#: How often the drivers choose an opmode before a period, and how often one of WPILib's utility mode before teleop.
_CHOSEN, _UTILITY = 0.9, 0.15


class InputGenerator:
    """Generates one match's inputs: the same seed gives the same robot the same inputs.

    :param rng: the only source of randomness
    :param run: the robot's run, which is only read
    :param plan: the events of the match, in order
    :param seconds: the length of the match, with all its periods
    :param network_reads: the entries of NetworkTables that the robot reads; None if they are not watched
    :param constants: the constants of the robot's code
    :param base: the recorded match with which this one begins
    :param asked_controls: the targets of the controls that the robot has asked for so far
    :param published: entries of NetworkTables that the program is known to write all the time
    :param auto_joysticks: whether the driver station sends joystick data in autonomous, too
    :param haste: how many times as fast as usual the drivers are
    """

    def __init__(
        self,
        rng: random.Random,
        run: RobotRun,
        *,
        plan: Sequence[MatchEvent],
        seconds: float,
        network_reads: NetworkReads | None = None,
        constants: RobotConstants = UNKNOWN,
        base: BaseMatch | None = None,
        asked_controls: Container[str] = (),
        published: frozenset[str] = frozenset(),
        auto_joysticks: bool = False,
        haste: float = 1.0,
    ) -> None:
        #: The inputs found so far, by target.
        self.inputs: dict[str, Input] = {}
        self._rng = rng
        self._run = run
        self._hal_data = run.hal_data
        self._end_us = to_us(seconds)
        self._plan = plan
        #: Inputs are generated from this time on.
        self._from_us = base.until_us if base else 0
        self._planned = 0
        self._constants = constants
        self._auto_joysticks = auto_joysticks
        self._models = {} if base else choose_models(rng)
        #: The controls and the gamepads that were found last.
        self._controls: tuple[list[Input], dict[int, str]] | None = None
        self._sticks = JoystickGenerator(rng, asked_controls, constants, haste)
        self._sensors = SensorGenerator(rng, self._hal_data, constants)
        self._sensor_finder = SensorFinder(constants)
        reads = None if network_reads is None else network_reads.found
        self._dashboard = DashboardGenerator(rng, reads, constants, published)
        #: Applies writes at once, while the robot starts. Set by the match.
        self.write_at_once: Callable[[Mapping[str, Value]], None] | None = None
        if network_reads is not None:
            network_reads.on_first = self._before_first_read
        #: Targets of sensors that the robot's physics drives.
        self._driven: set[str] = set()
        #: Switches that are closed for the whole match.
        self._held: set[str] = set()
        self._sensors.paused = _is_simulated(run)
        self._opmodes: list[PublishedOpmode] = []
        #: What the driver station was set to last.
        self._mode = ""
        self._enabled_since_us: int | None = None
        self._enabled_us = 0
        self._attached = True
        self._find_us = self._check_us = PACKET_US
        self._check_every_us = _CHECK_EVERY_US
        self._gamepads_until_us = _GAMEPADS_WITHIN_US
        self._often_until_us = _OFTEN_FOR_US
        #: What the match does without from now on.
        self.left_out: LeftOut = frozenset()
        #: `writes` returns nothing before this time.
        self.next_us = 0

    def over(self, now_us: int) -> bool:
        """Return whether the match is over."""
        return now_us >= self._end_us

    def writes(self, now_us: int) -> Mapping[str, Value]:
        """Return what to write before the packet of this time, by target; often nothing."""
        found: dict[str, Value] = {}
        if now_us < self.next_us:
            return found
        while self._planned < len(self._plan) and self._plan[self._planned].at_us <= now_us:
            self._apply_event(now_us, without(self.left_out, self._plan[self._planned].writes), found)
            self._planned += 1
        if RESTART in found:  # what else is written would be lost
            return found
        if now_us == 0:  # the robot has not been started
            for port, model in self._models.items():
                found |= without(self.left_out, model.writes(port))
            # What tells a team's robots from each other.
            for row in () if self._from_us else all_rows():
                # Any other text could have more bytes than letters, or be refused.
                ascii_texts = [text for text in self._constants.texts if text.isascii() and text.isprintable()]
                texts = [text for text in ascii_texts if len(text) <= row.field.kind.max_bytes]
                if row.asked_by and texts and self._constants.asks(row.asked_by) and self._rng.random() < 0.5:
                    found[join(row.kind.name, row.field.name)] = self._rng.choice(texts)
            if not self._from_us and self._constants.asks("DigitalInput"):
                found |= self._held_switches()
            return found
        if now_us >= self._find_us:
            self._find_inputs(now_us, found)
        if now_us >= self._check_us:
            self._check_physics(now_us)
        sensors, sticks, dashboard = self._sensors, self._sticks, self._dashboard
        if now_us >= self._from_us:
            if sensors.next_us <= now_us:
                sensors.write(now_us, found)
            if self._attached:  # else no input of the drivers arrives
                if sticks.next_us <= now_us:
                    sticks.write(now_us, found)
                if dashboard.next_us <= now_us:
                    dashboard.write(now_us, found)
        if self.left_out:
            found = without(self.left_out, found)
        plan_us = self._plan[self._planned].at_us if self._planned < len(self._plan) else self._end_us
        parts_us = min(sensors.next_us, sticks.next_us, dashboard.next_us) if self._attached else sensors.next_us
        self.next_us = min(self._find_us, self._check_us, plan_us, max(self._from_us, parts_us))
        return found

    def _held_switches(self) -> dict[str, Value]:
        """Return switches that are closed before the program starts, and stay so for the whole match."""
        if self._rng.random() >= _HELD:
            return {}
        held = [f"dio[{channel}]" for channel in range(_CHANNELS) if self._rng.random() < 0.3]
        self._held.update(held)
        return without(self.left_out, {f"{device}.value": False for device in held})

    def resume(self, now_us: int) -> None:
        """Go on after this time, at which the robot program is started again: the events until then are over."""
        while self._planned < len(self._plan) and self._plan[self._planned].at_us <= now_us:
            event = self._plan[self._planned]
            self._apply_event(event.at_us, without(self.left_out, event.writes), {})
            self._planned += 1
        self._find_us = self._check_us = now_us + PACKET_US
        self._gamepads_until_us = now_us + _GAMEPADS_WITHIN_US
        self._often_until_us = now_us + _OFTEN_FOR_US

    def _apply_event(self, now_us: int, event: Mapping[str, Value], found: dict[str, Value]) -> None:
        found |= event
        for target, value in event.items():
            if target == MODE:
                self._mode = str(value)
                self._choose_opmode(found)
                self._enter(str(value), now_us)
            elif target == "control.dsAttached":
                self._attached = bool(value)
            elif (stick := PLUGGED.fullmatch(target)) is not None:
                port = int(stick[1])
                (self._sticks.plug_in if value else self._sticks.unplug)(port)
                if value and port in self._models:
                    found |= without(self.left_out, self._models[port].writes(port))

    def _choose_opmode(self, found: dict[str, Value]) -> None:
        """Choose an opmode for the mode, as drivers do before they enable the robot."""
        mode = "teleop" if self._mode == "disabled" else self._mode.removeprefix("disabled ")
        offered = [each for each in self._opmodes if one_of(OPMODE, each.name) not in self.left_out]
        names_in = {each: [opmode.name for opmode in offered if opmode.mode == each] for each in ("test", mode)}
        if not self._opmodes or self._rng.random() >= _CHOSEN:
            return
        if mode == "teleop" and names_in["test"] and self._rng.random() < _UTILITY:
            mode = "test"
            found[MODE] = "disabled test" if self._mode == "disabled" else "test"
        if names_in[mode]:
            found[OPMODE] = self._rng.choice(names_in[mode])

    def _enter(self, mode: str, now_us: int) -> None:
        if self._enabled_since_us is not None:
            self._enabled_us += now_us - self._enabled_since_us
        self._enabled_since_us = None if mode.startswith("disabled") else now_us
        self._sticks.set_sent(mode != "autonomous" or self._auto_joysticks, now_us)
        if self._rng.random() < 0.3:  # in the same packet
            self._sticks.change_pose(now_us)

    def _find_inputs(self, now_us: int, found: dict[str, Value]) -> None:
        """Search again: robots may create devices and dashboard entries at any time, and mostly do when they start."""
        self._find_us += _SECOND_US if now_us < self._often_until_us else 2 * _SECOND_US
        if now_us <= self._gamepads_until_us and not self._sticks.unplugged:  # unplugged joysticks have no controls
            gamepads = find_gamepads(self._run.robot)
            controls = list(find_controls(self._hal_data, gamepads))
            if (controls, gamepads) != self._controls:
                self._controls = controls, gamepads
                self._sticks.set_controls(controls, gamepads)
                self._remember(controls)
        opmodes, self._opmodes = self._opmodes, station.published_opmodes()
        if self._opmodes and not opmodes:
            self._choose_opmode(found)
        sensors = self._sensor_finder.find()
        self._remember(sensors)
        self._sensors.set_inputs(sensors)
        # Subsystems of commands2 have simulations of their own, and so do devices on the CAN bus.
        simulated = "commands2" in sys.modules or any(each.target.startswith("CAN") for each in sensors)
        self._check_every_us = _CHECK_EVERY_US if simulated or _is_simulated(self._run) else _CHECK_SELDOM_US
        for each in sensors:
            if each.device in self._held and self._hal_data.read(each.target):  # it was created after the first write
                found[each.target] = False
        self._sensors.excluded = self._held | {each.device for each in sensors if each.target in self._driven}
        self._remember(self._dashboard.set_inputs(find_dashboard_inputs()))

    def _before_first_read(self, read: NetworkRead) -> None:
        """Write an entry before the robot first reads it, as if it had been there before the robot was started."""
        run = self._run
        at_start = run.started and run.clock.now_us == self._from_us == 0
        if self.write_at_once is None or not at_start or not self._attached:
            return
        writes = without(self.left_out, self._dashboard.before_first_read(read))
        if writes:
            self.write_at_once(writes)

    def _remember(self, inputs: list[Input]) -> None:
        self.inputs |= {each.target: each for each in inputs}

    def _check_physics(self, now_us: int) -> None:
        self._check_us += self._check_every_us
        for each in self._sensors.find_driven():
            self._driven.add(each.target)
            self._sensors.excluded.add(each.device)
        if self._sensors.paused:
            since_us = now_us if self._enabled_since_us is None else self._enabled_since_us
            self._sensors.paused = self._enabled_us + now_us - since_us < _DRIVEN_US


def _is_simulated(run: RobotRun) -> bool:
    """Return whether the robot has a simulation, which may drive its sensors."""
    return run.physics is not None or robots.own_simulation(run.robot) is not None
