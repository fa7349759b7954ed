"""What a look at `hal_data` costs depends on what changes, not on what exists; and no change is missed for that."""

from __future__ import annotations

import gc
import math
import sys
from collections.abc import Iterator
from typing import Any

import hal
import pytest
import wpilib.simulation
from announced_resets import announced_resets
from hal import simulation as hs

from pyfrc_core.hal import HalData
from pyfrc_core.hal.change_reader import MISSING, ChangeReader, Changes
from pyfrc_core.hal.output_gate import OutputGate

#: Looks that find nothing, before a change; more than those between two choices of the values that are written often.
LOOKS = 260


@pytest.fixture(params=[False, True], ids=["", "announced"])
def tree(request: pytest.FixtureRequest) -> Iterator[HalData]:
    with announced_resets(request.param):
        hs.resetDriverStationData()
        hs.resetSimDeviceData()
        yield HalData()
        gc.collect()
        hs.resetSimDeviceData()


def make(count: int, start: int = 0) -> list[Any]:
    """Create SimDevices with 25 values each. Return them and their values."""
    devices = [hal.SimDevice(f"Motor[{number}]") for number in range(start, start + count)]
    return [devices, [device.createDouble(f"v{n}", 2, float(n)) for device in devices for n in range(25)]]


def after_many_looks(tree: HalData) -> ChangeReader:
    changes = tree.changes()
    for _ in range(LOOKS):
        changes.look()
    return changes


def calls(function: Any) -> int:
    """Return how many functions a call of this one calls, WPILib's included, and the garbage collector's not."""
    count = 0

    def profile(_frame: object, event: str, _arg: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    gc.disable()  # libraries such as hypothesis have functions called when it runs
    sys.setprofile(profile)
    try:
        function()
    finally:
        sys.setprofile(None)
        gc.enable()
    return count


def found(changes: Changes) -> dict[str, Any]:
    return {path: new for path, _old, new in changes.changed}


def test_looking_costs_the_same_for_any_number_of_values(tree: HalData) -> None:
    few = make(1)
    changes, gate = after_many_looks(tree), OutputGate()
    with gate.closed_while_disabled():
        pass
    look, signature = calls(changes.look), calls(tree["CAN"].signature)
    many = make(40, start=1)
    for _ in range(LOOKS):
        changes.look()
    assert len(tree.leaves()) > 1000
    assert calls(changes.look) == look
    assert calls(tree["CAN"].signature) == signature < 10
    many[1][500].set(-1.0)
    assert look < calls(changes.look) < look + 100
    del few, many


def test_looking_costs_the_same_for_any_length_of_led_strip(tree: HalData) -> None:
    strip = wpilib.AddressableLED(9)
    strip.setLength(2)
    changes = after_many_looks(tree)
    short = calls(changes.look)
    strip.setLength(300)
    strip.setData([wpilib.AddressableLED.LEDData(1, 2, 3)] * 300)
    assert found(changes.look())["addressable_led[0].data"] == [[1, 2, 3]] * 300
    assert calls(changes.look) == short
    strip.setData([wpilib.AddressableLED.LEDData(1, 2, 3)] * 299 + [wpilib.AddressableLED.LEDData(7, 8, 9)])
    data = found(changes.look())["addressable_led[0].data"]
    assert data == tree["addressable_led"][0]["data"]
    assert data[-2:] == [[1, 2, 3], [7, 8, 9]]


def test_a_value_that_was_constant_for_long_is_found_when_it_changes(tree: HalData) -> None:
    devices, values = make(2)
    changes = after_many_looks(tree)
    for number in range(3 * LOOKS):
        if number % 37 == 0:  # now and then quiet again in between
            values[3].set(100.0 + number)
            values[28].set(200.0 + number)  # of the same name, in the other device
            expected = {'CAN["Motor[0]"].v3': 100.0 + number, 'CAN["Motor[1]"].v3': 200.0 + number}
            assert found(changes.look()) == expected
        else:
            assert changes.look() == ([], [])
    values[3].set(values[3].get())
    assert changes.look() == ([], [])
    values[3].set(-0.0)
    assert repr(found(changes.look())) == "{'CAN[\"Motor[0]\"].v3': -0.0}"
    values[3].reset()
    assert repr(found(changes.look())) == "{'CAN[\"Motor[0]\"].v3': 0.0}"
    del devices


def test_values_that_are_written_in_most_packets_and_values_that_stop(tree: HalData) -> None:
    devices, values = make(2)
    changes = after_many_looks(tree)
    begins = {0: 0, 1: 0, 2: 30, 3: 90, 30: 3}  # the first look before which each is written
    for number in range(4 * LOOKS):
        expected = {}
        for position, begin in begins.items():
            if begin <= number < begin + 2 * LOOKS and (position != 1 or number % 3):
                value = (number // 2 + position) * (-1.0) ** (position == 2)  # in half of the looks as before
                value = math.nan if value == 40 else -0.0 if value == 41 else 0.0 if value == 42 else value
                before = values[position].get()
                values[position].set(value)
                if repr(before) != repr(value):
                    expected[f'CAN["Motor[{position // 25}]"].v{position % 25}'] = value
        assert repr(found(changes.look())) == repr(expected)
    assert dict(tree.leaves()) == dict(HalData().leaves())
    del devices


def test_all_paths_of_one_value_are_found(tree: HalData) -> None:
    gyro = wpilib.ADXRS450_Gyro()
    changes = after_many_looks(tree)
    tree["robot"]["adxrs450_spi_0_angle"] = 30.0
    assert found(changes.look()) == {
        'CAN["Gyro:ADXRS450[0]"].angle_x': 30.0,
        "robot.adxrs450_spi_0_angle": 30.0,
    }
    del gyro


def test_readers_do_not_affect_each_other(tree: HalData) -> None:
    devices, values = make(1)
    first, second = after_many_looks(tree), after_many_looks(tree)
    other_tree = after_many_looks(HalData())
    values[0].set(5.0)
    assert [found(reader.look()) for reader in (first, first)] == [{'CAN["Motor[0]"].v0': 5.0}, {}]
    values[0].set(0.0)
    assert first.look().changed == [('CAN["Motor[0]"].v0', 5.0, 0.0)]
    assert second.look() == other_tree.look() == ([], [])  # it is as it was at their last look
    del devices


def test_a_reader_that_skips_finds_only_what_changes_later(tree: HalData) -> None:
    devices, values = make(1)
    changes, other = after_many_looks(tree), after_many_looks(tree)
    values[0].set(5.0)
    changes.skip()
    assert changes.look() == ([], [])
    assert found(other.look()) == {'CAN["Motor[0]"].v0': 5.0}
    values[1].set(6.0)
    other.look()
    changes.skip(refresh=False)  # the other one has looked
    assert changes.look() == ([], [])
    values[1].set(7.0)
    assert changes.look().changed == [('CAN["Motor[0]"].v1', 6.0, 7.0)]
    del devices


def test_a_reader_that_has_not_looked_for_long_finds_everything(tree: HalData) -> None:
    devices, values = make(1)
    seldom, often = after_many_looks(tree), after_many_looks(tree)
    for number in range(LOOKS):
        values[number % 20].set(100.0 + number)
        often.look()
    assert found(seldom.look()) == {f'CAN["Motor[0]"].v{n}': 80.0 + LOOKS + n for n in range(20)}
    del devices


def test_signs_of_zero_and_nan_beside_other_changes(tree: HalData) -> None:
    devices, values = make(1)
    changes, path = tree.changes(), 'CAN["Motor[0]"].v0'
    changes.look()
    before = 0.0
    for number, value in enumerate((-0.0, 0.0, float("nan"), float("nan"), -0.0, 1.0, 1.0)):
        values[0].set(value)
        values[5].set(100.0 + number)
        expected = {} if repr(value) == repr(before) else {path: value}
        assert repr(found(changes.look())) == repr(expected | {'CAN["Motor[0]"].v5': 100.0 + number})
        assert changes.look() == ([], [])
        before = value
    del devices


def test_currents_of_a_power_distribution_module_are_found(tree: HalData) -> None:
    wpilib.simulation.PowerDistributionSim(1).resetData()
    module = wpilib.PowerDistribution(1, wpilib.PowerDistribution.ModuleType.kRev)
    changes = after_many_looks(tree)
    for channel in (0, 23):
        tree["pdp"][1]["current"][channel] = 2.5 + channel
        assert found(changes.look()) == {"pdp[1].current": list(tree["pdp"][1]["current"])}
        assert changes.look() == ([], [])
    del module


def test_devices_and_values_that_come_and_go(tree: HalData) -> None:
    devices, values = make(1)
    changes = after_many_looks(tree)
    later = devices[0].createDouble("later", 0, 1.0)
    assert changes.look().changed == [('CAN["Motor[0]"].later', MISSING, 1.0)]
    for _ in range(LOOKS):
        assert changes.look() == ([], [])
    # A device that is freed and created again within one look has the same paths.
    del devices, values, later
    gc.collect()
    again, values = make(1)
    assert changes.look() == ([], ['CAN["Motor[0]"].later'])
    values[1].set(7.0)
    assert found(changes.look()) == {'CAN["Motor[0]"].v1': 7.0}
    # Here the names of the values are the same, too.
    for _ in range(LOOKS):
        changes.look()
    del again, values
    gc.collect()
    again, values = make(1)
    assert changes.look().changed == [('CAN["Motor[0]"].v1', 7.0, 1.0)]
    values[1].set(8.0)
    assert found(changes.look()) == {'CAN["Motor[0]"].v1': 8.0}
    del again


def test_all_trees_see_a_device_that_is_created_again(tree: HalData) -> None:
    devices, values = make(1)
    trees = [tree, HalData()]
    changes = [after_many_looks(each) for each in trees]
    for number in range(3):
        del devices, values
        gc.collect()
        devices, values = make(1)
        for each in reversed(changes):
            each.look()
        values[1].set(7.0 + number)
        assert [found(each.look()) for each in changes] == [{'CAN["Motor[0]"].v1': 7.0 + number}] * 2
        changes.reverse()
    del devices


def test_a_reset_of_all_sim_devices_is_noticed(tree: HalData) -> None:
    before = make(1)
    changes = after_many_looks(tree)
    hs.resetSimDeviceData()
    again = make(1)  # with the same handles as before
    assert changes.look() == ([], [])
    for _ in range(LOOKS):
        changes.look()
    again[1][4].set(9.0)
    assert found(changes.look()) == {'CAN["Motor[0]"].v4': 9.0}
    hs.resetSimDeviceData()
    assert len(changes.look().gone) == 25
    del before, again


def test_an_output_that_is_created_later_is_turned_off_too(tree: HalData) -> None:
    gate = OutputGate()
    motor = hal.SimDevice("SPARK MAX [1]")
    first = motor.createDouble("Applied Output", 2, 1.0)
    with gate.closed_while_disabled():
        assert first.get() == 0.0
    second = motor.createDouble("Motor Voltage", 2, 12.0)
    with gate.closed_while_disabled():
        assert (first.get(), second.get()) == (0.0, 0.0)
    assert (first.get(), second.get()) == (1.0, 12.0)
