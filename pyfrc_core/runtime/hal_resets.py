"""Replace the functions by which tests and robot code reset data of the simulated HAL.

A reset removes all callbacks of a device without a sign, and `hal_data` relies on them. So it is announced first.
A reset of the driver station's data must not end the connection.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import hal.simulation
import wpilib.simulation

from ..compat.hal_callbacks import resets
from .patch_table import Patch

if TYPE_CHECKING:
    from .robot import RobotRun

#: The driver station is below; resets of SimDevices are noticed without help.
_NOT_HERE = (wpilib.simulation.DriverStationSim, wpilib.simulation.SimDeviceSim)


def patches(current_run: Callable[[], RobotRun | None]) -> list[Patch]:
    """Return the names of WPILib's to replace.

    :param current_run: returns the run that is active in this process
    """
    return [
        *(
            _announced(owner, "resetData")
            for owner in vars(wpilib.simulation).values()
            if isinstance(owner, type) and "resetData" in vars(owner) and owner not in _NOT_HERE
        ),
        *(
            _keeping_connection(owner, name, current_run)
            for owner, name in (
                (wpilib.simulation.DriverStationSim, "resetData"),
                (hal.simulation, "resetDriverStationData"),
                (hal.simulation, "resetAllSimData"),
            )
        ),
    ]


def _announced(owner: type, name: str) -> Patch:
    real = getattr(owner, name)

    def reset(*device: object) -> None:
        resets.announce()
        real(*device)

    return Patch(owner, name, reset)


def _keeping_connection(owner: object, name: str, current_run: Callable[[], RobotRun | None]) -> Patch:
    real = getattr(owner, name)

    def reset() -> None:
        resets.announce()
        real()
        if current_run() is not None:
            hal.simulation.setDriverStationDsAttached(True)

    return Patch(owner, name, reset)
