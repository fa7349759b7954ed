"""What one can tell a robot from outside: what its driver station and its inputs are to be."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any

from .commands import ChooseMode, ChosenMode, Command, EmergencyStop, Enable, Practice, Write, chosen


class Controls(ABC):
    """The driver station and the inputs of one robot."""

    @abstractmethod
    def _send(self, command: Command) -> None:
        """Have the robot's process do something."""

    def choose_mode(self, mode: ChosenMode) -> None:
        """Disable the robot, and choose what it does when it is enabled."""
        self._send(ChooseMode(mode))

    def enable(self) -> None:
        """Enable the robot in the chosen mode."""
        self._send(Enable(True))

    def disable(self) -> None:
        """Disable the robot."""
        self._send(Enable(False))

    def emergency_stop(self) -> None:
        """Stop the robot; it cannot be enabled again until it is restarted."""
        self._send(EmergencyStop())

    def attach_driver_station(self, attached: bool) -> None:
        """Lose the driver station, or attach it again: then, the mode that is asked for holds."""
        self.write({"control.dsAttached": attached})

    def practice(self) -> None:
        """Begin a practice match, with the periods under ``[tool.pyfrc.match]``."""
        self._send(Practice())

    def set_alliance(self, station: str) -> None:
        """Choose an alliance station: ``red1`` to ``red3``, ``blue1`` to ``blue3``."""
        self.write({"alliance_station": station})

    def set_game_message(self, message: str) -> None:
        """Choose what the field sends to all robots."""
        self.write({"event.game_specific_message": message})

    def choose(self, chooser: str, option: str) -> None:
        """Choose one of a `Chooser`'s options, by the names of both."""
        self.write({chosen(chooser): option})

    # -- inputs ---------------------------------------------------------------------------------------------------

    def write(self, values: Mapping[str, Any]) -> None:
        """Write inputs by target, as input scripts do: ``{"dio[3].value": True, "nt:/SmartDashboard/kP": 0.1}``."""
        self._send(Write(dict(values)))

    def set_axis(self, stick: int, axis: int, value: float) -> None:
        """Move a joystick's axis, from -1 to 1."""
        self.write({f"joysticks[{stick}].axes[{axis}]": value})

    def set_button(self, stick: int, button: int, pressed: bool) -> None:
        """Press or release a joystick's button; they count from 1."""
        self.write({f"joysticks[{stick}].buttons[{button}]": pressed})

    def set_pov(self, stick: int, pov: int, angle: int) -> None:
        """Press a joystick's POV: degrees clockwise from up; -1 releases it."""
        self.write({f"joysticks[{stick}].povs[{pov}]": angle})

    def plug(self, stick: int, plugged_in: bool) -> None:
        """Plug a joystick in, or out."""
        self.write({f"joysticks[{stick}].plugged": plugged_in})
