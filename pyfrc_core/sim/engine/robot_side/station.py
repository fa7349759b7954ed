"""The driver station: modes, a practice match, and the modes in which the robot receives joystick data."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import cast

from ....config.settings import MatchSettings
from ....config.sim import FieldConfig
from ....errors import UsageError
from ....runtime.match import MatchPeriods
from ....runtime.robot import RobotRun
from ....runtime.scripts.joysticks import CONTROL, NEUTRAL
from ....runtime.scripts.modes import mode_name
from ....runtime.scripts.script import InputScript
from ....runtime.scripts.targets import MODE, OPMODE
from ....wpi import station
from ..commands import ChooseMode, ChooseOpmode, ChosenMode, EmergencyStop, Enable, Practice, chosen_mode
from ..messages import StationState
from ..snapshot import Opmode

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

    def carry_out(self, command: object) -> str:
        """Carry out a command for the driver station, and return information for the user, or an empty text."""
        match command:
            case ChooseMode():
                self._choose(command.mode)
            case ChooseOpmode():
                return self._choose_opmode(command)
            case Enable():
                return self._enable(command)
            case EmergencyStop():
                self._disable()
                self._write(E_STOP, True)
            case Practice():
                self.state = replace(self.state, practice_since_us=self._run.clock.next_packet_us)
        return ""

    def _choose(self, mode: ChosenMode) -> None:
        """Disable the robot, and choose a mode."""
        self._end_practice()
        self._enter(mode_name(False, mode))

    def _choose_opmode(self, command: ChooseOpmode) -> str:
        mode, name = command.mode, command.name
        published = self._published(mode)
        if name and name not in published:
            there = ", ".join(map(repr, published)) or "none"
            return f"There is no opmode {name!r} for {mode}: the robot has published {there}."
        self.state = replace(self.state, opmodes={**self.state.opmodes, mode: name})
        if mode == chosen_mode(station.mode_name()):
            self._disable()
            self._select_opmode(mode)
        return ""

    def opmodes(self) -> tuple[Opmode, ...]:
        """Return the opmodes that the robot has published: in each mode by group and name."""
        found = [
            Opmode(each.name, cast(ChosenMode, each.mode), each.group, each.description)
            for each in station.published_opmodes()
        ]
        return tuple(sorted(found, key=lambda each: (each.mode, each.group, each.name)))

    def connect(self, script: InputScript, opmodes: Iterable[str]) -> None:
        """Control the match from the next packet on. If nothing has been selected yet, select an opmode.

        :param script: what has controlled the match until now
        :param opmodes: the names of opmodes to choose, each for its mode; the mode of the first one becomes the robot's
        :raises UsageError: when the robot has published no such opmode
        """
        self._run.clock.before_packet.append(self._on_packet)
        if any({MODE, OPMODE} & step.writes.keys() for step in script.steps):
            return
        published, found = self.opmodes(), []
        for name in opmodes:
            modes = [each.mode for each in published if each.name == name]
            if not modes:
                there = ", ".join(repr(each.name) for each in published) or "none"
                raise UsageError(
                    f"there is no opmode {name!r}: the robot has published {there}", remedy="--opmode names one."
                )
            found += [ChooseOpmode(name, mode) for mode in modes]
        for choice in found:
            self._choose_opmode(choice)
        if found:
            self._choose(found[0].mode)
        else:
            self._select_opmode(chosen_mode(station.mode_name()))

    def _enable(self, command: Enable) -> str:
        if not command.enabled:
            self._disable()
        elif self._run.hal_data.read(E_STOP):
            return "The robot has been stopped in an emergency: restart it to enable it again."
        elif station.get_mode() == "disabled":
            self._end_practice()
            self._enter(chosen_mode(station.mode_name()))
        return ""

    def put(self, target: str, value: object) -> None:
        """Write an input. A joystick's control is checked at once, and written when the robot receives its data.

        A button that is pressed and released before the next packet is pressed for one packet, or the robot would miss
        a short press, and all the more in slow motion.
        """
        control = CONTROL.fullmatch(target)
        if control is None:
            self._write(target, value)
            return
        controls, number = self._run.hal_data.locate(target)
        controls.check(number, value)
        taps = {each: packets for each, packets in self.state.taps.items() if each != target}
        is_neutral = value == NEUTRAL[control[2]]
        if is_neutral and target in self._pressed:
            taps[target] = 1
        elif self._delivers(station.mode_name()):
            self._write(target, value)
            if not is_neutral and control[2] != "axes":
                self._pressed.add(target)
        self.state = replace(self.state, sticks={**self.state.sticks, target: value}, taps=taps)

    def _disable(self) -> None:
        self._end_practice()
        mode = station.mode_name()
        if not mode.startswith("disabled"):
            self._enter(mode_name(False, mode))

    def _enter(self, mode: str) -> None:
        before, after = self._delivers(station.mode_name()), self._delivers(mode)
        self._write(MODE, mode)
        self._select_opmode(chosen_mode(mode))
        if before != after:
            for target, value in self.state.sticks.items():
                control = CONTROL.fullmatch(target)
                if control is not None:
                    self._write(target, value if after else NEUTRAL[control[2]])

    def _select_opmode(self, mode: ChosenMode) -> None:
        """Select the opmode that is chosen for this mode, which is the robot's; by default the first one."""
        published, chosen = self._published(mode), self.state.opmodes.get(mode)
        if chosen is None or chosen not in {"", *published}:  # a script has selected one, or none was
            chosen = station.opmode_name() or next(iter(published), "")
        if chosen != station.opmode_name():
            self._write(OPMODE, chosen)

    def _published(self, mode: ChosenMode) -> list[str]:
        return [each.name for each in self.opmodes() if each.mode == mode]

    def _delivers(self, mode: str) -> bool:
        if mode.startswith("disabled"):
            return self._field.disabled_joysticks
        return mode != "autonomous" or self._field.auto_joysticks

    def _end_practice(self) -> None:
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
        mode: str
        mode, left = period or ("disabled", 0.0)
        if since is not None:
            if self._published("autonomous") and self._periods.is_before_autonomous(self._run.clock.now_us - since):
                mode = "disabled autonomous"  # as on a field: so the opmode for autonomous is made before it
            if mode != station.mode_name():
                self._enter(mode)
            station.set_match_time(left)
        if period is None:
            self._end_practice()
