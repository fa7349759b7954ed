"""The driver station's mode: what a test, a script or a person may put the robot into."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, TypeAlias

from hal import AllianceStationID
from hal.simulation import (
    getDriverStationAutonomous,
    getDriverStationDsAttached,
    getDriverStationEnabled,
    getDriverStationEStop,
    getDriverStationTest,
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
from wpilib.simulation import DriverStationSim

from ..errors import UsageError

#: The four names that `TestController.get_mode` answers with.
Mode: TypeAlias = Literal["disabled", "autonomous", "teleop", "test"]

JOYSTICKS = 6
#: As in 2019.
EVENT_NAME = "sim-event"
#: What each joystick has until somebody says otherwise: as many controls as a robot may ask for.
AXES, BUTTONS, POVS = 12, 12, 1
#: What a POV reads while nobody touches it; pressed, it is an angle in degrees clockwise from up.
NOT_PRESSED = -1


def reset_driver_station() -> None:
    """Set what the driver station sends at first: attached, disabled, red 1, six joysticks with nothing pressed."""
    resetDriverStationData()
    setDriverStationDsAttached(True)
    setDriverStationAllianceStationId(AllianceStationID.kRed1)
    setEventName(EVENT_NAME)
    for stick in range(JOYSTICKS):
        plug_in(stick)


def plug_in(stick: int) -> None:
    """A joystick is there, and nobody touches it."""
    setJoystickAxisCount(stick, AXES)
    setJoystickButtonCount(stick, BUTTONS)
    setJoystickPOVCount(stick, POVS)
    for axis in range(AXES):
        setJoystickAxis(stick, axis, 0.0)
    setJoystickButtonsValue(stick, 0)
    for pov in range(POVS):
        setJoystickPOV(stick, pov, NOT_PRESSED)


def unplug(stick: int) -> None:
    """A joystick is gone: it has no axes, buttons and POVs."""
    setJoystickAxisCount(stick, 0)
    setJoystickButtonCount(stick, 0)
    setJoystickPOVCount(stick, 0)


def set_mode(*, autonomous: bool = False, test: bool = False, enabled: bool) -> None:
    """What the next driver-station packet will say."""
    setDriverStationAutonomous(autonomous)
    setDriverStationTest(test)
    setDriverStationEnabled(enabled)


def get_mode() -> Mode:
    """The mode last asked for, whether or not a packet has carried it to the robot yet."""
    if not getDriverStationEnabled():
        return "disabled"
    if getDriverStationAutonomous():
        return "autonomous"
    return "test" if getDriverStationTest() else "teleop"


#: How scripts name the modes: those the robot can be in, and those it can be about to be enabled in.
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
    """Ask for one of `MODES`.

    :raises UsageError: when there is no such mode
    """
    if name not in _NAMED:
        raise UsageError(f"there is no mode {name!r}: there is {', '.join(MODES)}")
    autonomous, test, enabled = _NAMED[name]
    set_mode(autonomous=autonomous, test=test, enabled=enabled)


def mode_name() -> str:
    """Which of `MODES` was last asked for."""
    mode = get_mode()
    if mode != "disabled":
        return mode
    if getDriverStationAutonomous():
        return "disabled autonomous"
    return "disabled test" if getDriverStationTest() else "disabled"


def when_mode_changes(listener: Callable[[str, Any], None]) -> list[object]:
    """Have a function called whenever what `mode_name` returns may have changed.

    :returns: what has to be kept for as long as it is to be called
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


def is_enabled() -> bool:
    """Whether the robot may move: enabled by a driver station that is there, and not stopped in an emergency."""
    return bool(getDriverStationEnabled()) and bool(getDriverStationDsAttached()) and not getDriverStationEStop()


def is_attached() -> bool:
    """Whether a driver station is there."""
    return bool(getDriverStationDsAttached())


def is_stopped() -> bool:
    """Whether the emergency stop was pressed."""
    return bool(getDriverStationEStop())


def set_match_time(seconds_left: float) -> None:
    """The time left in the current period, in seconds: `DriverStation.getMatchTime` in robot code."""
    setDriverStationMatchTime(seconds_left)


def set_game_message(message: str) -> None:
    """The message that the field sends to all robots: `DriverStation.getGameSpecificMessage`."""
    setGameSpecificMessage(message)
