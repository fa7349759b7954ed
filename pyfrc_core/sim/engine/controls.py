"""What can be done to a robot from outside: its driver station, its inputs, and its time.

Several people may drive. What one of them holds is released when that person leaves, as when a page is closed.
"""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping

from ...runtime.robot_time import PACKET_US, to_us
from ...runtime.scripts.joysticks import releases
from .commands import (
    ChooseMode,
    ChooseOpmode,
    ChosenMode,
    Command,
    EmergencyStop,
    Enable,
    Pause,
    Practice,
    Resume,
    Speed,
    Write,
    chooser_target,
)
from .options import check_speed


class Controls(ABC):
    """The driver station, the inputs and the time of one robot."""

    @abstractmethod
    def _send(self, command: Command) -> None:
        """Send a command to the robot's process."""

    def choose_mode(self, mode: ChosenMode) -> None:
        """Disable the robot, and choose the mode for when it is enabled."""
        self._send(ChooseMode(mode))

    def choose_opmode(self, name: str, mode: ChosenMode) -> None:
        """Choose the opmode of a mode, by its name; empty: none. It disables a robot in this mode."""
        self._send(ChooseOpmode(name, mode))

    def enable(self) -> None:
        """Enable the robot in the chosen mode."""
        self._send(Enable(True))

    def disable(self) -> None:
        """Disable the robot."""
        self._send(Enable(False))

    def emergency_stop(self) -> None:
        """Stop the robot. It cannot be enabled again until it is restarted."""
        self._send(EmergencyStop())

    def attach_driver_station(self, attached: bool) -> None:
        """Disconnect the driver station, or connect it again: then the robot enters the mode that is asked for."""
        self.write({"control.dsAttached": attached})

    def practice(self) -> None:
        """Begin a practice match, with the periods under ``[tool.pyfrc.match]``."""
        self._send(Practice())

    def set_alliance(self, station: str) -> None:
        """Choose an alliance station: ``red1`` to ``red3``, ``blue1`` to ``blue3``."""
        self.write({"alliance_station": station})

    def set_game_message(self, message: str) -> None:
        """Set the game data that the field sends to all robots."""
        self.write({"event.game_specific_message": message})

    def choose(self, chooser: str, option: str) -> None:
        """Choose an option of a `Chooser`; both are given by name."""
        self.write({chooser_target(chooser): option})

    # -- time -----------------------------------------------------------------------------------------------------

    def resume(self) -> None:
        """Let time go on."""
        self._send(Resume())

    def pause(self) -> None:
        """Stop time."""
        self._send(Pause())

    def step(self, packets: int = 1) -> None:
        """Let this many packets pass, 0.02 s each, then pause. The rest of an unfinished step is added."""
        self._send(Resume(packets=max(1, packets)))

    def run_for(self, seconds: float) -> None:
        """Let this many seconds of robot time pass, then pause."""
        self.step(round(to_us(seconds) / PACKET_US))

    def run_until(self, seconds: float) -> None:
        """Pause when robot time gets there."""
        self._send(Resume(until_us=to_us(seconds)))

    def set_speed(self, factor: float) -> None:
        """Set the robot seconds per second: 1 is real time, 0.1 slow motion, 0 as fast as possible."""
        check_speed(factor)
        self._send(Speed(factor))

    # -- inputs ---------------------------------------------------------------------------------------------------

    def write(self, values: Mapping[str, object]) -> None:
        """Write inputs by target, as input scripts do: ``{"dio[3].value": True, "nt:/SmartDashboard/kP": 0.1}``."""
        self._send(Write(dict(values)))

    def set_axis(self, stick: int, axis: int, value: float) -> None:
        """Move a joystick's axis, from -1 to 1."""
        self.write({f"joysticks[{stick}].axes[{axis}]": value})

    def set_button(self, stick: int, button: int, pressed: bool) -> None:
        """Press or release a joystick's button, by the number that robot code gives it."""
        self.write({f"joysticks[{stick}].buttons[{button}]": pressed})

    def set_pov(self, stick: int, pov: int, angle: int) -> None:
        """Press a joystick's POV, in degrees clockwise from up; -1 releases it."""
        self.write({f"joysticks[{stick}].povs[{pov}]": angle})

    def plug(self, stick: int, plugged_in: bool) -> None:
        """Plug a joystick in, or unplug it."""
        self.write({f"joysticks[{stick}].plugged": plugged_in})


#: Held while a driver comes or leaves: of two that leave, one is the last.
_coming_or_leaving = threading.Lock()


class Driver(Controls):
    """The controls of one person. A robot that the last person has left is disabled, as without a driver station.

    :param send: sends a command to the robot's process
    :param drivers: all who drive the same robot
    """

    def __init__(self, send: Callable[[Command], object], drivers: set[Driver]) -> None:
        self._pass_on, self._drivers = send, drivers
        #: The writes that release what is held, by target.
        self._releases: dict[str, object] = {}
        with _coming_or_leaving:
            drivers.add(self)

    def leave(self) -> None:
        """Release what is held, and disable the robot if no other driver is left."""
        if self._releases:
            self.write(self._releases)
        with _coming_or_leaving:
            self._drivers.discard(self)
            is_last = not self._drivers
        if is_last:
            self.disable()

    def _send(self, command: Command) -> None:
        if isinstance(command, Write):
            held = releases(command.writes)
            self._releases = {target: value for target, value in self._releases.items() if target not in command.writes}
            self._releases |= held
        self._pass_on(command)
