"""WPILib's simulated FPGA clock and driver-station packets: the two things the runtime drives.

The functions are bound here when this module is imported, before the runtime patches the names that tests
and robot code call (`wpilib.simulation.stepTiming` and its kin), so they always reach the HAL itself.
"""

from __future__ import annotations

from hal.simulation import (
    notifyDriverStationNewData,
    pauseTiming,
    resetAllSimData,
    restartTiming,
    resumeTiming,
    stepTiming,
)

#: Advance HAL time by so many microseconds, waking the notifiers of C++ code that come due.
step_us = stepTiming

#: Hand the robot what the driver station has been set to, as the next packet.
deliver_packet = notifyDriverStationNewData

#: All sensors and outputs back to what they are in a HAL that was never used.
forget_inputs = resetAllSimData


def stop_and_zero() -> None:
    """From now on HAL time stands still at 0 and moves only by `step_us`."""
    pauseTiming()
    restartTiming()


def run_freely() -> None:
    """HAL time follows the wall clock again."""
    resumeTiming()
