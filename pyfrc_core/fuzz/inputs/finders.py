"""Find a robot's inputs: the controls of its joysticks, and the sensors that it has created.

Inputs from the dashboard are in `dashboard_generator`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from itertools import chain

from ...hal import HalData, counters, format_path, tree
from ...hal.paths import join
from ...hal.robot_devices import TreeDevice
from ...hal.rows import TableRow, rows_of
from ...hal.sim_quantities import quantity_of
from ...runtime.scripts.targets import OPMODE
from ...season import CURRENT
from ...wpi import devices, joysticks, station
from .values import UNKNOWN, Input, RobotConstants

# -- joysticks -------------------------------------------------------------------------------------------------------


def find_controls(hal_data: HalData, gamepads: Mapping[int, str]) -> Iterator[Input]:
    """Return the axes, buttons and POVs of the joysticks that are plugged in."""
    for number, stick in enumerate(hal_data["joysticks"]):
        yield from _controls(number, *stick.counts(), joysticks.TRIGGERS.get(gamepads.get(number, ""), ()))


@cache
def _controls(number: int, axes: int, buttons: int, povs: int, triggers: tuple[int, ...]) -> tuple[Input, ...]:
    name = f"joysticks[{number}]"
    return (
        *(Input(f"{name}.axes[{axis}]", "trigger" if axis in triggers else "axis", name) for axis in range(axes)),
        *(
            Input(f"{name}.buttons[{button}]", "button", name)
            for button in range(CURRENT.first_button, CURRENT.first_button + buttons)
        ),
        *(Input(f"{name}.povs[{pov}]", "pov", name) for pov in range(povs)),
    )


# -- sensors ---------------------------------------------------------------------------------------------------------


class SensorFinder:
    """Finds what the robot's sensors measure; searches again only after a device was created or removed."""

    def __init__(self, constants: RobotConstants = UNKNOWN) -> None:
        self._constants = constants
        self._seen: object = None
        self._found: list[Input] = []

    def find(self) -> list[Input]:
        """Return the sensors' values in order: the same list until the robot's devices change."""
        opmodes = [each.name for each in station.published_opmodes()]
        there = tree().created(), tree()["CAN"].signature(), counters.counted_channels(), opmodes
        if there != self._seen:
            self._seen = there
            self._found = sorted(find_sensors(tree(), self._constants))
        return self._found


def prepare_search() -> None:
    """Prepare a search for inputs: forks of this process then find it prepared."""
    tree().created()
    for number in range(station.JOYSTICKS):
        for triggers in {(), *joysticks.TRIGGERS.values()}:
            _controls(number, station.AXES, station.BUTTONS, station.POVS, triggers)


def find_sensors(hal_data: HalData, constants: RobotConstants = UNKNOWN) -> Iterator[Input]:
    """Return what the robot's sensors measure; outputs of SimDevices are left out.

    :param constants: tells what the robot's code asks its controller for
    """
    if opmodes := station.published_opmodes():
        yield Input(OPMODE, "option", "opmode", tuple(sorted({each.name for each in opmodes})), seldom=True)
    devices = hal_data.devices()
    wired = set(chain.from_iterable(map(_wires, devices)))
    counted = {format_path(("dio", channel)) for channel in counters.counted_channels()}
    for device in devices:
        if device.path not in wired:
            for row in rows_of(device.kind):
                yield from _of_row(row, device, device.path in counted, constants)
    for name in hal_data["CAN"]:
        yield from _of_sim_device(name)


def _wires(device: TreeDevice) -> Iterator[str]:
    """Return the channels that an encoder or a gyro uses; they are not sensors of their own."""
    if wired_to := device.kind.wired_to:
        wires = device.place["config"].values() if device.kind.config else [device.number]
        yield from (join(wired_to, wire) for wire in wires)


def _of_row(row: TableRow, device: TreeDevice, is_counted: bool, constants: RobotConstants) -> Iterator[Input]:
    """Return what a sensor measures of one row: nothing, one value, or a list of values.

    :param is_counted: whether a counter counts its edges
    """
    field = row.field
    if not field.quantity or (row.asked_by and not constants.asks(row.asked_by)):
        return
    if field.only_if and not device.place[field.only_if]:
        return
    path = join(device.path, field.name)
    for target in [join(path, index) for index in range(field.length)] or [path]:
        owner = device.path if device.kind.exists else path
        yield Input(target, "pulses" if is_counted else field.quantity, owner, seldom=device.kind.seldom)


def _of_sim_device(name: str) -> Iterator[Input]:
    for value, is_output, sort, options in devices.sim_values(name):
        if is_output:
            continue
        kind = quantity_of(name, value, sort)
        if kind != "option" or options:
            yield Input(format_path(("CAN", name, value)), kind, format_path(("CAN", name)), options)
