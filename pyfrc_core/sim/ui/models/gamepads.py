"""Real gamepads, by way of pygame-ce: the extra ``gamepads``.

SDL, on which pygame is built, knows the layouts of most gamepads. Their axes and buttons get the order of the Driver
Station, so that robot code finds them; those of other gamepads have the order of the device.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from ...._version import requirement
from ....season import CURRENT
from .joysticks import FIRST_BUTTON, JOYSTICKS, MOST_BUTTONS, RELEASED, Sticks

HINT = f'For real gamepads: pip install "{requirement("gamepads")}"'

_HATS = {(0, 1): 0, (1, 1): 45, (1, 0): 90, (1, -1): 135, (0, -1): 180, (-1, -1): 225, (-1, 0): 270, (-1, 1): 315}

#: SDL's names, in the Driver Station's order.
_SDL_AXES = tuple(
    {"left_trigger": "TRIGGERLEFT", "right_trigger": "TRIGGERRIGHT"}.get(name, name.replace("_", "").upper())
    for name in CURRENT.gamepad.axes
)
_SDL_BUTTONS = tuple(
    f"DPAD_{name.upper()}" if name in ("up", "down", "left", "right") else name.replace("_", "").upper()
    for name in (each.replace("bumper", "shoulder") for each in CURRENT.gamepad.buttons)
)

#: The smallest movement that is passed on.
_STEP = 0.01


@dataclass(frozen=True)
class Reading:
    """The state of a gamepad's controls; the buttons begin with the first."""

    axes: tuple[float, ...] = ()
    buttons: tuple[bool, ...] = ()
    pov: int = RELEASED


class Gamepad(Protocol):
    """One real gamepad."""

    name: str

    def read(self) -> Reading:
        """Return the state of its controls."""
        ...


class GamepadBackend(Protocol):
    """A source of gamepads, which can be plugged in and out."""

    def look(self) -> Sequence[Gamepad]:
        """Return the gamepads that are plugged in."""
        ...


def hat_angle(x: int, y: int) -> int:
    """Return a POV's angle from how its hat is pressed: to the right, and up; -1 and 1 are the limits."""
    return _HATS.get((x, y), RELEASED)


class GamepadRouter:
    """Moves joysticks by gamepads: joystick 0 by the first gamepad and so on, unless the user assigns others."""

    def __init__(self, backend: GamepadBackend, sticks: Sticks) -> None:
        self._backend, self._sticks = backend, sticks
        self._passed_on: dict[int, Reading] = {}
        #: The number of each joystick's gamepad; None: no gamepad.
        self.assigned: dict[int, int | None] = {}
        self.names: tuple[str, ...] = ()

    def poll(self) -> None:
        """Pass on what has moved."""
        pads = self._backend.look()
        self.names = tuple(pad.name for pad in pads)
        for stick in range(JOYSTICKS):
            number = self.assigned.get(stick, stick)
            reading = pads[number].read() if number is not None and number < len(pads) else None
            before = self._passed_on.get(stick)
            if reading is None:
                if before is not None:  # unplugged, or assigned to another
                    self._pass_on(stick, before, Reading((0.0,) * len(before.axes), (False,) * len(before.buttons)))
                    del self._passed_on[stick]
            else:
                self._passed_on[stick] = self._pass_on(stick, before, reading)

    def forget(self) -> None:
        """Pass everything on again: the robot was restarted, and knows nothing of it."""
        self._passed_on.clear()

    def _pass_on(self, stick: int, before: Reading | None, now: Reading) -> Reading:
        before = before or Reading()
        axes = list(now.axes[:12])
        for axis, value in enumerate(axes):
            old = before.axes[axis] if axis < len(before.axes) else 0.0
            if abs(value - old) >= _STEP or (value != old and value in (-1.0, 0.0, 1.0)):
                self._sticks.move(stick, axis, value)
            else:
                axes[axis] = old
        for index, pressed in enumerate(now.buttons[:MOST_BUTTONS]):
            if pressed != (index < len(before.buttons) and before.buttons[index]):
                self._sticks.press(stick, FIRST_BUTTON + index, pressed)
        if now.pov != before.pov:
            self._sticks.turn(stick, now.pov)
        return Reading(tuple(axes), now.buttons, now.pov)


class _Pad:
    def __init__(self, name: str, read: Callable[[], Reading]) -> None:
        self.name, self.read = name, read


class PygameBackend:
    """The gamepads that pygame knows."""

    def __init__(self) -> None:
        # SDL has no window of its own, so gamepads are read while it is in the background.
        os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
        os.environ.setdefault("SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS", "1")
        os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
        # Imported by string: the extra may be missing where types are checked.
        self._pygame: Any = importlib.import_module("pygame")
        self._controllers: Any = importlib.import_module("pygame._sdl2.controller")
        self._pygame.display.init()
        self._pygame.joystick.init()
        self._controllers.init()
        self._pads: list[Gamepad] = []
        self._count = -1

    def look(self) -> Sequence[Gamepad]:
        self._pygame.event.pump()
        changes = self._pygame.event.get((self._pygame.JOYDEVICEADDED, self._pygame.JOYDEVICEREMOVED))
        if changes or self._count != self._pygame.joystick.get_count():
            self._count = self._pygame.joystick.get_count()
            self._pads = [self._open(number) for number in range(self._count)]
        self._pygame.event.clear()
        return self._pads

    def _open(self, number: int) -> Gamepad:
        if self._controllers.is_controller(number):
            pad = self._controllers.Controller(number)
            return _Pad(pad.name or f"Gamepad {number}", lambda: self._read_known(pad))
        joystick = self._pygame.joystick.Joystick(number)
        return _Pad(joystick.get_name(), lambda: _read_raw(joystick))

    def _read_known(self, pad: Any) -> Reading:
        pg = self._pygame
        up, right, down, left = (
            bool(pad.get_button(getattr(pg, f"CONTROLLER_BUTTON_DPAD_{way}")))
            for way in ("UP", "RIGHT", "DOWN", "LEFT")
        )
        return Reading(
            tuple(max(pad.get_axis(getattr(pg, f"CONTROLLER_AXIS_{name}")) / 32767, -1.0) for name in _SDL_AXES),
            tuple(bool(pad.get_button(getattr(pg, f"CONTROLLER_BUTTON_{name}"))) for name in _SDL_BUTTONS),
            hat_angle(right - left, up - down),
        )


def _read_raw(joystick: Any) -> Reading:
    return Reading(
        tuple(max(min(joystick.get_axis(axis), 1.0), -1.0) for axis in range(joystick.get_numaxes())),
        tuple(bool(joystick.get_button(button)) for button in range(joystick.get_numbuttons())),
        hat_angle(*joystick.get_hat(0)) if joystick.get_numhats() else RELEASED,
    )


def open_backend() -> GamepadBackend | None:
    """Return this machine's gamepads; None without pygame."""
    return PygameBackend() if importlib.util.find_spec("pygame") is not None else None
