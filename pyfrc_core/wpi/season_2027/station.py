"""The driver station: what it sends, packets, and what the robot program has taken in of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeAlias

import hal
import wpilib.testing
from hal.simulation import (
    get_driver_station_ds_attached,
    get_driver_station_e_stop,
    get_driver_station_enabled,
    get_driver_station_match_time,
    get_driver_station_opmode,
    get_joystick_availables,
    get_program_started,
    notify_driver_station_new_data,
    reset_driver_station_data,
    set_driver_station_ds_attached,
    set_driver_station_enabled,
    set_driver_station_match_time,
    set_event_name,
    set_game_data_string,
    set_joystick_axes_available,
    set_joystick_axis,
    set_joystick_buttons_available,
    set_joystick_buttons_value,
    set_joystick_pov,
    set_joystick_povs_available,
)
from wpilib import DriverStationBackend, RobotState
from wpilib.simulation import DriverStationSim

from ...errors import UsageError
from ..opmodes import MODES as MODES_OF_OPMODES
from ..opmodes import OpmodeOfTests, PublishedOpmode, no_opmode

#: The four modes that `TestController.get_mode` returns; "test" is WPILib's utility mode.
Mode: TypeAlias = Literal["disabled", "autonomous", "teleop", "test"]

JOYSTICKS = DriverStationBackend.JOYSTICK_PORTS
#: As in 2019.
EVENT_NAME = "sim-event"
#: The default controls of each joystick: as many as a robot may read, of a joystick or a gamepad.
AXES, BUTTONS, POVS = 12, len(wpilib.Gamepad.Button.__members__), 1
#: The key in `hal_data` of what the driver station says of a gamepad.
GAMEPAD_FLAG = "is_gamepad"
#: The value of a POV that is not pressed; when pressed, it is an angle in degrees clockwise from up.
NOT_PRESSED = -1
#: The most buttons that a joystick can have.
MAX_BUTTONS = 64

RobotMode = hal.RobotMode
JoystickPOV = hal.JoystickPOV

#: Deliver the driver station's current data to the robot as the next packet.
deliver_packet = notify_driver_station_new_data

#: Have the robot program take in the last packet, as its loop does.
refresh = DriverStationBackend.refresh_data


def reset_driver_station() -> None:
    """Set the initial data of the driver station: attached, disabled, red 1, six joysticks with nothing pressed."""
    reset_driver_station_data()
    _chosen.clear()
    set_driver_station_ds_attached(True)
    DriverStationSim.set_robot_mode(RobotMode.TELEOPERATED)
    DriverStationSim.set_alliance_station_id(hal.AllianceStationID.RED_1)
    set_event_name(EVENT_NAME)
    set_game_data_string("")  # a reset leaves it
    for stick in range(JOYSTICKS):
        plug_in(stick)


def plug_in(stick: int) -> None:
    """Plug in a joystick with nothing pressed."""
    _set_counts(stick, AXES, BUTTONS, POVS)
    for axis in range(AXES):
        set_joystick_axis(stick, axis, 0.0)
    set_joystick_buttons_value(stick, 0)
    for pov in range(POVS):
        set_joystick_pov(stick, pov, JoystickPOV.CENTERED)


def unplug(stick: int) -> None:
    """Unplug a joystick: it has no axes, buttons and POVs."""
    _set_counts(stick, 0, 0, 0)


def counts(stick: int) -> tuple[int, int, int]:
    """Return how many axes, buttons and POVs a joystick has: up to the last that is available."""
    axes, buttons, povs = get_joystick_availables(stick)
    return axes.bit_length(), buttons.bit_length(), povs.bit_length()


def _set_counts(stick: int, axes: int, buttons: int, povs: int) -> None:
    set_joystick_axes_available(stick, mask(axes))
    set_joystick_buttons_available(stick, mask(buttons))
    set_joystick_povs_available(stick, mask(povs))


def mask(count: int) -> int:
    """Return the mask that says that so many controls are available."""
    return (1 << count) - 1


#: WPILib's POVs, by the angle in degrees.
_POVS = {
    NOT_PRESSED: JoystickPOV.CENTERED,
    0: JoystickPOV.UP,
    45: JoystickPOV.RIGHT_UP,
    90: JoystickPOV.RIGHT,
    135: JoystickPOV.RIGHT_DOWN,
    180: JoystickPOV.DOWN,
    225: JoystickPOV.LEFT_DOWN,
    270: JoystickPOV.LEFT,
    315: JoystickPOV.LEFT_UP,
}
_ANGLES = {int(pov): angle for angle, pov in _POVS.items()}


def pov_of(angle: int) -> JoystickPOV:
    """Return WPILib's value of a POV: of the direction that is nearest to an angle in degrees."""
    return _POVS[NOT_PRESSED if angle < 0 else round(angle / 45) % 8 * 45]


def angle_of(pov: int) -> int:
    """Return the angle in degrees of WPILib's value of a POV; `NOT_PRESSED` for opposite directions at once."""
    return _ANGLES.get(pov, NOT_PRESSED)


#: The opmode that is chosen for each mode, by the number of the mode: what a driver station sends is that of the mode.
_chosen: dict[int, int] = {}


def set_mode(*, autonomous: bool = False, test: bool = False, enabled: bool) -> None:
    """Set the mode of the next driver-station packet."""
    mode = RobotMode.AUTONOMOUS if autonomous else RobotMode.UTILITY if test else RobotMode.TELEOPERATED
    send_mode(mode)
    set_driver_station_enabled(enabled)


def send_mode(mode: RobotMode) -> None:
    """Set the robot's mode for the next packet, with the opmode that is chosen for it."""
    DriverStationSim.set_robot_mode(mode)
    DriverStationSim.set_opmode(_chosen.get(int(mode), 0))


def sends(mode: RobotMode) -> bool:
    """Return whether this was last set as the robot's mode."""
    return DriverStationSim.get_robot_mode() == mode


def get_mode() -> Mode:
    """Return the mode that was last set, even if no packet has delivered it to the robot yet."""
    if not get_driver_station_enabled():
        return "disabled"
    mode = DriverStationSim.get_robot_mode()
    if mode == RobotMode.AUTONOMOUS:
        return "autonomous"
    return "test" if mode == RobotMode.UTILITY else "teleop"


#: The modes of scripts: those that the robot can be in, and the disabled modes before them.
_NAMED = {
    "disabled": (False, False, False),
    "autonomous": (True, False, True),
    "teleop": (False, False, True),
    "test": (False, True, True),
    "disabled autonomous": (True, False, False),
    "disabled test": (False, True, False),
}
MODES = tuple(_NAMED)


def set_mode_named(name: str) -> None:
    """Set one of `MODES`.

    :raises UsageError: when there is no such mode
    """
    if name not in _NAMED:
        raise UsageError(f"there is no mode {name!r}: the modes are {', '.join(MODES)}")
    autonomous, test, enabled = _NAMED[name]
    set_mode(autonomous=autonomous, test=test, enabled=enabled)


def mode_name() -> str:
    """Return which of `MODES` was last set."""
    mode = get_mode()
    if mode != "disabled":
        return mode
    if sends(RobotMode.AUTONOMOUS):
        return "disabled autonomous"
    return "disabled test" if sends(RobotMode.UTILITY) else "disabled"


def when_mode_changes(listener: Callable[[str, object], None]) -> list[object]:
    """Call a function whenever the result of `mode_name` may have changed.

    :returns: objects that must be kept for as long as the function is to be called
    """
    station = DriverStationSim
    return [
        register(listener, False)
        for register in (station.register_enabled_callback, station.register_robot_mode_callback)
    ]


def sends_enabled() -> bool:
    """Return whether the next packet enables the robot, attached to the driver station or not."""
    return bool(get_driver_station_enabled())


def set_enabled(enabled: bool) -> None:
    """Enable or disable the robot with the next packet; its mode stays."""
    set_driver_station_enabled(enabled)


def disable() -> None:
    """Disable the robot with the next packet; its mode stays."""
    set_driver_station_enabled(False)


def is_enabled() -> bool:
    """Return whether the robot may move: it is enabled, attached to a driver station, and not emergency-stopped."""
    return (
        bool(get_driver_station_enabled())
        and bool(get_driver_station_ds_attached())
        and not get_driver_station_e_stop()
    )


def is_attached() -> bool:
    """Return whether a driver station is attached."""
    return bool(get_driver_station_ds_attached())


def is_stopped() -> bool:
    """Return whether the emergency stop was pressed."""
    return bool(get_driver_station_e_stop())


def set_match_time(seconds_left: float) -> None:
    """Set the time left in the current period, in seconds: `MatchState.get_match_time` in robot code."""
    set_driver_station_match_time(seconds_left)


def match_time() -> float:
    """Return what was last set with `set_match_time`."""
    return get_driver_station_match_time()


def set_game_message(message: str) -> None:
    """Set the message that the field sends to all robots: `MatchState.get_game_data`."""
    set_game_data_string(message)


# -- opmodes -----------------------------------------------------------------------------------------------------------


def published_opmodes() -> list[PublishedOpmode]:
    """Return the opmodes that the robot has published."""
    return [
        PublishedOpmode(
            each.name,
            MODES_OF_OPMODES.get(int(hal.opmode_get_robot_mode(each.id)), ""),
            each.id,
            each.group,
            each.description,
        )
        for each in DriverStationSim.get_opmode_options()
    ]


def opmode_of_tests(opmode: PublishedOpmode) -> OpmodeOfTests:
    """Return what tests get for an opmode: what WPILib's own fixture gives."""
    return wpilib.testing.OpMode(RobotMode(int(hal.opmode_get_robot_mode(opmode.id))), opmode.name)


def selected_opmode() -> int:
    """Return WPILib's number for the opmode that the robot finds selected, by the last packet; 0 for none."""
    return int(RobotState.get_opmode_id())


#: The names of opmodes by their ids, which follow from mode and name.
_names: dict[int, str] = {}


def opmode_name() -> str:
    """Return the name of the opmode that was last selected, even if no packet has delivered it yet; "" for none."""
    number = int(get_driver_station_opmode())
    if number and number not in _names:
        _names.update((each.id, each.name) for each in published_opmodes())
    return _names.get(number, "")


def select_opmode_named(name: str) -> None:
    """Choose the opmode of this name, for its mode; "" chooses none for the mode that is set.

    With the next packet it is selected, if its mode is the one that is set. If opmodes of several modes have this name,
    it is that of the mode that is set.

    :raises UsageError: when the robot has published no such opmode
    """
    mode = int(DriverStationSim.get_robot_mode())
    if not name:
        _chosen.pop(mode, None)
    else:
        published = published_opmodes()
        found = [each for each in published if each.name == name]
        if not found:
            raise no_opmode(name, published)
        _choose(next((each for each in found if each.mode == MODES_OF_OPMODES.get(mode)), found[0]))
    DriverStationSim.set_opmode(_chosen.get(mode, 0))


def select_opmode(opmode: PublishedOpmode) -> None:
    """Select an opmode with the next packet, and its mode."""
    _choose(opmode)
    set_mode(autonomous=opmode.mode == "autonomous", test=opmode.mode == "test", enabled=sends_enabled())


def has_chosen_opmode() -> bool:
    """Return whether an opmode was chosen for any mode."""
    return bool(_chosen)


def choose_first_opmodes() -> None:
    """Choose the first opmode of each mode for which none is chosen yet, by group and name."""
    for opmode in sorted(published_opmodes(), key=lambda each: (each.group, each.name)):
        _chosen.setdefault(int(hal.opmode_get_robot_mode(opmode.id)), opmode.id)
    send_mode(DriverStationSim.get_robot_mode())


def _choose(opmode: PublishedOpmode) -> None:
    _chosen[int(hal.opmode_get_robot_mode(opmode.id))] = opmode.id


# -- the robot's side --------------------------------------------------------------------------------------------------


def program_state() -> str | None:
    """Return the robot program's mode; None until it has started.

    The program reports its mode to the HAL, which does not return it. So this is the mode of the last packet that the
    program has read.
    """
    if not get_program_started():
        return None
    if RobotState.is_teleop_enabled():  # the mode of most packets
        return "teleop"
    if RobotState.is_disabled():
        return "disabled"
    return "autonomous" if RobotState.is_autonomous() else "test"


def robot_is_enabled() -> bool:
    """Return whether the robot finds itself enabled, by the last packet that its program has read."""
    return bool(RobotState.is_enabled())


def silence_joystick_warnings() -> None:
    """Have the robot not warn of joysticks that it reads and that are not plugged in."""
    DriverStationBackend.silence_joystick_connection_alert(True)


def text_of(characters: memoryview) -> str:
    """Return the text in one of the HAL's buffers."""
    return characters.tobytes().partition(b"\0")[0].decode(errors="replace")
