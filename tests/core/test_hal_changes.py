"""What a look at `hal_data` finds: each change of each value, and each device that comes or goes."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from typing import Any

import hal
import pytest
import wpilib
from conftest import sampled
from hal import simulation as hs
from wpilib import simulation as sim

from pyfrc_core.hal import HalData
from pyfrc_core.hal.change_reader import MISSING, ChangeReader, Changes
from pyfrc_core.hal.season_2026.device_table import KINDS
from pyfrc_core.patch_table import patched
from pyfrc_core.runtime.patches.hal_resets import patches


@pytest.fixture
def tree() -> Iterator[HalData]:
    with patched(patches("resetData", "resetDriverStationData", "resetAllSimData", lambda: None)):
        hs.resetAllSimData()
        yield HalData()
        gc.collect()
        hs.resetAllSimData()


def looking(tree: HalData) -> ChangeReader:
    """Return a reader that has looked, and finds nothing new."""
    changes = tree.changes()
    changes.look()
    assert changes.look() == ([], [])
    return changes


def found(changes: Changes) -> dict[str, Any]:
    return {path: new for path, _old, new in changes.changed}


# -- the roboRIO's devices, modules, joysticks and the match ----------------------------------------------------------


def create_all(tree: HalData) -> None:
    """Create one device of each kind, or two."""
    for kind in KINDS:
        for device in tree[kind.name][:2] if kind.make and kind.count and kind.name != "counter" else ():
            device["initialized"] = True
    tree["accelerometer"]["active"] = True
    for module in (sim.CTREPCMSim(3), sim.REVPHSim(4), sim.PowerDistributionSim(5)):
        module.setInitialized(True)
    for port in (0, 2):
        tree["joysticks"][port]["axis_count"] = 2
        tree["joysticks"][port]["button_count"] = 3
        tree["joysticks"][port]["pov_count"] = 1


def changed(value: Any) -> Any:
    """Another value that may stand in the same place."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, str):
        return value + "x"
    if isinstance(value, list):
        return [changed(each) for each in value]
    if isinstance(value, int):
        return 90 if value == -1 else 1 - value if value in (0, 1) else value - 1
    return 0.5 if value != 0.5 else -0.25


@pytest.mark.parametrize("every", sampled([1, 7], 7))
def test_each_value_is_found_when_it_changes(tree: HalData, every: int) -> None:
    create_all(tree)
    changes = looking(tree)
    written, now = 0, HalData(defaults=False)
    values = [(path, value) for path, value in tree.leaves() if tree.can_write(path) and path != "control.dsAttached"]
    for path, value in values[::every]:
        for new in (changed(value), value):
            new = [[1, 2, 3]] if path.endswith(".data") and new == [] else new
            if path.endswith(".length"):
                new = 3
            before = tree.read(path)
            tree.write(path, new)
            look, after = changes.look(), dict(now.leaves())
            if path in after:
                assert found(look).get(path, before) == after[path], path
            else:
                assert path in look.gone
            written += path in found(look)
    assert written > 150 // every


@pytest.mark.parametrize("reset", ["one device", "the driver station", "everything"])
def test_changes_after_a_reset_are_found(tree: HalData, reset: str) -> None:
    motor, other = wpilib.PWMSparkMax(3), wpilib.PWMSparkMax(4)
    changes = looking(tree)
    if reset == "one device":
        sim.PWMSim(3).resetData()
    elif reset == "the driver station":
        sim.DriverStationSim.resetData()
    else:
        hs.resetAllSimData()
    for number in (3, 4):
        sim.PWMSim(number).setInitialized(True)  # at once: at the next look, all devices are as before
    changes.look()
    motor.set(1.0)
    other.set(-1.0)
    later = wpilib.PWMSparkMax(5)
    sim.DriverStationSim.setEnabled(True)
    sim.DriverStationSim.setJoystickAxisCount(2, 1)
    sim.DriverStationSim.setJoystickAxis(2, 0, 0.5)
    sim.DriverStationSim.setGameSpecificMessage("LRL")
    values = found(changes.look())
    assert values["pwm[3].value"] == 1.0
    assert values["pwm[4].value"] == -1.0
    assert values["pwm[5].value"] == 0.0
    assert values["control.enabled"] is True
    assert values["joysticks[2].axes"] == [0.5]
    assert values["event.game_specific_message"] == "LRL"
    del later


#: One device of each class: how robot code creates it, and a path that it has then.
DEVICES: dict[str, tuple[Callable[[], object], str]] = {
    "pwm": (lambda: wpilib.PWMSparkMax(7), "pwm[7].value"),
    "digital input": (lambda: wpilib.DigitalInput(7), "dio[7].value"),
    "encoder": (lambda: wpilib.Encoder(1, 2), "encoder[0].count"),
    "analog input": (lambda: wpilib.AnalogInput(2), "analog_in[2].voltage"),
    "relay": (lambda: wpilib.Relay(1), "relay[1].fwd"),
    "duty cycle": (lambda: wpilib.DutyCycle(wpilib.DigitalInput(5)), "duty_cycle[0].output"),
    "LED strip": (lambda: wpilib.AddressableLED(1), "addressable_led[0].length"),
    "hub": (lambda: wpilib.PneumaticHub(4), "ph[4][0].value"),
    "PCM": (lambda: wpilib.PneumaticsControlModule(3), "pcm[3][0].value"),
    "power distribution": (
        lambda: wpilib.PowerDistribution(1, wpilib.PowerDistribution.ModuleType.kRev),
        "pdp[1].voltage",
    ),
}


@pytest.mark.parametrize("name", DEVICES)
def test_a_device_that_comes_and_one_that_goes_are_found(tree: HalData, name: str) -> None:
    create, path = DEVICES[name]
    changes = looking(tree)
    device = create()
    assert path in found(changes.look())
    del device
    gc.collect()
    there = dict(HalData().leaves())  # the HAL keeps some
    assert (path in changes.look().gone) is (path not in there)


def test_a_colour_and_the_length_of_a_led_strip(tree: HalData) -> None:
    strip = wpilib.AddressableLED(9)
    strip.setLength(2)
    changes = looking(tree)
    for number in range(4):
        strip.setData([wpilib.AddressableLED.LEDData(1, 2, number // 2 + 1)] * 2)
        expected = {} if number % 2 else {"addressable_led[0].data": [[1, 2, number // 2 + 1]] * 2}
        assert found(changes.look()) == expected
    strip.setLength(300)
    strip.setData([wpilib.AddressableLED.LEDData(1, 2, 3)] * 299 + [wpilib.AddressableLED.LEDData(7, 8, 9)])
    data = found(changes.look())["addressable_led[0].data"]
    assert data == tree["addressable_led"][0]["data"]
    assert data[-2:] == [[1, 2, 3], [7, 8, 9]]


def test_free_keys_that_come_change_and_go(tree: HalData) -> None:
    changes = looking(tree)
    tree["custom"]["lift"] = 1
    tree["robot"]["my_arm"] = 12
    assert changes.look().changed == [("robot.my_arm", MISSING, 12), ("custom.lift", MISSING, 1)]
    tree["custom"]["lift"] = True  # equal, and not the same
    assert found(changes.look()) == {"custom.lift": True}
    tree["custom"] = {}
    assert changes.look() == ([], ["custom.lift"])


# -- SimDevices -------------------------------------------------------------------------------------------------------


def make(count: int) -> list[Any]:
    """Create SimDevices with 25 values each. Return them and their values."""
    devices = [hal.SimDevice(f"Motor[{number}]") for number in range(count)]
    return [devices, [device.createDouble(f"v{n}", 2, float(n)) for device in devices for n in range(25)]]


@pytest.mark.parametrize("values_only", [False, True])
def test_signs_of_zero_and_nan_beside_other_changes(tree: HalData, values_only: bool) -> None:
    devices, values = make(1)
    changes, path = looking(tree), 'CAN["Motor[0]"].v0'
    before = 0.0
    for number, value in enumerate((-0.0, 0.0, float("nan"), float("nan"), -0.0, 1.0, 1.0)):
        values[0].set(value)
        values[5].set(100.0 + number)
        alike = before == value if values_only else repr(value) == repr(before)
        expected = {} if alike or repr(before) == repr(value) else {path: value}
        now = changes.look_at_values()[0] if values_only else found(changes.look())
        assert repr(now) == repr(expected | {'CAN["Motor[0]"].v5': 100.0 + number})
        assert changes.look() == ([], [])
        before = value
    del devices


def test_devices_and_values_that_come_and_go(tree: HalData) -> None:
    devices, values = make(1)
    changes = looking(tree)
    later = devices[0].createDouble("later", 0, 1.0)
    assert changes.look().changed == [('CAN["Motor[0]"].later', MISSING, 1.0)]
    # A device that is freed and created again within one look has the same paths.
    del devices, values, later
    gc.collect()
    again, values = make(1)
    assert changes.look() == ([], ['CAN["Motor[0]"].later'])
    values[1].set(7.0)
    assert found(changes.look()) == {'CAN["Motor[0]"].v1': 7.0}
    # Here the names of the values are the same, too.
    del again, values
    gc.collect()
    again, values = make(1)
    assert changes.look().changed == [('CAN["Motor[0]"].v1', 7.0, 1.0)]
    values[1].set(8.0)
    assert found(changes.look()) == {'CAN["Motor[0]"].v1': 8.0}
    del again


# -- readers ----------------------------------------------------------------------------------------------------------


def test_readers_do_not_affect_each_other(tree: HalData) -> None:
    devices, values = make(1)
    first, second = looking(tree), looking(tree)
    other_tree = looking(HalData())
    values[0].set(5.0)
    assert [found(reader.look()) for reader in (first, first)] == [{'CAN["Motor[0]"].v0': 5.0}, {}]
    values[0].set(0.0)
    assert first.look().changed == [('CAN["Motor[0]"].v0', 5.0, 0.0)]
    assert second.look() == other_tree.look() == ([], [])  # it is as it was at their last look
    del devices
