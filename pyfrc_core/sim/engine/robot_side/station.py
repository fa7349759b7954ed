"""The driver station: modes, a practice match, and the modes in which the robot receives joystick data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ....config.settings import MatchSettings
from ....config.sim import FieldConfig
from ....runtime.match import MatchPeriods
from ....runtime.robot import RobotRun
from ....runtime.scripts.joysticks import CONTROL, NEUTRAL
from ....wpi import station
from ..commands import ChooseMode, EmergencyStop, Enable, Practice
from ..messages import StationState

E_STOP = "control.eStop"


class Station:
    """The driver station of one run.

    :param write: writes a target, as in input scripts
    :param state: its state at the beginning
    """

    def __init__(
        self,
        run: RobotRun,
        match: MatchSettings,
        field: FieldConfig,
        write: Callable[[str, object], object],
        state: StationState,
    ) -> None:
        self._run = run
        self._periods = MatchPeriods(match)
        self._field = field
        self._write = write
        self.state = state
        #: Whether this class sets the match time: until one packet after the practice match.
        self._keeps_time = state.practice_since_us is not None
        #: The buttons and POVs that were pressed since the last packet.
        self._pressed: set[str] = set()

    def take_over(self) -> None:
        """Control the match from the next packet on; until now, the replayed script has done so."""
        self._run.clock.before_packet.append(self._on_packet)

    def choose(self, command: ChooseMode) -> None:
        """Disable the robot, and choose a mode."""
        self._end_practice()
        self._enter({"teleop": "disabled"}.get(command.mode, f"disabled {command.mode}"))

    def enable(self, command: Enable) -> str:
        """Enable or disable the robot, and return information for the user, or an empty text."""
        if not command.enabled:
            self._disable()
        elif self._run.hal_data.read(E_STOP):
            return "The robot has been stopped in an emergency: restart it to enable it again."
        elif station.get_mode() == "disabled":
            self._end_practice()
            chosen = station.mode_name().removeprefix("disabled").strip()
            self._enter(chosen or "teleop")
        return ""

    def emergency_stop(self, command: EmergencyStop) -> None:
        """Stop the robot until it is restarted."""
        self._disable()
        self._write(E_STOP, True)

    def practise(self, command: Practice) -> None:
        """Begin a practice match with the next packet."""
        self.state = replace(self.state, practice_since_us=self._run.clock.next_packet_us)

    def put(self, target: str, value: object) -> None:
        """Write an input. A joystick's control is written when the robot receives its data.

        A button that is pressed and released before the next packet is pressed for one packet, or the robot would miss
        a short press, and all the more in slow motion.
        """
        control = CONTROL.fullmatch(target)
        if control is None:
            self._write(target, value)
            return
        taps = {each: packets for each, packets in self.state.taps.items() if each != target}
        is_neutral = value == NEUTRAL[control[2]]
        if is_neutral and target in self._pressed:
            taps[target] = 1
        elif self._delivers(station.mode_name()):
            self._write(target, value)
            if not is_neutral and control[2] != "axes":
                self._pressed.add(target)
        # Kept after the write, which fails for a wrong value; a value that is not delivered now is checked later.
        self.state = replace(self.state, sticks={**self.state.sticks, target: value}, taps=taps)

    def _disable(self) -> None:
        self._end_practice()
        mode = station.mode_name()
        if not mode.startswith("disabled"):
            self._enter("disabled" if mode == "teleop" else f"disabled {mode}")

    def _enter(self, mode: str) -> None:
        before, after = self._delivers(station.mode_name()), self._delivers(mode)
        self._write("mode", mode)
        if before != after:
            for target, value in self.state.sticks.items():
                control = CONTROL.fullmatch(target)
                if control is not None:
                    self._write(target, value if after else NEUTRAL[control[2]])

    def _delivers(self, mode: str) -> bool:
        if mode.startswith("disabled"):
            return self._field.disabled_joysticks
        return mode != "autonomous" or self._field.auto_joysticks

    def _end_practice(self) -> None:
        if self.state.practice_since_us is not None:
            self.state = replace(self.state, practice_since_us=None)

    def _on_packet(self, now: float) -> None:
        self._pressed.clear()
        practises = self.state.practice_since_us is not None or self._keeps_time
        if not practises and not self.state.taps:
            return
        recorder = self._run.recorder
        if recorder is not None:
            recorder.begin_outside(stepping=True)
        self._release_taps()
        if practises:
            self._go_on_with_practice()
        if recorder is not None:
            recorder.end_outside(stepping=True)

    def _release_taps(self) -> None:
        """Release the controls that the robot has seen pressed in the last packet."""
        for target, packets in self.state.taps.items():
            control = CONTROL.fullmatch(target)
            if packets == 0 and control is not None and self._delivers(station.mode_name()):
                self._write(target, NEUTRAL[control[2]])
        self.state = replace(self.state, taps={each: 0 for each, packets in self.state.taps.items() if packets})

    def _go_on_with_practice(self) -> None:
        since = self.state.practice_since_us
        self._keeps_time = since is not None
        period = None if since is None else self._periods.at(self._run.clock.now_us - since)
        mode, left = period or ("disabled", 0.0)
        if since is not None:
            if mode != station.mode_name():
                self._enter(mode)
            station.set_match_time(left)
        if period is None:
            self._end_practice()
