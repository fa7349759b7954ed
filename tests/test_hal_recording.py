"""`leaves`, what a run is recorded from, and the SimDevices that come and go."""

from __future__ import annotations

import gc
import json
import sys
from collections.abc import Iterator

import hal
import pytest
import wpilib
from hal import simulation as hs
from wpilib import simulation as sim

from pyfrc_core.hal import HalData
from pyfrc_core.processes import spawn


@pytest.fixture
def tree() -> Iterator[HalData]:
    hs.resetDriverStationData()
    yield HalData()
    hs.resetDriverStationData()


def test_leaves_show_devices_as_they_are_made_and_unmade(tree: HalData) -> None:
    before = dict(tree.leaves())
    assert before["alliance_station"] == 1
    assert before["control.enabled"] is False
    assert not [path for path in before if path.startswith(("pwm[13]", "joysticks"))]
    motor = wpilib.PWMSparkMax(13)
    motor.set(0.5)
    assert dict(tree.leaves())["pwm[13].value"] == 0.5
    motor.set(-1.0)
    assert dict(tree.leaves())["pwm[13].value"] == -1.0
    del motor
    assert "pwm[13].value" not in dict(tree.leaves())
    solenoid = wpilib.Solenoid(7, wpilib.PneumaticsModuleType.REVPH, 4)
    solenoid.set(True)
    assert dict(tree.leaves())["ph[7][4].value"] is True
    sim.REVPHSim(7).resetData()
    assert "ph[7][4].value" not in dict(tree.leaves())


def test_leaves_can_be_written_back(tree: HalData) -> None:
    tree["joysticks"][1]["axes"][2] = 0.5
    tree["joysticks"][1]["buttons"][3] = True
    tree["custom"]["My Label"] = [1, 2]
    leaves = dict(tree.leaves())
    assert leaves["joysticks[1].axes"] == [0.0, 0.0, 0.5]
    assert leaves["joysticks[1].buttons"] == [False, False, False, True]
    assert leaves['custom["My Label"]'] == [1, 2]
    assert json.loads(json.dumps(leaves)) == leaves
    hs.resetDriverStationData()
    for path, value in leaves.items():
        if path != "user_program_state":  # which the robot program alone says
            tree.write(path, value)
    assert dict(tree.leaves()) == leaves


def test_importing_and_making_a_tree_makes_no_device() -> None:
    code = (
        "from pyfrc_core.hal import HalData; from hal import simulation as hs;"
        "assert int(hs.getDriverStationAllianceStationId()) == 0; t = HalData(); t.snapshot();"
        "assert not any(d['initialized'] for d in t['pwm']) and not any(t[k] for k in ('pcm', 'pdp', 'CAN'))"
    )
    assert spawn.popen([sys.executable, "-c", code]).wait() == 0


def test_a_sim_device_of_a_vendor(tree: HalData) -> None:
    assert "SPARK MAX [3]" not in tree["CAN"]
    device = hal.SimDevice("SPARK MAX [3]")
    velocity = device.createDouble("Velocity", 0, 1.5)
    mode = device.createEnum("Mode", 2, ["coast", "brake"], 1)
    enabled = device.createBoolean("Enabled", 0, True)
    count = device.createInt("Count", 0, 3)
    big = device.createLong("Big", 0, 1 << 40)
    can = tree["CAN"]["SPARK MAX [3]"]
    assert can == {"Velocity": 1.5, "Mode": 1, "Enabled": True, "Count": 3, "Big": 1 << 40}
    assert can["Mode"] == "brake"
    can["Mode"] = "coast"
    can["Enabled"], can["Count"], can["Big"] = False, -4, 1 << 41
    tree.write('CAN["SPARK MAX [3]"].Velocity', 2)
    assert (velocity.get(), mode.get(), enabled.get(), count.get(), big.get()) == (2.0, 0, False, -4, 1 << 41)
    for key, value in (("Mode", "hover"), ("Count", 2.5)):
        with pytest.raises(ValueError, match=key):
            can[key] = value
    with pytest.raises(KeyError, match="did you mean 'Velocity'"):
        can["velocity"]


def test_a_sim_device_changes_while_its_dict_is_held(tree: HalData) -> None:
    device = hal.SimDevice("Arm")
    device.createDouble("Angle", 0, 1.0)
    held = tree["CAN"]["Arm"]
    assert list(held) == ["Angle"]
    assert "CAN.Arm.Angle" in dict(tree.leaves())
    later = device.createDouble("Speed", 0, 2.0)
    assert held["Speed"] == 2.0
    assert dict(tree.leaves())["CAN.Arm.Speed"] == 2.0
    heard: list[object] = []
    held.register("Speed", lambda key, value: heard.append((key, value)))
    later.set(3)
    held["Speed"] = 4
    assert heard == [("Speed", 3.0), ("Speed", 4.0)]
    del device, later
    gc.collect()
    assert "Arm" not in tree["CAN"]
    assert "CAN.Arm.Angle" not in dict(tree.leaves())
    with pytest.raises(KeyError):
        held["Angle"]
    again = hal.SimDevice("Arm")
    again.createDouble("Angle", 0, 7.0)
    assert held["Angle"] == 7.0


def test_robot_keys_are_the_gyro_both_ways(tree: HalData) -> None:
    robot = tree["robot"]
    assert robot.get("adxrs450_spi_0_angle") == 0
    with pytest.raises(KeyError):
        robot["adxrs450_spi_0_angle"]
    robot["adxrs450_spi_0_angle"] = 45
    gyro = wpilib.ADXRS450_Gyro()
    tree.sync()
    assert gyro.getAngle() == 45.0
    robot["adxrs450_spi_0_rate"] = 3.0
    assert gyro.getRate() == 3.0
    sim.ADXRS450_GyroSim(gyro).setAngle(90)
    assert robot["adxrs450_spi_0_angle"] == 90.0
    assert dict(tree.leaves())["robot.adxrs450_spi_0_angle"] == 90.0
    robot["my_arm_angle"] = 12
    assert robot["my_arm_angle"] == 12
    assert "my_arm_angle" in robot
    del robot["my_arm_angle"]
    assert "my_arm_angle" not in robot


@pytest.mark.parametrize(
    ("device", "value", "key"),
    [
        ("Gyro:ADIS16448[4]", "gyro_angle_z", "adis16448_spi_4_angle"),
        ("Gyro:ADIS16470[0]", "gyro_rate_x", "adis16470_spi_0_rate_x"),
        ("Accel:ADXL345_SPI[2]", "x", "adxl345_spi_2_x"),
        ("Accel:ADXL345_I2C[1,29]", "y", "adxl345_i2c_1_y"),
        ("Accel:ADXL362[3]", "z", "adxl362_spi_3_z"),
        ("navX-Sensor[4]", "Yaw", "navx_spi_4_angle"),
        ("navX-Sensor[4]", "Roll", "navx_spi_4_roll"),
    ],
)
def test_robot_keys_of_other_sensors(tree: HalData, device: str, value: str, key: str) -> None:
    heard: list[object] = []
    tree["robot"].register(key, lambda key, value: heard.append((key, value)))
    tree["robot"][key] = 1.5
    made = hal.SimDevice(device)
    reading = made.createDouble(value, 0, 0.0)
    assert list(tree.leaves())
    assert reading.get() == 1.5
    reading.set(2.5)
    assert tree["robot"][key] == 2.5
    assert heard == [(key, 1.5), (key, 2.5)]
