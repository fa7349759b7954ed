"""The keys of 2027's hardware in `hal_data`, as `docs/reference/hal_data.md` has them."""

from __future__ import annotations

from conftest import MakeProject

from pyfrc_core.config.sim import SimConfig
from pyfrc_core.fuzz.inputs.values import SPANS
from pyfrc_core.sim.ui.models.devices import panels_of

ROBOT = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.pad = wpilib.Gamepad(0)
            self.imu = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)
            self.strip = wpilib.AddressableLED(3)
            self.strip.set_length(2)
            self.valve = wpilib.Solenoid(wpilib.CANPort.CAN_S0, wpilib.PneumaticsModuleType.CTRE_PCM, 3)
            self.hub_motor = wpilib.ExpansionHubMotor(0, 1)
            self.edges = wpilib.EdgeCounter(7, wpilib.EdgeConfiguration.RISING_EDGE)

        def teleop_periodic(self):
            hid = self.pad.get_hid()
            hid.set_rumble(wpilib.GenericHID.RumbleType.RIGHT_TRIGGER_RUMBLE, 1.0)
            hid.set_leds(1, 2, 3)
            self.strip.set_data([wpilib.AddressableLED.LEDData(10, 20, 30)] * 2)
            self.valve.set(self.pad.get_raw_button(0) if hasattr(self.pad, "get_raw_button") else hid.get_raw_button(0))
            self.hub_motor.set_throttle(0.5)
"""


def test_keys(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_it.py": """
                import pytest
                import wpilib


                def test_it(control, hal_data, robot):
                    stick, imu = hal_data["joysticks"][0], hal_data["onboard_imu"]
                    with control.run_robot():
                        stick["buttons"][0], stick["type"], stick["is_gamepad"] = True, 5, True
                        stick["supported_outputs"] = 4
                        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
                        hid = robot.pad.get_hid()
                        assert hid.get_gamepad_type() == wpilib.GenericHID.HIDType.PS4
                        assert int(hid.get_supported_outputs()) == stick["supported_outputs"] == 4
                        rumbles = [stick[f"{which}_rumble"] for which in ("left", "right_trigger")]
                        assert (rumbles, stick["leds"]) == ([0, 65535], 0x010203)
                        assert len(stick["buttons"]) == 26
                        assert hal_data["pcm"][0][3]["value"] is True
                        assert hal_data["addressable_led"][3]["data"] == [[10, 20, 30]] * 2
                        for value in ("yaw", "angle_x", "gyro_rate_z", "accel_y"):
                            imu[value] = 0.25
                            assert getattr(robot.imu, f"get_{value}")() == imu[value] == 0.25
                        hal_data["dio"][7]["value"] = False
                        hal_data["dio"][7]["value"] = True
                        assert not robot.hub_motor.is_hub_connected() and robot.edges.get_count() == 0


                @pytest.mark.parametrize(
                    "key",
                    ["analog_gyro", "analog_out", "analog_trigger", "relay", "counter", "accelerometer", "fpga_button"],
                )
                def test_what_there_is_not(hal_data, key):
                    with pytest.raises(KeyError):
                        hal_data[key]


                def test_how_many(hal_data):
                    lists = "pwm", "dio", "analog_in", "addressable_led"
                    assert [len(hal_data[key]) for key in lists] == [20, 31, 8, 6]
            """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output


def test_analog_inputs_measure_0_to_3_3_volts(make_project: MakeProject) -> None:
    """A sensor's whole range is what the simulator's slider and fuzz give; it was 5 V on the roboRIO."""
    (panel,) = panels_of({"analog_in[0].voltage": 0.0}, SimConfig())
    highest = panel.rows[0].high
    assert (highest, SPANS["volts"].high) == (3.3, 3.3)
    project = make_project(
        {
            "robot.py": """
                import wpilib


                class MyRobot(wpilib.TimedRobot):
                    def __init__(self):
                        super().__init__()
                        self.pot = wpilib.AnalogPotentiometer(0, 270.0)
            """,
            "tests/test_it.py": f"""
                def test_it(control, hal_data, robot):
                    with control.run_robot():
                        hal_data["analog_in"][0]["voltage"] = {highest}
                        assert abs(robot.pot.get() - 270) < 1e-3
            """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output
