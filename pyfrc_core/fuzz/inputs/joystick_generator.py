"""Generate joystick inputs: a pose of several controls, held for a while, then another.

Bugs need chords. Two buttons with a stick at its end are one pose in a few hundred; if each control changed
independently, they would be one moment in millions. Controls that the robot asks for are pressed more often. How long a
pose is held, and what changes, is a driver's habit.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Container, Iterable, Sequence

from ...runtime.clock import PACKET_US
from ...wpi import station
from .drivers import Habit, draw_habit
from .values import POV_ANGLES, UNKNOWN, Input, InputKind, RobotConstants, Value, draw

#: Packets come 50 times a second, and hands move no faster.
_STEP_US = 2 * PACKET_US

#: How often each port is used when the robot's joysticks are not found: teams count from 0.
_UNKNOWN = (40, 15, 3, 1, 1, 1)
#: How often the ports with and without a joystick of the robot are used when they are found.
_KNOWN, _OTHERS = 100, 1

#: How often a control is used that the robot has asked for, one that every gamepad has, and any other.
_ASKED, _COMMON, _RARE = 80, 8, 1

#: How often a thumb rolls around a POV that it presses.
_ROLLS = 0.35

#: How often an axis that is moved is that of a stick in a corner.
_CORNERS = 0.15

_RELEASED: dict[InputKind, float] = {"axis": 0.0, "trigger": 0.0, "button": False, "pov": station.NOT_PRESSED}


class JoystickGenerator:
    """Generates one match's joystick inputs.

    :param asked: the targets of the controls that the robot has asked for; they may become more
    :param constants: the constants of the robot's code
    :param haste: how many times as fast as usual the drivers are
    """

    def __init__(
        self,
        rng: random.Random,
        asked: Container[str] = (),
        constants: RobotConstants = UNKNOWN,
        haste: float = 1.0,
    ) -> None:
        self._rng = rng
        self._haste = haste
        self._asked = asked
        self._constants = constants
        self.next_us = 0
        #: Ports without a joystick: writing to them would plug one in.
        self.unplugged: set[int] = set()
        self._ports: list[tuple[list[Input], list[Input], list[Input]]] = [
            ([], [], []) for _ in range(station.JOYSTICKS)
        ]
        self._weights: tuple[int, ...] = _UNKNOWN
        self._pose_until_us = 0
        self._held: dict[Input, float] = {}
        #: Taps: the time, the button or POV, and its value.
        self._taps: list[tuple[int, Input, float]] = []
        #: Axes in motion: the time and value at the start, and the value at the end of the pose.
        self._moving: dict[Input, tuple[int, float, float]] = {}
        self._trembling: Input | None = None
        #: Whether the driver station sends the joysticks' data in the current mode.
        self._sent = True

    def set_controls(self, controls: Iterable[Input], gamepads: Iterable[int]) -> None:
        """Set the controls, and the ports for which the robot has created joysticks."""
        self._ports = [([], [], []) for _ in range(station.JOYSTICKS)]
        for control in controls:
            port = int(control.device[len("joysticks[") : -1])
            sort = {"button": 0, "pov": 2}.get(control.kind, 1)
            self._ports[port][sort].append(control)
        known = set(gamepads)
        self._weights = (
            tuple(_KNOWN if port in known else _OTHERS for port in range(station.JOYSTICKS)) if known else _UNKNOWN
        )

    def unplug(self, port: int) -> None:
        """Unplug the joystick, and release its controls."""
        self.unplugged.add(port)
        gone = f"joysticks[{port}]"
        self._held = {control: value for control, value in self._held.items() if control.device != gone}
        self._moving = {control: moving for control, moving in self._moving.items() if control.device != gone}
        self._taps = [tap for tap in self._taps if tap[1].device != gone]
        if self._trembling is not None and self._trembling.device == gone:
            self._trembling = None

    def plug_in(self, port: int) -> None:
        """Plug the joystick in, with all controls released."""
        self.unplugged.discard(port)

    def change_pose(self, now_us: int) -> None:
        """Begin another pose now."""
        self._pose_until_us = self.next_us = now_us

    def set_sent(self, sent: bool, now_us: int) -> None:
        """Set whether the driver station sends the joysticks' data from now on. If not, the robot sees none pressed."""
        if sent != self._sent:
            self._sent = sent
            self.change_pose(now_us)

    def write(self, now_us: int, found: dict[str, Value]) -> None:
        """Add the writes of this time."""
        if not self._sent:
            self._finish(found)
            self._hands_off(found)
            self.next_us = sys.maxsize
            return
        if now_us >= self._pose_until_us:
            self._pose(now_us, found)
        while self._taps and self._taps[0][0] <= now_us:
            _, control, value = self._taps.pop(0)
            found[control.target] = value
        for control, (start_us, start, end) in self._moving.items():
            done = (now_us - start_us) / (self._pose_until_us - start_us)
            self._set(control, round(start + (end - start) * done, 3), found)
        if self._trembling is not None:
            held = self._held.get(self._trembling, 0.0)
            found[self._trembling.target] = round(min(1.0, max(-1.0, held + self._rng.uniform(-0.02, 0.02))), 3)
        step = [now_us + _STEP_US] if self._moving or self._trembling is not None else []
        self.next_us = min([self._pose_until_us, *step, *(at for at, _, _ in self._taps)])

    def _pose(self, now_us: int, found: dict[str, Value]) -> None:
        rng, habit = self._rng, draw_habit(self._rng)
        self._finish(found)
        for control in [control for control in self._held if rng.random() < habit.let_go]:
            self._set(control, _RELEASED[control.kind], found)
        there = [port for port in range(station.JOYSTICKS) if port not in self.unplugged and any(self._ports[port])]
        self._pose_until_us = now_us + max(PACKET_US, round(habit.duration(rng) / self._haste * 50) * PACKET_US)
        if not there or rng.random() < 0.1:
            self._hands_off(found)
            return
        ports = rng.choices(there, [self._weights[port] for port in there], k=rng.choice((1, 1, 1, 2)))
        if habit.together:
            ports = [port for port in there if self._weights[port] == max(self._weights[each] for each in there)]
        for port in dict.fromkeys(ports):
            self._press(*self._ports[port], habit, now_us, found)

    def _finish(self, found: dict[str, Value]) -> None:
        """Taps end with the pose, and moving sticks arrive where they were going."""
        for _, control, value in self._taps:
            if value == _RELEASED[control.kind]:
                found[control.target] = value
        for control, (_, _, end) in self._moving.items():
            self._set(control, end, found)
        if self._trembling is not None:
            found[self._trembling.target] = self._held.get(self._trembling, 0.0)
        self._taps, self._moving, self._trembling = [], {}, None

    def _hands_off(self, found: dict[str, Value]) -> None:
        for control in list(self._held):
            self._set(control, _RELEASED[control.kind], found)

    def _press(
        self,
        buttons: list[Input],
        axes: list[Input],
        povs: list[Input],
        habit: Habit,
        now_us: int,
        found: dict[str, Value],
    ) -> None:
        rng = self._rng
        for button in self._some(buttons, rng.choice(habit.buttons)):
            self._set(button, True, found)
        for axis in self._some(axes, rng.choice(habit.axes)):
            if axis.kind == "axis" and rng.random() < _CORNERS:
                self._push_into_corner(axis, axes, found)
                continue
            value = draw(axis.kind, rng, constants=self._constants)
            how = rng.random()
            if how < 0.2:
                self._moving[axis] = (now_us, self._held.get(axis, 0.0), value)
            else:
                self._set(axis, value, found)
                if how < 0.25 and axis.kind == "axis":
                    self._trembling = axis
        if povs and rng.random() < habit.pov:
            pov = rng.choice(povs)
            if rng.random() < _ROLLS and pov not in self._held:
                self._roll(pov, now_us)
            else:
                self._set(pov, draw("pov", rng), found)
        for button in self._some(buttons, rng.choice(habit.taps)):
            if button not in self._held:
                self._tap(button, rng.choice(habit.times), now_us)
        self._taps.sort()

    def _push_into_corner(self, axis: Input, axes: Sequence[Input], found: dict[str, Value]) -> None:
        """Push a stick into a corner, where it is further from its middle than 1."""
        other = axes.index(axis) ^ 1  # a stick's two axes are neighbors
        for each in (axis, *axes[other : other + 1]):
            if each.kind == "axis":
                self._set(each, self._rng.choice((-1.0, 1.0)), found)

    def _roll(self, pov: Input, now_us: int) -> None:
        """Roll a thumb around a POV: it is at several angles, each for a moment."""
        rng = self._rng
        index, step = rng.randrange(len(POV_ANGLES)), rng.choice((-1, 1))
        at_us = now_us + PACKET_US
        for _ in range(rng.randint(2, len(POV_ANGLES))):
            if at_us + 5 * PACKET_US > self._pose_until_us:
                break
            self._taps.append((at_us, pov, POV_ANGLES[index % len(POV_ANGLES)]))
            index, at_us = index + step, at_us + rng.randint(1, 4) * PACKET_US
        self._taps.append((at_us, pov, station.NOT_PRESSED))

    def _tap(self, button: Input, times: int, now_us: int) -> None:
        rng = self._rng
        pressed_us = now_us + rng.randint(0, 10) * PACKET_US
        for _ in range(times):
            released_us = pressed_us + rng.randint(1, 3) * PACKET_US
            if pressed_us + PACKET_US <= self._pose_until_us:
                self._taps += [(pressed_us, button, True), (released_us, button, False)]
            pressed_us = released_us + rng.randint(1, 10) * PACKET_US

    def _some(self, controls: Sequence[Input], count: int) -> list[Input]:
        """Return this many different controls. What the robot asks for is more likely, and then low numbers: gamepads
        have those, and robots read them.
        """
        left, found = list(controls), []
        for _ in range(min(count, len(left))):
            # The first ten (axes: six) are on every gamepad.
            common = 10 if left[0].kind == "button" else 6
            weights = [
                _ASKED if control.target in self._asked else _COMMON if index < common else _RARE
                for index, control in enumerate(left)
            ]
            (chosen,) = self._rng.choices(range(len(left)), weights)
            found.append(left.pop(chosen))
        return found

    def _set(self, control: Input, value: float, found: dict[str, Value]) -> None:
        released = _RELEASED[control.kind]
        if value == self._held.get(control, released):
            return
        found[control.target] = value
        if value == released:
            del self._held[control]
        else:
            self._held[control] = value
