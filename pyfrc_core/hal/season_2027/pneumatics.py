"""Modules on the CAN bus, as WPILib simulates them: pneumatics and power distribution."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, TypeAlias

from wpilib.simulation import CTREPCMSim, PowerDistributionSim, REVPHSim

#: CTRE's and REV's modules, by their numbers.
Pcm: TypeAlias = CTREPCMSim
Hub: TypeAlias = REVPHSim
PowerDistribution: TypeAlias = PowerDistributionSim


def exists(module: Any) -> bool:
    """Return whether the robot has created a module."""
    return bool(module.get_initialized())


def reset(module: Any) -> None:
    """Reset what a module has sent and measured, and that there is one."""
    module.reset_data()


def solenoid(module: Any, channel: int) -> tuple[Callable[[], bool], Callable[[bool], None]]:
    """Return the functions that read and write a solenoid."""
    return partial(module.get_solenoid_output, channel), partial(module.set_solenoid_output, channel)


def watch_solenoid(module: Any, channel: int, changed: Callable[[], None]) -> object:
    """Call a function when a solenoid changes, as long as the result is kept."""
    return module.register_solenoid_output_callback(channel, lambda *_: changed(), False)


def is_closed_loop(hub: REVPHSim) -> bool:
    """Return whether a hub controls its compressor."""
    return hub.get_compressor_config_type() != 0


def set_closed_loop(hub: REVPHSim, on: bool) -> None:
    """Have a hub control its compressor, by the digital sensor."""
    hub.set_compressor_config_type(int(on))


def currents(
    module: PowerDistributionSim,
) -> tuple[Callable[[int], float], Callable[[int, float], None]]:
    """Return the functions that read and write the current of a channel."""
    return module.get_current, module.set_current


def watch_current(module: PowerDistributionSim, channel: int, changed: Callable[[], None]) -> object:
    """Call a function when a current changes, as long as the result is kept."""
    return module.register_current_callback(channel, lambda *_: changed(), False)
