"""The driver station's mode, set by tests, scripts and people."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeAlias

from hal import AllianceStationID
from hal.simulation import (
    getDriverStationAutonomous,
    getDriverStationDsAttached,
    getDriverStationEnabled,
    getDriverStationEStop,
    getDriverStationMatchTime,
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

#: The four modes that `TestController.get_mode` returns.
Mode: TypeAlias = Literal["disabled", "autonomous", "teleop", "test"]

JOYSTICKS = 6
#: As in 2019.
EVENT_NAME = "sim-event"
#: The default controls of each joystick: as many as a robot may read.
AXES, BUTTONS, POVS = 12, 12, 1
#: The value of a POV that is not pressed; when pressed, it is an angle in degrees clockwise from up.
NOT_PRESSED = -1


def reset_driver_station() -> None:
    """Set the initial data of the driver station: attached, disabled, red 1, six joysticks with nothing pressed."""
    resetDriverStationData()
    setDriverStationDsAttached(True)
    setDriverStationAllianceStationId(AllianceStationID.kRed1)
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
