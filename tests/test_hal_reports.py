"""`hal_data` relies on the HAL's reports of changes: of each value, after each reset, and no more after their end."""

from __future__ import annotations

import ctypes
import gc
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import wpilib
from announced_resets import announced_resets
from hal import simulation as hs
from wpilib import simulation as sim

from pyfrc_core.compat import hal_callbacks
from pyfrc_core.compat.hal_callbacks import Report, WriteFlags
from pyfrc_core.hal import HalData
from pyfrc_core.hal.change_reader import ChangeReader
from pyfrc_core.hal.devices import KINDS

#: Enough that values which are written in most looks are chosen, and chosen again.
LOOKS = 60


@pytest.fixture(autouse=True)
def _announced() -> Iterator[None]:
    with announced_resets():
        hs.resetAllSimData()
        yield
        hs.resetAllSimData()


@pytest.fixture
def tree() -> HalData:
    return HalData()


def create_all(tree: HalData) -> None:
    """Create one device of each kind, or two."""
    for kind in KINDS:
        for device in tree[kind.name][:2] if kind.reported_as else ():
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


def test_each_recorded_value_is_reported(tree: HalData) -> None:
    """A name that the HAL does not have would only cost time: the value would be read in each packet."""
    create_all(tree)
    lists = [tree[kind.name][0] for kind in KINDS if kind.reported_as]
    singles = [tree[name] for name in ("control", "accelerometer", "power", "roborio")]
    modules = [tree["pcm"][3][0], tree["ph"][4][0], tree["pcm_compressor"][3], tree["ph_compressor"][4], tree["pdp"][5]]
    for place in [*lists, *singles, *modules]:
        for key, slot in place._slots.items():
            if slot.recorded:
                assert slot.reports, f"{place._path}.{key}"
                assert all(report.exists for report in slot.reports), slot.reports


def after_many_looks(tree: HalData) -> ChangeReader:
    changes = tree.changes()
    for _ in range(LOOKS):
        changes.look()
    return changes


def test_each_value_is_found_when_it_changes(tree: HalData, monkeypatch: pytest.MonkeyPatch) -> None:
    create_all(tree)
    changes, reading = after_many_looks(tree), HalData(defaults=False)
    with monkeypatch.context() as patch:
        patch.setattr(hal_callbacks.resets, "announced", False)
        reading.leaves()  # from now on, it reads each value at each look
    written = 0
    for path, value in list(tree.leaves()):
        if not tree.can_write(path) or path == "control.dsAttached":
            continue
        for new in (changed(value), value):
            new = [[1, 2, 3]] if path.endswith(".data") and new == [] else new
            if path.endswith(".length"):
                new = 3
            before = tree.read(path)
            tree.write(path, new)
            look, after = changes.look(), dict(reading.leaves())
            found = {each: now for each, _, now in look.changed}
            if path in after:
                assert found.get(path, before) == after[path], path
            else:
                assert path in look.gone
            written += path in found
    assert written > 150


@pytest.mark.parametrize("reset", ["one device", "the driver station", "everything"])
def test_changes_after_a_reset_are_found(tree: HalData, reset: str) -> None:
    motor, other = wpilib.PWMSparkMax(3), wpilib.PWMSparkMax(4)
    changes = after_many_looks(tree)
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
    sim.DriverStationSim.setEnabled(True)
    sim.DriverStationSim.setJoystickAxisCount(2, 1)
    sim.DriverStationSim.setJoystickAxis(2, 0, 0.5)
    sim.DriverStationSim.setGameSpecificMessage("LRL")
    found = {path: new for path, _, new in changes.look().changed}
    assert found["pwm[3].value"] == 1.0
    assert found["pwm[4].value"] == -1.0
    assert found["control.enabled"] is True
    assert found["joysticks[2].axes"] == [0.5]
    assert found["event.game_specific_message"] == "LRL"


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
    changes = after_many_looks(tree)
    device = create()
    assert path in {each for each, _, _ in changes.look().changed}
    del device
    gc.collect()
    there = {each for each, _ in HalData().leaves()}  # the HAL keeps some
    assert (path in changes.look().gone) is (path not in there)


def test_a_colour_and_the_length_of_a_led_strip(tree: HalData) -> None:
    strip = wpilib.AddressableLED(9)
    strip.setLength(2)
    changes = after_many_looks(tree)
    for number in range(2 * LOOKS):  # written in each packet, as patterns are
        strip.setData([wpilib.AddressableLED.LEDData(1, 2, number // 2)] * 2)
        found = {path: new for path, _, new in changes.look().changed}
        assert found == ({} if number % 2 else {"addressable_led[0].data": [[1, 2, number // 2]] * 2})
    del strip


def test_what_is_closed_is_written_no_more(tree: HalData) -> None:
    """The HAL would write into memory that is free."""
    create_all(tree)
    leaves = tree.leaves()
    reports = sorted({registered.report for registered in hal_callbacks._REGISTERED} | set(reports_of(tree)))
    assert len(reports) > 150
    flags = WriteFlags([[report] for report in reports])
    memory: Any = flags._flags
    flags.close()
    for path, value in leaves:
        if tree.can_write(path):
            tree.write(path, changed(value) if not path.endswith((".data", ".length")) else value)
    assert not any(memory), [report for report, flag in zip(reports, memory, strict=True) if flag]
    assert isinstance(memory, ctypes.Array)


def reports_of(tree: HalData) -> Iterator[Report]:
    for kind in KINDS:
        for slot in tree[kind.name][0]._slots.values():
            yield from (report for report in slot.reports if report.exists)
    for part in (tree["event"], tree["joysticks"][0]):
        yield from part.reports
