"""Replace the functions by which tests and robot code reset data of the simulated HAL.

A reset of devices removes their callbacks, by which `hal_data` finds new devices: `prepare_reset` comes first. A reset
of the driver station's data must not end the connection.
"""

from __future__ import annotations

from collections.abc import Callable

import hal.simulation
import wpilib.simulation

from ...hal.created_devices import prepare_reset
from ...patch_table import Patch
from .active_run import active_run

#: The driver station is below; SimDevices have no callbacks.
_NOT_HERE = (wpilib.simulation.DriverStationSim, wpilib.simulation.SimDeviceSim)


def patches(reset: str, reset_station: str, reset_all: str, attach: Callable[[], object]) -> list[Patch]:
    """Return the names of WPILib's to replace.

    :param reset: the name of the functions of classes in `wpilib.simulation`
    :param reset_station: the name of the function in `hal.simulation` that resets the driver station's data
    :param reset_all: the name of the one that resets all data
    :param attach: attaches the driver station
    """
    return [
        *(
            _prepared(owner, reset)
            for owner in vars(wpilib.simulation).values()
            if isinstance(owner, type) and reset in vars(owner) and owner not in _NOT_HERE
        ),
        *(
            _keeping_connection(owner, name, attach)
            for owner, name in (
                (wpilib.simulation.DriverStationSim, reset),
                (hal.simulation, reset_station),
                (hal.simulation, reset_all),
            )
        ),
    ]


def _prepared(owner: type, name: str) -> Patch:
    real = getattr(owner, name)

    def reset(*device: object) -> None:
        prepare_reset()
        real(*device)

    return Patch(owner, name, reset)


def _keeping_connection(owner: object, name: str, attach: Callable[[], object]) -> Patch:
    real = getattr(owner, name)

    def reset() -> None:
        prepare_reset()
        real()
        if active_run.run is not None:
            attach()

    return Patch(owner, name, reset)
