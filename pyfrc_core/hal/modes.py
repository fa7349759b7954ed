"""The driver station's mode: what a test, a script or a person may put the robot into."""

from __future__ import annotations

from typing import Literal, TypeAlias

from hal import AllianceStationID
from hal.simulation import (
    getDriverStationAutonomous,
    getDriverStationEnabled,
    getDriverStationTest,
    resetDriverStationData,
    setDriverStationAllianceStationId,
    setDriverStationAutonomous,
    setDriverStationDsAttached,
    setDriverStationEnabled,
    setDriverStationMatchTime,
    setDriverStationTest,
    setGameSpecificMessage,
    setJoystickAxisCount,
    setJoystickButtonCount,
    setJoystickPOV,
    setJoystickPOVCount,
)

#: The four names that `TestController.get_mode` answers with.
Mode: TypeAlias = Literal["disabled", "autonomous", "teleop", "test"]

JOYSTICKS = 6
#: What each joystick has until somebody says otherwise: as many controls as a robot may ask for.
AXES, BUTTONS, POVS = 12, 12, 1
#: What a POV reads while nobody touches it; pressed, it is an angle in degrees clockwise from up.
NOT_PRESSED = -1


def reset_driver_station() -> None:
    """Attached, disabled, teleoperated, red 1, no game message, six joysticks with nothing pressed."""
    resetDriverStationData()
    setDriverStationDsAttached(True)
    setDriverStationAllianceStationId(AllianceStationID.kRed1)
    for stick in range(JOYSTICKS):
        setJoystickAxisCount(stick, AXES)
        setJoystickButtonCount(stick, BUTTONS)
        setJoystickPOVCount(stick, POVS)
        for pov in range(POVS):
            setJoystickPOV(stick, pov, NOT_PRESSED)


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


def set_match_time(seconds_left: float) -> None:
    """The time left in the current period, in seconds: `DriverStation.getMatchTime` in robot code."""
    setDriverStationMatchTime(seconds_left)


def set_game_message(message: str) -> None:
    """The message that the field sends to all robots: `DriverStation.getGameSpecificMessage`."""
    setGameSpecificMessage(message)
