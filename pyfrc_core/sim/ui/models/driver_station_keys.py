"""What each key does: the Driver Station's keys, the keys of robot time, and the keys that drive.

A front end passes on which keys go down and up. Filtering a keyboard's automatic repeat is up to it.
"""

from __future__ import annotations

from collections.abc import Callable

from ...engine.simulation import Simulation
from .joysticks import Joysticks
from .keyboard import Control, KeyDriver, KeyLayout, canonical, layout_for
from .time_controls import toggle

#: The keys in a few words, for a front end to show.
SUMMARY = "Ctrl+E or [ ] \\  enable   Enter  disable   Space  e-stop   F5  pause   F6  step"

#: Held keys act once, but these act again with each repeat of the keyboard.
REPEATING = frozenset({"f6"})


class DriverStationKeys:
    """Acts on keys, by their names in `keyboard`.

    :param close: closes the front end
    """

    def __init__(self, simulation: Simulation, sticks: Joysticks, close: Callable[[], object]) -> None:
        self._simulation, self._sticks = simulation, sticks
        self._driver = KeyDriver(layout_for(simulation.project.sim_config))
        self._axes: dict[Control, float] = {}
        self._buttons: dict[Control, bool] = {}
        self._actions = {
            "return": simulation.disable,
            "kp_enter": simulation.disable,
            "space": simulation.emergency_stop,
            "f5": lambda: toggle(simulation),
            "f6": simulation.step,
            "f9": simulation.restart,
            "f8": self._toggle_connection,
        }
        self._with_control: dict[str, Callable[[], object]] = {"e": simulation.enable, "q": close}

    @property
    def layout(self) -> KeyLayout:
        """The layout of the keys that drive."""
        return self._driver.layout

    @layout.setter
    def layout(self, layout: KeyLayout) -> None:
        self._driver.layout = layout
        self._move()

    def press(self, key: str, control: bool = False) -> None:
        """Act on a key that goes down.

        :param control: whether the Ctrl key is held
        """
        key = canonical(key)
        actions = self._with_control if control else self._actions
        if (act := actions.get(key)) is not None:
            act()
        elif not control:
            asked = self._driver.asks_to_enable
            self._driver.press(key)
            if self._driver.asks_to_enable and not asked:
                self._simulation.enable()
            self._move()

    def release(self, key: str) -> None:
        """Act on a key that goes up."""
        self._driver.release(key)
        self._move()

    def release_all(self) -> None:
        """Release all keys, as when another window gets them."""
        self._driver.release_all()
        self._move()

    def forget(self) -> None:
        """Pass on what is held again: the robot was restarted, and knows nothing of it."""
        self._axes, self._buttons = {}, {}
        self._move()

    def _toggle_connection(self) -> None:
        snapshot = self._simulation.snapshot
        if snapshot is not None:
            self._simulation.attach_driver_station(not snapshot.station_attached)

    def _move(self) -> None:
        """Move the axes and press the buttons that the held keys have changed."""
        axes, buttons = self._driver.axes(), self._driver.buttons()
        for control in axes.keys() | self._axes.keys():
            value = axes.get(control, 0.0)
            if value != self._axes.get(control, 0.0):
                self._sticks.move(*control, value)
        for control, pressed in buttons.items():
            if pressed != self._buttons.get(control, False):
                self._sticks.press(*control, pressed)
        self._axes, self._buttons = axes, buttons
