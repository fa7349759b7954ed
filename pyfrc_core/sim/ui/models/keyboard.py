"""Driving by the keyboard: which keys move which axes and press which buttons.

Key names are Tk's keysyms, in lower case.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ....season import CURRENT

if TYPE_CHECKING:
    from ....config.sim import SimConfig

#: A joystick and one of its axes, or one of its buttons.
Control = tuple[int, int]

#: The distance that a key moves an axis while Shift is held.
GENTLE = 0.4

_SHIFTS = frozenset({"shift_l", "shift_r"})

#: All three at once enable the robot, as on the Driver Station.
ENABLE_CHORD = frozenset({"bracketleft", "bracketright", "backslash"})

#: The names of keys that are held with Shift, on keyboards of the United States.
_SHIFTED = dict(zip(("exclam", "at", "numbersign", "dollar", "percent", "asciicircum", "ampersand", "asterisk",
                     "parenleft", "parenright"), "1234567890", strict=True))  # fmt: skip


@dataclass(frozen=True)
class KeyLayout:
    """An assignment of keys.

    :param name: its name for the user
    :param help: the keys in a few words
    :param axes: the distance that each key moves axes
    """

    name: str
    help: str
    axes: Mapping[str, Mapping[Control, float]]


def _pair(left: str, right: str, control: Control) -> dict[str, dict[Control, float]]:
    return {left: {control: -1.0}, right: {control: 1.0}}


def _of_gamepad(axis: str) -> Control:
    return 0, CURRENT.gamepad.axes.index(axis)


# On a joystick, forwards and to the left are negative.
_LEFT, _RIGHT = (0, 1), (1, 1)

LAYOUTS = (
    KeyLayout(
        "Tank: both sides",
        "W S drive, A D turn (Y of joysticks 0 and 1)",
        {
            "w": {_LEFT: -1.0, _RIGHT: -1.0},
            "s": {_LEFT: 1.0, _RIGHT: 1.0},
            "a": {_LEFT: 0.6, _RIGHT: -0.6},
            "d": {_LEFT: -0.6, _RIGHT: 0.6},
            **_pair("up", "down", _RIGHT),
        },
    ),
    KeyLayout(
        "Two joysticks",
        "WASD: joystick 0, Q E: its twist; arrows: joystick 1",
        {
            **_pair("a", "d", (0, 0)),
            **_pair("w", "s", (0, 1)),
            **_pair("q", "e", (0, 2)),
            **_pair("left", "right", (1, 0)),
            **_pair("up", "down", (1, 1)),
        },
    ),
    KeyLayout(
        "Gamepad",
        "WASD: left stick of 0, arrows: right stick, Q E: triggers",
        {
            **_pair("a", "d", (0, 0)),
            **_pair("w", "s", (0, 1)),
            "q": {_of_gamepad("left_trigger"): 1.0},
            "e": {_of_gamepad("right_trigger"): 1.0},
            **_pair("left", "right", _of_gamepad("right_x")),
            **_pair("up", "down", _of_gamepad("right_y")),
        },
    ),
)


def layout_for(config: SimConfig) -> KeyLayout:
    """Return the layout for a robot: the axes of joystick 0 that it labels show which kind of joystick it uses."""
    tank, joysticks, gamepad = LAYOUTS
    named = config.joysticks[0].axes.keys() if 0 in config.joysticks else set()
    if named & {4, 5}:
        return gamepad
    return joysticks if named & {0, 2} else tank


#: The keys of the first joystick's buttons, and the same as a text. Where buttons count from 1, the key 0 is button 10.
BUTTON_KEYS = {str(number % 10): number for number in range(CURRENT.first_button, CURRENT.first_button + 10)}
BUTTON_KEYS_TEXT = "0 to 9" if CURRENT.first_button == 0 else "1 to 9, 0"


def canonical(keysym: str) -> str:
    """Return a key's name, without the effect of Shift and Caps Lock."""
    return _SHIFTED.get(keysym, keysym.lower())


class KeyDriver:
    """The keys that are held, and the axes and buttons that follow from them."""

    def __init__(self, layout: KeyLayout = LAYOUTS[0]) -> None:
        self.layout = layout
        self.held: set[str] = set()

    def press(self, keysym: str) -> None:
        self.held.add(canonical(keysym))

    def release(self, keysym: str) -> None:
        self.held.discard(canonical(keysym))

    def release_all(self) -> None:
        """Release all keys, as when another window gets them."""
        self.held.clear()

    @property
    def asks_to_enable(self) -> bool:
        """Whether the keys that enable the robot are held."""
        return self.held >= ENABLE_CHORD

    def axes(self) -> dict[Control, float]:
        """Return the positions of all axes that a key of the layout moves."""
        far = GENTLE if self.held & _SHIFTS else 1.0
        moved: dict[Control, float] = {}
        for key, moves in self.layout.axes.items():
            for control, by in moves.items():
                moved[control] = moved.get(control, 0.0) + (by * far if key in self.held else 0.0)
        return {control: min(max(value, -1.0), 1.0) for control, value in moved.items()}

    def buttons(self) -> dict[Control, bool]:
        """Return which buttons are pressed."""
        return {(0, button): key in self.held for key, button in BUTTON_KEYS.items()}
