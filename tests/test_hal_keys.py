"""The testing guide's table of keys: which belongs to which device of robot code."""

from __future__ import annotations

import re
from pathlib import Path

DEVICES = """
    from wpilib import (
        ADXRS450_Gyro, AddressableLED, AnalogEncoder, AnalogGyro, AnalogInput, AnalogPotentiometer,
        BuiltInAccelerometer, Compressor,
        Counter, DigitalInput, DigitalOutput, DutyCycleEncoder, Encoder, Joystick, PneumaticsModuleType,
        PowerDistribution, PWMSparkMax, Relay, Servo, Solenoid, TimedRobot,
    )

    CTREPCM, REVPH = PneumaticsModuleType.CTREPCM, PneumaticsModuleType.REVPH


    class MyRobot(TimedRobot):
        def robotInit(self):
            self.stick, self.motor, self.servo, self.relay = Joystick(0), PWMSparkMax(2), Servo(8), Relay(1)
            self.solenoid, self.hub_solenoid = Solenoid(CTREPCM, 3), Solenoid(REVPH, 4)
            self.compressor = Compressor(CTREPCM)
            self.input, self.output = DigitalInput(4), DigitalOutput(5)
            self.analog, self.potentiometer = AnalogInput(2), AnalogPotentiometer(3)
            self.encoder, self.counter = Encoder(0, 1), Counter(6)
            self.absolute, self.analog_encoder = DutyCycleEncoder(9), AnalogEncoder(1)
            self.analog_gyro, self.gyro, self.accelerometer = AnalogGyro(0), ADXRS450_Gyro(), BuiltInAccelerometer()
            self.power = PowerDistribution(1, PowerDistribution.ModuleType.kRev)
            self.leds = AddressableLED(9)
"""

#: What a test writes, and what the robot then reads; what the robot does, and what a test then reads.
KEYS = """
    from pytest import approx
    from wpilib import AddressableLED, Relay, RobotController


    def test_inputs(control, hal_data, robot):
        with control.run_robot():
            hal_data["joysticks"][0]["axes"][1] = 0.5
            hal_data["joysticks"][0]["buttons"][1] = True
            hal_data["joysticks"][0]["povs"][0] = 90
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert (robot.stick.getY(), robot.stick.getRawButton(1), robot.stick.getPOV()) == (0.5, True, 90)
            hal_data["compressor"]["pressure_switch"] = True
            assert robot.compressor.getPressureSwitchValue()
            hal_data["dio"][4]["value"] = False
            assert not robot.input.get()
            hal_data["analog_in"][2]["voltage"] = 2.5
            hal_data["analog_in"][3]["voltage"] = 1.25
            assert (robot.analog.getVoltage(), robot.potentiometer.get()) == (2.5, approx(0.25))
            hal_data["encoder"][0]["count"] = 12
            hal_data["counter"][0]["count"] = 13
            assert (robot.encoder.get(), robot.counter.get()) == (12, 13)
            hal_data["CAN"]["DutyCycle:DutyCycleEncoder[9]"]["Position"] = 0.25
            hal_data["CAN"]["AnalogEncoder[1]"]["Position"] = 0.75
            assert (robot.absolute.get(), robot.analog_encoder.get()) == (0.25, 0.75)
            hal_data["analog_gyro"][0]["angle"] = 30
            hal_data["robot"]["adxrs450_spi_0_angle"] = 40
            assert (robot.analog_gyro.getAngle(), robot.gyro.getAngle()) == (30, 40)
            hal_data["accelerometer"]["x"] = 0.5
            assert robot.accelerometer.getX() == 0.5
            hal_data["pdp"][1]["current"][0] = 7.0
            assert robot.power.getCurrent(0) == 7
            hal_data["power"]["vin_voltage"] = 11.5
            assert RobotController.getBatteryVoltage() == 11.5


    def test_outputs(control, hal_data, robot):
        with control.run_robot():
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            robot.motor.set(0.5)
            assert hal_data["pwm"][2]["value"] == approx(0.5, abs=0.01)
            robot.servo.set(0.25)
            assert hal_data["pwm"][8]["position"] == approx(0.25, abs=0.01)
            robot.relay.set(Relay.Value.kForward)
            assert (hal_data["relay"][1]["fwd"], hal_data["relay"][1]["rev"]) == (True, False)
            robot.solenoid.set(True)
            assert hal_data["solenoid"][3]["value"] and hal_data["pcm"][0][3]["value"]
            robot.hub_solenoid.set(True)
            assert hal_data["ph"][1][4]["value"]
            assert hal_data["compressor"]["on"] is False
            robot.output.set(True)
            assert hal_data["dio"][5]["value"]
            robot.leds.setLength(1)
            robot.leds.setData([AddressableLED.LEDData(1, 2, 3)])
            assert list(hal_data["addressable_led"][0]["data"][0]) == [1, 2, 3]
"""


def test_the_guides_table_of_keys_is_right(make_project) -> None:
    guide = (Path(__file__).parents[1] / "docs/reference/hal_data.md").read_text("utf-8")
    table = guide.partition("which key is it?")[2].partition("\n\nThe keys of 2027")[0]
    rows = [line for line in table.splitlines() if "[" in line]
    assert len(rows) == 20
    for row in rows[:-1]:
        code, keys = row.strip("| ").split(" | ", 1)
        assert re.findall(r"`(\w+)[.(]", code)[0] in DEVICES + KEYS
        for key in re.findall(r"`((?:\[[^`]+\])+)`", keys):
            assert key in KEYS or key in ('["y"]', '["z"]'), key
    project = make_project({"robot.py": DEVICES, "tests/test_keys.py": KEYS})
    result = project.run("test")
    assert result.code == 0, result.output
