"""The data that the driver station sends: mode, alliance, match, joysticks; and the rumble that the robot sends back.

A write is visible here at once. The robot sees it with the next driver-station packet, as with a real one.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import hal
from hal import simulation as hs
from wpilib import DriverStation
from wpilib.simulation import DriverStationSim

from ...wpi import station
from ..containers import LiveDict, LiveList, Slot, stored
from ..joystick_lists import JoystickLists
from ..kinds import BOOL, INT32, choice, text, whole
from ..paths import join

AXES = POVS = 12  # the maximum of the HAL
BUTTONS = 12  # the shortest list; a joystick with more buttons shows all

MATCH_TYPE = choice({"none": 0, "practice": 1, "qualification": 2, "elimination": 3}, DriverStation.MatchType)


class EventData(LiveDict):
    """The match, as sent by the field."""

    #: The keys of `plain_values`.
    recorded = ("name", "match_type", "match_number", "replay_number", "game_specific_message")

    def __init__(self) -> None:
        super().__init__("event", self._all)
        self._info = hal.MatchInfo()

    def plain_values(self) -> list[Any]:
        """Return the values of `recorded`."""
        info = self._info
        hs.getMatchInfo(info)
        return [
            _c_text(info.eventName),
            int(info.matchType),
            info.matchNumber,
            info.replayNumber,
            self._message(),
        ]

    def _message(self) -> str:
        info = self._info
        return info.gameSpecificMessage.tobytes()[: info.gameSpecificMessageSize].decode(errors="replace")

    def _all(self) -> dict[str, Slot]:
        info, sim, named = self._info, DriverStationSim, MATCH_TYPE.load or int

        def get(read: Callable[[], Any]) -> Callable[[], Any]:
            def current() -> Any:
                hs.getMatchInfo(info)
                return read()

            return current

        return {
            "name": Slot(get(lambda: _c_text(info.eventName)), sim.setEventName, text(63)),
            "match_type": Slot(get(lambda: named(info.matchType)), sim.setMatchType, MATCH_TYPE),
            "match_number": Slot(get(lambda: info.matchNumber), sim.setMatchNumber, whole(0, 65535)),
            "replay_number": Slot(get(lambda: info.replayNumber), sim.setReplayNumber, whole(0, 255)),
            "game_specific_message": Slot(get(self._message), sim.setGameSpecificMessage, text(64)),
            "has_source": stored(False),
        }


def _c_text(characters: memoryview) -> str:
    return characters.tobytes().partition(b"\0")[0].decode(errors="replace")


def joysticks() -> LiveList:
    """Return the joysticks, by port."""
    return LiveList("joysticks", [JoystickData(port) for port in range(station.JOYSTICKS)])


class JoystickData(JoystickLists):
    """One joystick: its axes, buttons and POVs as sent to the robot, and the data that the robot sends back.

    The robot sees `axis_count` axes, `button_count` buttons and `pov_count` POVs; writing a later one raises its count.
    Values are read from WPILib's buffer, so an axis has the precision of a C float.
    """

    #: The keys of `sent_back`.
    sent_keys = ("outputs", "left_rumble", "right_rumble")

    def __init__(self, port: int) -> None:
        super().__init__(join("joysticks", port), self._all, AXES, POVS)
        self._port = port
        self._unused_button = False
        self._axes, self._buttons, self._povs = hal.JoystickAxes(), hal.JoystickButtons(), hal.JoystickPOVs()
        # Both are views of the buffers above, which each read fills again.
        self._axis_values, self._pov_values = self._axes.axes, self._povs.povs

    def counts(self) -> tuple[int, int, int]:
        """Return how many axes, buttons and POVs the robot sees."""
        return hs.getJoystickCounts(self._port)

    def _all(self) -> dict[str, Slot]:
        port = self._port

        def count(index: int, put: Callable[[int, int], object], most: int) -> Slot:
            return Slot(lambda: self.counts()[index], partial(put, port), whole(0, most), recorded=False)

        def descriptor(field: str) -> Callable[[], Any]:
            info = hal.JoystickDescriptor()

            def get() -> Any:
                hs.getJoystickDescriptor(port, info)
                return getattr(info, field)

            return get

        name, xbox = descriptor("name"), descriptor("isXbox")
        outputs = hs.getJoystickOutputs

        def rumble(index: int) -> Slot:
            def put(value: int) -> None:
                now = list(outputs(port))
                now[index] = value
                hs.setJoystickOutputs(port, *now)

            return Slot(lambda: outputs(port)[index], put, INT32 if index == 0 else whole(0, 65535))

        return {
            "axes": Slot(lambda: self.axes, None),
            "buttons": Slot(lambda: self.buttons, None),
            "povs": Slot(lambda: self.povs, None),
            "name": Slot(lambda: _c_text(name()), partial(hs.setJoystickName, port), text(255)),
            "is_xbox": Slot(lambda: bool(xbox()), partial(hs.setJoystickIsXbox, port), BOOL),
            "type": Slot(descriptor("type"), partial(hs.setJoystickType, port), whole(0, 255)),
            "axis_count": count(0, hs.setJoystickAxisCount, AXES),
            "button_count": count(1, hs.setJoystickButtonCount, station.MAX_BUTTONS),
            "pov_count": count(2, hs.setJoystickPOVCount, POVS),
            "outputs": rumble(0),
            "left_rumble": rumble(1),
            "right_rumble": rumble(2),
            "has_source": stored(False),
        }

    def _axis(self, index: int) -> float:
        hs.getJoystickAxes(self._port, self._axes)
        return float(self._axis_values[index])

    def _load_axes(self) -> list[float]:
        hs.getJoystickAxes(self._port, self._axes)
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
            found.append([False, *[bits >> index & 1 == 1 for index in range(buttons)]])
        if povs:
            found.append(self._load_povs()[:povs])
        return found

    def sent_back(self) -> tuple[int, int, int]:
        """Return what the robot sends back: the outputs' bits, the left and the right rumble."""
        return hs.getJoystickOutputs(self._port)

    def _set_axis(self, index: int, value: float) -> None:
        hs.setJoystickAxis(self._port, index, value)
        if self.counts()[0] <= index:
            hs.setJoystickAxisCount(self._port, index + 1)

    def _bits(self) -> int:
        hs.getJoystickButtons(self._port, self._buttons)
        return self._buttons.buttons

    def _buttons_shown(self) -> int:
        return 1 + max(BUTTONS, self.counts()[1])

    def _button(self, index: int) -> bool:
        return bool(self._bits() >> (index - 1) & 1) if index else self._unused_button

    def _load_buttons(self) -> list[bool]:
        # Position 0 is unused, so the bits move up by one.
        bits = self._bits() << 1 | self._unused_button
        return [bool(bits >> i & 1) for i in range(self._buttons_shown())]

    def _set_button(self, index: int, value: bool) -> None:
        if index == 0:
            # Buttons count from 1, as in WPILib. Loops over the whole list also write position 0, which the robot
            # cannot see.
            self._unused_button = value
            return
        hs.setJoystickButton(self._port, index, value)
        if self.counts()[1] < index:
            hs.setJoystickButtonCount(self._port, index)

    def _pov(self, index: int) -> int:
        return self._load_povs()[index]

    def _load_povs(self) -> list[int]:
        # Beyond the count, the HAL has 0, which means "up"; the robot sees "not pressed".
        hs.getJoystickPOVs(self._port, self._povs)
        values: list[int] = self._pov_values.tolist()
        count = self._povs.count
        return values[:count] + [-1] * (POVS - count)

    def _set_pov(self, index: int, value: int) -> None:
        count = self.counts()[2]
        if count <= index:
            for skipped in range(count, index):
                hs.setJoystickPOV(self._port, skipped, -1)
            hs.setJoystickPOVCount(self._port, index + 1)
        hs.setJoystickPOV(self._port, index, value)
