"""A `TimedRobot` of 2027, in place: modes, joysticks, outputs, timed callbacks, notifiers; and the same in each run."""

from __future__ import annotations

import re

import pytest
from conftest import MakeProject

ROBOT = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.stick, self.motor = wpilib.Joystick(0), wpilib_drivers.PWMSparkMax(3)
            self.input, self.encoder = wpilib.DigitalInput(4), wpilib.Encoder(0, 1)
            self.timer, self.calls = wpilib.Timer(), []
            self.fast = self.ticks = 0
            self.add_periodic(self.on_fast, 0.005)
            self.notifier = wpilib.Notifier(self.on_tick)
            self.notifier.start_periodic(0.01)

        def on_fast(self):
            self.fast += 1

        def on_tick(self):
            self.ticks += 1

        def autonomous_init(self):
            self.timer.restart()

        def autonomous_periodic(self):
            self.motor.set_throttle(0.5 if self.timer.get() < 1.0 else 0.0)

        def teleop_periodic(self):
            self.motor.set_throttle(-self.stick.get_y())

        def utility_init(self):
            self.calls.append("utility")

        def disabled_init(self):
            self.motor.set_throttle(0)
"""


def test_modes_controls_and_outputs(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_robot.py": """
                import wpilib
                from pytest import approx


                def test_teleop(control, hal_data, robot):
                    with control.run_robot():
                        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
                        stick = hal_data["joysticks"][0]
                        stick["axes"][1], stick["buttons"][3], stick["povs"][0] = -0.5, True, 135
                        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
                        assert hal_data["pwm"][3]["value"] == approx(0.5)
                        assert robot.stick.get_raw_button(3) and not robot.stick.get_raw_button(2)
                        assert robot.stick.get_pov() == wpilib.POVDirection.DOWN_RIGHT
                        assert stick["povs"][0] == 135
                        assert (robot.fast, robot.ticks) == (40, 20)
                        control.step_timing(seconds=0.1, autonomous=False, enabled=False)
                        assert hal_data["pwm"][3]["value"] == 0


                def test_autonomous(control, hal_data, robot):
                    with control.run_robot():
                        control.step_timing(seconds=0.5, autonomous=True, enabled=True)
                        assert hal_data["pwm"][3]["value"] == 0.5
                        assert (hal_data["control"]["autonomous"], control.get_mode()) == (True, "autonomous")
                        control.step_timing(seconds=1.0, autonomous=True, enabled=True)
                        assert hal_data["pwm"][3]["value"] == 0


                def test_utility_mode(control, hal_data, robot):
                    def on_step(now):
                        if now > 0.1:
                            control.set_test_mode()
                        return now < 0.3

                    control.run_test(on_step)
                    assert robot.calls == ["utility"]


                def test_sensors_and_match(control, hal_data, robot):
                    with control.run_robot():
                        hal_data["dio"][4]["value"] = False
                        hal_data["encoder"][0]["count"] = 12
                        hal_data["power"]["vin_voltage"] = 11.5
                        assert (robot.input.get(), robot.encoder.get()) == (False, 12)
                        assert hal_data["encoder"][0]["config"] == {"ASource_Channel": 0, "BSource_Channel": 1}
                        assert wpilib.RobotController.get_battery_voltage() == 11.5
                        control.game_specific_message = "LRL"
                        control.step_timing(seconds=0.1, autonomous=True, enabled=True)
                        assert wpilib.MatchState.get_game_data() == "LRL"
                        assert hal_data["event"]["game_specific_message"] == "LRL"
                        assert hal_data["alliance_station"] == "red1"
            """,
        }
    )
    result = project.run("test")
    assert "4 passed" in result.stdout, result.output


def test_the_ready_made_tests_pass(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT})
    result = project.run("test", "--builtin")
    assert result.code == 0, result.output


@pytest.mark.slow
def test_two_interpreters_have_the_same_trace(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_robot.py": "from pyfrc.tests import *\n"})
    hashes = set()
    for number in range(2):
        result = project.run("test", "--trace", f"traces{number}", "--", "-k", "practice")
        assert result.code == 0, result.output
        (trace,) = (project.path / f"traces{number}").glob("*.jsonl")
        hashes.add(trace.read_text("utf-8"))
    assert len(hashes) == 1


def test_an_error_in_robot_code_is_reported_with_its_line(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT.replace("-self.stick.get_y()", "1 / 0")})
    result = project.run("test", "--builtin")
    assert result.code == 1
    assert re.search(r"robot\.py:\d+: ZeroDivisionError", result.stdout), result.output
