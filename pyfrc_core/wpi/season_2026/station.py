"""The driver station: what it sends, packets, and what the robot program has taken in of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeAlias

import hal
from hal.simulation import (
    getDriverStationAutonomous,
    getDriverStationDsAttached,
    getDriverStationEnabled,
    getDriverStationEStop,
    getDriverStationMatchTime,
    getDriverStationTest,
    getProgramStarted,
    notifyDriverStationNewData,
    resetDriverStationData,
    setDriverStationAllianceStationId,
    setDriverStationAutonomous,
    setDriverStationDsAttached,
    setDriverStationEnabled,
    setDriverStationMatchTime,
    setDriverStationTest,
    setEventName,
    setGameSpecificMessage,
    setJoystickAxis,
    setJoystickAxisCount,
    setJoystickButtonCount,
    setJoystickButtonsValue,
    setJoystickPOV,
    setJoystickPOVCount,
)
from wpilib import DriverStation
from wpilib.simulation import DriverStationSim

from ...errors import UsageError
from ..opmodes import OpmodeOfTests, PublishedOpmode

#: The four modes that `TestController.get_mode` returns.
Mode: TypeAlias = Literal["disabled", "autonomous", "teleop", "test"]

JOYSTICKS = 6
#: As in 2019.
EVENT_NAME = "sim-event"
#: The default controls of each joystick: as many as a robot may read.
AXES, BUTTONS, POVS = 12, 12, 1
#: The key in `hal_data` of what the driver station says of a gamepad.
GAMEPAD_FLAG = "is_xbox"
#: The value of a POV that is not pressed; when pressed, it is an angle in degrees clockwise from up.
NOT_PRESSED = -1
#: The most buttons that a joystick can have.
MAX_BUTTONS = 32

#: Deliver the driver station's current data to the robot as the next packet.
deliver_packet = notifyDriverStationNewData

#: Have the robot program take in the last packet, as its loop does.
refresh = DriverStation.refreshData


def reset_driver_station() -> None:
    """Set the initial data of the driver station: attached, disabled, red 1, six joysticks with nothing pressed."""
    resetDriverStationData()
    setDriverStationDsAttached(True)
    setDriverStationAllianceStationId(hal.AllianceStationID.kRed1)
    setEventName(EVENT_NAME)
    for stick in range(JOYSTICKS):
        plug_in(stick)


def plug_in(stick: int) -> None:
    """Plug in a joystick with nothing pressed."""
    setJoystickAxisCount(stick, AXES)
    setJoystickButtonCount(stick, BUTTONS)
    setJoystickPOVCount(stick, POVS)
    for axis in range(AXES):
        setJoystickAxis(stick, axis, 0.0)
    setJoystickButtonsValue(stick, 0)
    for pov in range(POVS):
        setJoystickPOV(stick, pov, NOT_PRESSED)


def unplug(stick: int) -> None:
    """Unplug a joystick: it has no axes, buttons and POVs."""
    setJoystickAxisCount(stick, 0)
    setJoystickButtonCount(stick, 0)
    setJoystickPOVCount(stick, 0)


def set_mode(*, autonomous: bool = False, test: bool = False, enabled: bool) -> None:
    """Set the mode of the next driver-station packet."""
    setDriverStationAutonomous(autonomous)
    setDriverStationTest(test)
    setDriverStationEnabled(enabled)


def get_mode() -> Mode:
    """Return the mode that was last set, even if no packet has delivered it to the robot yet."""
    if not getDriverStationEnabled():
        return "disabled"
    if getDriverStationAutonomous():
        return "autonomous"
    return "test" if getDriverStationTest() else "teleop"


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
    if getDriverStationAutonomous():
        return "disabled autonomous"
    return "disabled test" if getDriverStationTest() else "disabled"


def when_mode_changes(listener: Callable[[str, object], None]) -> list[object]:
    """Call a function whenever the result of `mode_name` may have changed.

    :returns: objects that must be kept for as long as the function is to be called
    """
    station = DriverStationSim
    return [
        register(listener, False)
        for register in (
            station.registerEnabledCallback,
            station.registerAutonomousCallback,
            station.registerTestCallback,
        )
    ]


def sends_enabled() -> bool:
    """Return whether the next packet enables the robot, attached to the driver station or not."""
    return bool(getDriverStationEnabled())


def set_enabled(enabled: bool) -> None:
    """Enable or disable the robot with the next packet; its mode stays."""
    setDriverStationEnabled(enabled)


def disable() -> None:
    """Disable the robot with the next packet; its mode stays."""
    setDriverStationEnabled(False)


def is_enabled() -> bool:
    """Return whether the robot may move: it is enabled, attached to a driver station, and not emergency-stopped."""
    return bool(getDriverStationEnabled()) and bool(getDriverStationDsAttached()) and not getDriverStationEStop()


def is_attached() -> bool:
    """Return whether a driver station is attached."""
    return bool(getDriverStationDsAttached())


def is_stopped() -> bool:
    """Return whether the emergency stop was pressed."""
    return bool(getDriverStationEStop())


def set_match_time(seconds_left: float) -> None:
    """Set the time left in the current period, in seconds: `DriverStation.getMatchTime` in robot code."""
    setDriverStationMatchTime(seconds_left)


def match_time() -> float:
    """Return what was last set with `set_match_time`."""
    return getDriverStationMatchTime()


def set_game_message(message: str) -> None:
    """Set the message that the field sends to all robots: `DriverStation.getGameSpecificMessage`."""
    setGameSpecificMessage(message)


# -- opmodes -----------------------------------------------------------------------------------------------------------


def published_opmodes() -> list[PublishedOpmode]:
    """Return the opmodes that the robot has published: there are none before 2027."""
    return []


def opmode_of_tests(opmode: PublishedOpmode) -> OpmodeOfTests:
    """Return what tests get for an opmode."""
    return opmode


def opmode_name() -> str:
    """Return the name of the opmode that was last selected: there are none before 2027."""
    return ""


def has_chosen_opmode() -> bool:
    """Return whether an opmode was chosen for any mode: there are none before 2027."""
    return False


def choose_first_opmodes() -> None:
    """Choose the first opmode of each mode: there are none before 2027."""


def select_opmode(opmode: PublishedOpmode) -> None:
    """Select an opmode with the next packet, and its mode."""


# -- the robot's side --------------------------------------------------------------------------------------------------


def program_state() -> str | None:
    """Return the robot program's mode; None until it has started.

    The program reports its mode to the HAL, which does not return it. So this is the mode of the last packet that the
    program has read.
    """
    if not getProgramStarted():
        return None
    if DriverStation.isTeleopEnabled():  # the mode of most packets
        return "teleop"
    if DriverStation.isDisabled():
        return "disabled"
    return "autonomous" if DriverStation.isAutonomous() else "test"


def robot_is_enabled() -> bool:
    """Return whether the robot finds itself enabled, by the last packet that its program has read."""
    return bool(DriverStation.isEnabled())


def silence_joystick_warnings() -> None:
    """Have the robot not warn of joysticks that it reads and that are not plugged in."""
    DriverStation.silenceJoystickConnectionWarning(True)
