"""The connection to the driver station as the robot sees it: none after power-on, or lost."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import hal
from hal.simulation import (
    get_driver_station_enabled,
    get_driver_station_match_time,
    get_game_data,
    get_joystick_availables,
    get_match_info,
    reset_driver_station_data,
    set_driver_station_ds_attached,
    set_driver_station_enabled,
    set_driver_station_match_time,
    set_game_data_string,
    set_joystick_axes_available,
    set_joystick_buttons_available,
    set_joystick_povs_available,
)
from wpilib import MatchState, MotorSafety
from wpilib.simulation import DriverStationSim

from .station import JOYSTICKS, deliver_packet, refresh, text_of, unplug


class MatchInfo(NamedTuple):
    """The match, as the field sends it."""

    event_name: str = ""
    match_type: int = 0
    match_number: int = 0
    replay_number: int = 0
    game_data: str = ""


def detach_at_boot() -> None:
    """Show the robot what it sees after power-on: no driver station, alliance, match and joysticks."""
    reset_driver_station_data()
    set_game_data_string("")
    deliver_packet()
    set_driver_station_ds_attached(False)
    refresh()


def sent_match() -> MatchInfo:
    """Return the match that packets contain now."""
    info, message = hal.MatchInfo(), hal.GameData()
    get_match_info(info)
    get_game_data(message)
    return MatchInfo(
        text_of(info.event_name),
        int(info.match_type),
        info.match_number,
        info.replay_number,
        text_of(message.game_data),
    )


def deliver_loss() -> None:
    """Show the robot the loss: not attached, disabled, and joysticks without axes, buttons and POVs."""
    with _nothing_new():
        deliver_packet()


def check_motors_after_loss() -> None:
    """Stop the motors that were not updated since the loss.

    WPILib's own check does nothing in a robot that is disabled. So WPILib sees the robot enabled for as long as the
    check takes.
    """
    enabled = get_driver_station_enabled()
    with _nothing_new():
        set_driver_station_enabled(True)
        deliver_packet()
        hal.refresh_ds_data()
        MotorSafety.check_motors()
        set_driver_station_enabled(enabled)
    hal.refresh_ds_data()


@contextmanager
def _nothing_new() -> Iterator[None]:
    """Make packets contain no joysticks, and the alliance and match time that the robot has, until the context ends."""
    available = [get_joystick_availables(stick) for stick in range(JOYSTICKS)]
    alliance, match_time = DriverStationSim.get_alliance_station_id(), get_driver_station_match_time()
    for stick in range(JOYSTICKS):
        unplug(stick)
    DriverStationSim.set_alliance_station_id(hal.AllianceStationID(int(hal.get_alliance_station()[0])))
    set_driver_station_match_time(MatchState.get_match_time())
    try:
        yield
    finally:
        for stick, (axes, buttons, povs) in enumerate(available):
            set_joystick_axes_available(stick, axes)
            set_joystick_buttons_available(stick, buttons)
            set_joystick_povs_available(stick, povs)
        DriverStationSim.set_alliance_station_id(alliance)
        set_driver_station_match_time(match_time)
        set_driver_station_ds_attached(False)
