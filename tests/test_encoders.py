"""Sensors that physics turns behave as on the robot when the robot resets them and reads their rates."""

from __future__ import annotations

import pytest
from conftest import MakeProject

from pyfrc_core.wpi import encoder_channels

ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.encoder = wpilib.Encoder(0, 1)
            self.encoder.setDistancePerPulse(0.01)
            self.gyro = wpilib.ADXRS450_Gyro()

        def autonomousInit(self):
            self.encoder.reset()
"""
PHYSICS = """
    from pyfrc.physics.encoders import EncoderShaft

    class PhysicsEngine:
        def __init__(self, physics_controller, robot):
            self.physics_controller = physics_controller
            self.shaft = EncoderShaft(robot.encoder, units=2.0)
            physics_controller.add_device_gyro_channel("adxrs450_spi_0_angle")
            self.position = 0.0

        def update_sim(self, now, tm_diff):
            self.position += 3.0 * tm_diff
            self.shaft.turn_to(self.position, 3.0)
            self.physics_controller.drive(0, 1.0, tm_diff)  # 1 rad/s clockwise, as documented in 2019
"""


def test_an_encoder_counts_from_its_reset_and_has_a_rate(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "physics.py": PHYSICS,
            "tests/test_it.py": """
            import math
            import pytest

            def test_it(control, robot):
                with control.run_robot():
                    control.step_timing(seconds=1, autonomous=False, enabled=True)
                    assert robot.encoder.getDistance() == pytest.approx(6, abs=0.2)
                    assert robot.encoder.getRate() == pytest.approx(6)
                    control.step_timing(seconds=1, autonomous=True, enabled=True)
                    assert robot.encoder.getDistance() == pytest.approx(6, abs=0.2)
                    assert robot.gyro.getRate() == pytest.approx(math.degrees(1))
            """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output


def test_a_shaft_refuses_what_is_not_a_number(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "physics.py": PHYSICS.replace("self.position, 3.0", "0.0, float('inf')"),
        }
    )
    result = project.run("test", "--builtin")
    assert result.code == 1
    assert "ParameterError" in result.output
    assert "must be a finite number" in result.output


@pytest.mark.parametrize("made", ["bChannel=3, aChannel=2", "wpilib.DigitalInput(2), wpilib.DigitalInput(3)"])
def test_the_channels_of_an_encoder(made: str, make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": f"""
                import wpilib

                class Turner(wpilib.Encoder):
                    def __init__(self):
                        super().__init__({made})

                class MyRobot(wpilib.TimedRobot):
                    def robotInit(self):
                        self.first, self.turner = wpilib.Encoder(0, 1), Turner()
            """,
            "tests/test_it.py": """
            def test_it(control, robot, hal_data):
                with control.run_robot():
                    channels = [each["config"] for each in hal_data["encoder"]]
                    assert channels[:2] == [
                        {"ASource_Channel": 0, "BSource_Channel": 1}, {"ASource_Channel": 2, "BSource_Channel": 3}
                    ]
                    assert channels[2] == {"ASource_Channel": None, "BSource_Channel": None}
            """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output


def test_an_encoders_channels_are_those_of_its_constructor(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(encoder_channels, "_channels", {})
    encoder_channels.note(0, 2, 3)
    encoder_channels.note(1, 2, bChannel=3)
    encoder_channels.note(2, aChannel=2, bChannel=3, reverseDirection=True)
    encoder_channels.note(3, a_channel=2, b_channel=3)  # as in 2027
    assert [encoder_channels.channels_of(index) for index in range(5)] == [(2, 3)] * 4 + [None]
