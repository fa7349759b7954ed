"""The data that the driver station sends: mode, alliance, match, joysticks; and the rumble that the robot sends back.

A write is visible here at once. The robot sees it with the next driver-station packet, as with a real one.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import hal
import wpilib
from hal import simulation as hs
from wpilib.simulation import DriverStationSim

from ...wpi.season_2027 import station
from ..containers import LiveDict, LiveList, Slot, stored
from ..joystick_lists import JoystickLists
from ..kinds import BOOL, choice, text, whole
from ..paths import join

AXES, POVS = 12, 8  # the maximum of the HAL
BUTTONS = station.BUTTONS  # the shortest list; a joystick with more buttons shows all

MATCH_TYPE = choice({"none": 0, "practice": 1, "qualification": 2, "elimination": 3}, wpilib.MatchType)


def _mode(mode: hal.RobotMode) -> tuple[Callable[[Any], bool], Callable[[Any, bool], None]]:
    """Return the functions that read and write whether this mode is chosen."""

    def put(sim: type[DriverStationSim], on: bool) -> None:
        if on:
            station.send_mode(mode)
        elif sim.get_robot_mode() == mode:
            station.send_mode(hal.RobotMode.TELEOPERATED)

    return lambda sim: bool(sim.get_robot_mode() == mode), put


is_autonomous, set_autonomous = _mode(hal.RobotMode.AUTONOMOUS)
is_test, set_test = _mode(hal.RobotMode.UTILITY)


def opmode_name(sim: object) -> str:
    """Return the name of the chosen opmode."""
    return station.opmode_name()


def select_opmode(sim: object, name: str) -> None:
    """Choose an opmode."""
    station.select_opmode_named(name)


class EventData(LiveDict):
    """The match, as sent by the field."""

    #: The keys of `plain_values`.
    recorded = ("name", "match_type", "match_number", "replay_number", "game_specific_message")

    def __init__(self) -> None:
        super().__init__("event", self._all)
        self._info, self._data = hal.MatchInfo(), hal.GameData()

    def plain_values(self) -> list[Any]:
        """Return the values of `recorded`."""
        info = self._info
        hs.get_match_info(info)
        return [
            station.text_of(info.event_name),
            int(info.match_type),
            info.match_number,
            info.replay_number,
            self._message(),
        ]

    def _message(self) -> str:
        hs.get_game_data(self._data)
        return station.text_of(self._data.game_data)

    def _all(self) -> dict[str, Slot]:
        info, sim, named = self._info, DriverStationSim, MATCH_TYPE.load or int

        def get(read: Callable[[], Any]) -> Callable[[], Any]:
            def current() -> Any:
                hs.get_match_info(info)
                return read()

            return current

        return {
            "name": Slot(get(lambda: station.text_of(info.event_name)), sim.set_event_name, text(63)),
            "match_type": Slot(get(lambda: named(info.match_type)), sim.set_match_type, MATCH_TYPE),
            "match_number": Slot(get(lambda: info.match_number), sim.set_match_number, whole(0, 65535)),
            "replay_number": Slot(get(lambda: info.replay_number), sim.set_replay_number, whole(0, 255)),
            "game_specific_message": Slot(self._message, station.set_game_message, text(64)),
            "has_source": stored(False),
        }


def joysticks() -> LiveList:
    """Return the joysticks, by port."""
    return LiveList("joysticks", [JoystickData(port) for port in range(station.JOYSTICKS)])


class JoystickData(JoystickLists):
    """One joystick: its axes, buttons and POVs as sent to the robot, and the data that the robot sends back.

    The robot sees `axis_count` axes, `button_count` buttons and `pov_count` POVs; writing a later one raises its count.
    Buttons have the numbers that robot code gives: from 0 on in 2027. POVs are angles in degrees, as in 2026.
    Values are read from WPILib's buffer, so an axis has the precision of a C float.
    """

    #: The keys of `sent_back`.
    sent_keys = ("left_rumble", "right_rumble", "left_trigger_rumble", "right_trigger_rumble", "leds")

    def __init__(self, port: int) -> None:
        super().__init__(join("joysticks", port), self._all, AXES, POVS)
        self._port = port
        self._axes, self._buttons, self._povs = hal.JoystickAxes(), hal.JoystickButtons(), hal.JoystickPOVs()
        # Both are views of the buffers above, which each read fills again.
        self._axis_values, self._pov_values = self._axes.axes, self._povs.povs

    def counts(self) -> tuple[int, int, int]:
        """Return how many axes, buttons and POVs the robot sees."""
        return station.counts(self._port)

    def _all(self) -> dict[str, Slot]:
        port = self._port

        def count(index: int, put: Callable[[int, int], object], most: int) -> Slot:
            def set_count(value: int) -> None:
                put(port, station.mask(value))

            return Slot(lambda: self.counts()[index], set_count, whole(0, most), recorded=False)

        def descriptor(field: str) -> Callable[[], Any]:
            info = hal.JoystickDescriptor()

            def get() -> Any:
                hs.get_joystick_descriptor(port, info)
                return getattr(info, field)

            return get

        name, gamepad = descriptor("name"), descriptor("is_gamepad")
        rumbles = hs.get_joystick_rumbles

        def rumble(index: int) -> Slot:
            def put(value: int) -> None:
                now = list(rumbles(port))
                now[index] = value
                hs.set_joystick_rumbles(port, *now)

            return Slot(lambda: rumbles(port)[index], put, whole(0, 65535))

        return {
            "axes": Slot(lambda: self.axes, None),
            "buttons": Slot(lambda: self.buttons, None),
            "povs": Slot(lambda: self.povs, None),
            "name": Slot(lambda: station.text_of(name()), partial(hs.set_joystick_name, port), text(255)),
            "is_gamepad": Slot(lambda: bool(gamepad()), partial(hs.set_joystick_is_gamepad, port), BOOL),
            "type": Slot(descriptor("gamepad_type"), partial(hs.set_joystick_gamepad_type, port), whole(0, 255)),
            "supported_outputs": Slot(
                descriptor("supported_outputs"), partial(hs.set_joystick_supported_outputs, port), whole(0, 255)
            ),
            "axis_count": count(0, hs.set_joystick_axes_available, AXES),
            "button_count": count(1, hs.set_joystick_buttons_available, station.MAX_BUTTONS),
            "pov_count": count(2, hs.set_joystick_povs_available, POVS),
            **{key: rumble(index) for index, key in enumerate(self.sent_keys[:-1])},
            "leds": Slot(lambda: hs.get_joystick_leds(port), partial(hs.set_joystick_leds, port), whole(0, 0xFFFFFF)),
            "has_source": stored(False),
        }

    def _axis(self, index: int) -> float:
        hs.get_joystick_axes(self._port, self._axes)
        return float(self._axis_values[index])

    def _load_axes(self) -> list[float]:
        hs.get_joystick_axes(self._port, self._axes)
        return self._axis_values.tolist()  # type: ignore[return-value]

    def controls(self, axes: int, buttons: int, povs: int) -> list[list[Any]]:
        """Return the axes, buttons and POVs that the robot sees: a list for each of them that it has.

        :param axes, buttons, povs: the result of `counts`
        """
        found: list[list[Any]] = []
        if axes:
            found.append(self._load_axes()[:axes])
        if buttons:
            bits = self._bits()
            found.append([bits >> index & 1 == 1 for index in range(buttons)])
        if povs:
            found.append(self._load_povs()[:povs])
        return found

    def sent_back(self) -> tuple[int, ...]:
        """Return what the robot sends back: four rumbles, and the LEDs."""
        return *hs.get_joystick_rumbles(self._port), hs.get_joystick_leds(self._port)

    def _set_axis(self, index: int, value: float) -> None:
        hs.set_joystick_axis(self._port, index, value)
        axes = self.counts()[0]
        if axes <= index:
            hs.set_joystick_axes_available(self._port, station.mask(index + 1))

    def _bits(self) -> int:
        hs.get_joystick_buttons(self._port, self._buttons)
        return self._buttons.buttons

    def _buttons_shown(self) -> int:
        return max(BUTTONS, self.counts()[1])

    def _button(self, index: int) -> bool:
        return bool(self._bits() >> index & 1)

    def _load_buttons(self) -> list[bool]:
        bits = self._bits()
        return [bool(bits >> i & 1) for i in range(self._buttons_shown())]

    def _set_button(self, index: int, value: bool) -> None:
        hs.set_joystick_button(self._port, index, value)
        if self.counts()[1] <= index:
            hs.set_joystick_buttons_available(self._port, station.mask(index + 1))

    def _pov(self, index: int) -> int:
        return self._load_povs()[index]

    def _load_povs(self) -> list[int]:
        hs.get_joystick_povs(self._port, self._povs)
        return list(map(station.angle_of, self._pov_values.tolist()))

    def _set_pov(self, index: int, value: int) -> None:
        hs.set_joystick_pov(self._port, index, station.pov_of(value))
        if self.counts()[2] <= index:
            hs.set_joystick_povs_available(self._port, station.mask(index + 1))
