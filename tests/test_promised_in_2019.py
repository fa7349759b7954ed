"""What pyfrc's documentation of 2019 promised, and what tests and physics of that time do with it."""

from __future__ import annotations

import copy
import json
import math
import pickle
import re
from collections.abc import Iterator
from typing import Any

import pint
import pytest
import wpilib
from conftest import MakeProject, Result, RobotProject
from hal import simulation as hs
from loops import for_each
from sim_robots import run

from pyfrc.physics import drivetrains, motion, motor_cfgs, tankmodel
from pyfrc.physics.units import units
from pyfrc.physics.visionsim import VisionSim, VisionSimTarget
from pyfrc_core.hal import HalData
from pyfrc_core.hal.containers import LiveDict
from pyfrc_core.project import Project
from pyfrc_core.sim import SimOptions, Simulation


@pytest.fixture
def tree() -> Iterator[HalData]:
    hs.resetDriverStationData()
    yield HalData()
    hs.resetDriverStationData()


# -- hal_data is a dict ----------------------------------------------------------------------------------------------


def test_hal_data_is_a_dict_and_its_lists_are_lists(tree: HalData) -> None:
    assert isinstance(tree, dict)
    assert all(isinstance(tree[key], dict) for key in ("control", "event", "robot", "pcm", "CAN", "custom"))
    assert isinstance(tree["pwm"], list)
    assert isinstance(tree["pwm"][0], dict)
    assert isinstance(tree["joysticks"][0]["axes"], list)


def test_what_python_does_with_a_dict_finds_the_live_values(tree: HalData) -> None:
    tree["joysticks"][0]["axes"][1] = 0.5
    tree["custom"]["count"] = 3
    copies: list[Any] = [
        json.loads(json.dumps(tree)),
        json.loads(json.dumps(tree, indent=1)),
        copy.deepcopy(tree),
        pickle.loads(pickle.dumps(tree)),
        dict(tree),
        {**tree},
        tree.copy(),
        copy.copy(tree),
        tree | {},
        {} | tree,
        dict(tree.items()),
        dict(**tree),
    ]
    for number, each in enumerate(copies):
        assert type(each) is dict, number
        assert set(each) == set(tree), number
        assert each["joysticks"][0]["axes"][:2] == [0.0, 0.5], number
        assert each["custom"] == {"count": 3}, number
        assert len(each["pwm"]) == 20, number


def test_a_dict_of_hal_data_is_compared_by_its_values(tree: HalData) -> None:
    axes = tree["joysticks"][0]["axes"]
    axes[1] = 0.5
    expected = [0.0, 0.5, *[0.0] * 10]
    assert axes == expected
    assert expected == axes
    assert not axes != expected  # noqa: SIM202
    assert axes != [0.0] * 12
    assert axes > [0.0] * 12
    assert [0.0] * 12 <= axes  # noqa: SIM300
    assert 0.5 in axes
    assert axes.index(0.5) == 1
    relay = {"initialized": False, "fwd": False, "rev": False}
    assert tree["relay"][0] == relay == dict(tree["relay"][0])
    assert not tree["relay"][0] != relay  # noqa: SIM202
    assert tree["relay"][0] != {}
    assert {} != tree["relay"][0]  # noqa: SIM300
    empty = LiveDict("empty", dict)  # `tree["CAN"]` has what tests before have made
    assert not empty
    assert json.dumps(empty) == "{}"
    assert list(reversed(tree["relay"][0])) == ["rev", "fwd", "initialized"]


def test_what_python_does_with_a_list_finds_the_live_values(tree: HalData) -> None:
    povs = tree["joysticks"][0]["povs"]
    povs[2] = 90
    expected = [-1, -1, 90, *[-1] * 9]
    assert json.dumps(povs) == json.dumps(expected)
    assert [0] + povs == [0, *expected]  # noqa: RUF005
    assert povs + [0] == [*expected, 0]  # noqa: RUF005
    assert [*povs] == povs.copy() == copy.copy(povs) == copy.deepcopy(povs) == expected
    assert povs * 2 == 2 * povs == expected * 2
    assert (max(povs), sorted(povs)[-1], sum(povs), len(povs)) == (90, 90, 79, 12)
    assert povs[1:3] == [-1, 90]
    gathered: list[int] = []
    gathered.extend(povs)
    gathered += povs
    assert gathered == expected * 2
    povs[:] = [0] * 12
    assert povs == [0] * 12
    with pytest.raises(ValueError, match="2 values do not fit 3 entries"):
        povs[0:3] = [1, 2]
    for change in (lambda: povs.append(1), povs.clear, povs.pop, lambda: povs.extend([1]), povs.sort):
        with pytest.raises(TypeError, match=r"povs: the list has a fixed length"):
            change()
    with pytest.raises(TypeError, match="fixed length"):
        del povs[0]


def test_hal_data_can_be_updated_as_a_dict(tree: HalData) -> None:
    control = tree["control"]
    control |= {"enabled": True}
    assert tree["control"]["enabled"] is True
    assert hs.getDriverStationEnabled()
    tree.update(custom={"a": 1})
    assert tree["custom"] == {"a": 1}
    with pytest.raises(KeyError, match="cannot be removed"):
        tree.pop("pwm")
    with pytest.raises(KeyError, match="cannot be removed"):
        tree["control"].clear()
    tree["robot"]["some_angle"] = 1
    tree["robot"].clear()
    assert "some_angle" not in tree["robot"]
    assert dict.fromkeys("ab") == tree.fromkeys("ab")


def test_code_that_reads_a_dicts_own_storage_finds_a_remedy(tree: HalData) -> None:
    """Extensions in C may: an empty dict would look as if there were nothing."""
    assert "hal_data.snapshot()" in str(dict.items(tree["pwm"][0]))


# -- hal_data is written ---------------------------------------------------------------------------------------------


@for_each("path", ["pwm[19].value", "analog_out[0].voltage", "analog_out[7].voltage", "d0_pwm[0].duty_cycle"])
def test_none_is_a_value_of_outputs(tree: HalData, path: str) -> None:
    tree.write(path, None)
    assert tree.read(path) is None
    tree.write(path, 0.0)
    assert tree.read(path) == 0.0


@for_each("path", ["relay[3].fwd", "relay[3].rev", "solenoid[7].value", "dio[25].value", "pwm[19].raw_value"])
def test_none_turns_off_an_output_that_is_on_or_off(tree: HalData, path: str) -> None:
    tree.write(path, 1)
    assert tree.read(path)
    tree.write(path, None)
    assert not tree.read(path)


def test_none_is_no_value_of_an_input(tree: HalData) -> None:
    for path in ("encoder[0].count", "analog_in[0].voltage", "joysticks[0].axes[1]", "alliance_station"):
        with pytest.raises(TypeError, match="expected"):
            tree.write(path, None)


def test_a_loop_over_all_buttons(tree: HalData) -> None:
    for stick in tree["joysticks"]:
        buttons = stick["buttons"]
        for value in (True, False, 1, 0, True):
            for index in range(len(buttons)):
                buttons[index] = value
            assert all(button == value for button in buttons)
    hs.notifyDriverStationNewData()
    wpilib.DriverStation.refreshData()
    assert wpilib.DriverStation.getStickButtons(5) == 0xFFF
    assert dict(tree.leaves())["joysticks[5].buttons"] == [False, *[True] * 12]  # what the robot sees


#: The inputs of `hal_data`, each with a value that tests write; "*" stands for every entry of a list.
INPUTS: dict[str, Any] = {
    "alliance_station": "blue1", "fpga_button": True, "error_data": "x", "pwm_loop_timing": 40,
    "time": {"remaining": 15.0, "has_source": True},
    "event": {"name": "x", "match_type": 1, "match_number": 2, "replay_number": 1, "game_specific_message": "LRL"},
    "control": {"enabled": False, "autonomous": True, "test": False, "eStop": False, "dsAttached": True,
                "fmsAttached": True, "has_source": True},
    "joysticks.*": {"buttons": [False, True], "axes": [0.5, -1], "povs": [90], "name": "pad", "has_source": True},
    "joysticks.*.buttons.*": 1, "joysticks.*.axes.*": -0.5, "joysticks.*.povs.*": -1,
    "accelerometer": {"x": 1.0, "y": 0, "z": -1.0, "has_source": True},
    "robot": {"adxrs450_spi_0_angle": 3.0},
    "analog_gyro.*": {"angle": 90, "rate": 1.5},
    "analog_in.*": {"voltage": 2.5, "avg_voltage": 2.5, "value": 2048, "avg_value": 2048, "accumulator_value": 5,
                    "accumulator_count": 5, "lsb_weight": 1, "offset": 65535, "has_source": True},
    "compressor": {"on": True, "pressure_switch": True, "current": 3.0, "has_source": True},
    "dio.*": {"value": True, "has_source": True},
    "encoder.*": {"count": 10, "value": 11, "period": 0.5, "direction": True, "has_source": True},
    "counter.*": {"count": 10, "direction": True, "has_source": True},
    "power": {"vin_voltage": 12.0, "vin_current": 1.0, "has_source": True, **{
        f"user_{what}_{rail}": 0 for what in ("voltage", "current", "active", "faults") for rail in ("6v", "5v", "3v3")
    }},
    "pdp.0": {"temperature": 20.0, "voltage": 12.0, "total_power": 1.0, "total_energy": 2.0},
    "pdp.0.current.*": 1.5,
    "custom": {"label": 1},
}  # fmt: skip

# -- physics ---------------------------------------------------------------------------------------------------------


def tank_model() -> tankmodel.TankModel:
    return tankmodel.TankModel.theory(motor_cfgs.MOTOR_CFG_CIM, robot_mass=90 * units.lbs, gearing=10.71, nmotors=2)


@pytest.mark.parametrize("kind", [drivetrains.TwoMotorDrivetrain, drivetrains.MecanumDrivetrain])
def test_size_and_speed_of_a_drivetrain_are_set(kind: Any) -> None:
    drivetrain, other = kind(), kind(x_wheelbase=1, speed=10)
    assert (drivetrain.x_wheelbase, drivetrain.speed) == (2, 5)
    drivetrain.x_wheelbase, drivetrain.speed = 1, 10
    motors = (-1, 0.5) if kind is drivetrains.TwoMotorDrivetrain else (-1, 0.5, 0.2, 0.3)
    assert drivetrain.get_vector(*motors) == other.get_vector(*motors)
    assert str(drivetrain.wheelSpeeds) == str(other.wheelSpeeds)


def test_parameters_of_a_linear_motion_are_set() -> None:
    lift = motion.LinearMotion("lift", 2, 360, 6)
    assert (lift.name, lift.min_position, lift.max_position) == ("lift", 0, 6)
    lift.motor_ft_per_sec, lift.ticks_per_feet, lift.max_position = 4, 10, None
    assert lift.compute(1, 2) == 80


def test_errors_are_those_that_code_of_2019_catches() -> None:
    with pytest.raises(pint.DimensionalityError, match="robot_mass: 90 has no unit") as raised:
        tankmodel.TankModel.theory(motor_cfgs.MOTOR_CFG_CIM, 90, 10.71)
    assert str(pickle.loads(pickle.dumps(raised.value))) == str(raised.value)
    with pytest.raises(AssertionError):
        drivetrains.linear_deadzone(2)


def test_amps_are_amperes() -> None:
    assert 40 * units.amps == 40 * units.ampere


def test_attributes_of_a_tank_model_are_set() -> None:
    model, other = tank_model(), tank_model()
    for _ in range(10):
        model.get_distance(-1, 1, 0.02)
    model.l_position = model.r_position = 0
    model.l_velocity = model.r_velocity = 0
    # From here it does what a new one does: forward, and turning on the spot.
    assert model.get_distance(-1, 1, 0.02) == pytest.approx(other.get_distance(-1, 1, 0.02))
    assert model.get_distance(1, 1, 0.02) == pytest.approx(other.get_distance(1, 1, 0.02))
    assert (model.l_position, model.r_velocity) == pytest.approx((other.l_position, other.r_velocity))
    model.l_velocity = 4.0
    assert model.l_velocity == 4.0
    before = model.l_position
    model.get_distance(1, 1, 0.001)
    assert model.l_position - before == pytest.approx(0.004, rel=0.05)


def test_wheel_speeds_are_set() -> None:
    drive = drivetrains.MecanumDrivetrain()
    drive.get_vector(1, 1, 1, 1)
    drive.lr_speed = drive.rr_speed = 0
    drive.rf_speed = 2.0
    assert (drive.lr_speed, drive.rr_speed, drive.lf_speed, drive.rf_speed) == (0, 0, 5, 2)
    drive.calculate(1, 1, -1, -1)
    drive.rf_speed = 2.0
    assert (drive.rr_speed, drive.rf_speed) == (5, 2)


def motor_model(kv: float = 0.9, ka: float = 0.3, vi: float = 1.3) -> tankmodel.MotorModel:
    return tankmodel.MotorModel(motor_cfgs.MOTOR_CFG_CIM, kv * units.tm_kv, ka * units.tm_ka, vi * units.volt)


def test_attributes_of_a_motor_model_are_set() -> None:
    motor = motor_model()
    motor.compute(1, 0.1)
    motor.position, motor.velocity = 3.0, 2.0
    motor.compute(0, 0.0)
    assert (motor.position, motor.velocity) == (3.0, 2.0)
    motor.acceleration = 5.0
    assert (motor.acceleration, motor.velocity) == pytest.approx((5.0, 2.0))
    motor.compute(0, 0.01)
    assert motor.acceleration < 0
    motor.position = motor.velocity = 0.0
    motor.kv, motor.ka, motor.vintercept = 0.5 * units.tm_kv, 0.1 * units.tm_ka, 0.5 * units.volt
    other = motor_model(0.5, 0.1, 0.5)
    assert [motor.compute(0.7, 0.1) for _ in range(5)] == pytest.approx([other.compute(0.7, 0.1) for _ in range(5)])
    assert motor.kv.to("volt * second / foot").magnitude == pytest.approx(0.5)
    with pytest.raises(ValueError, match="kv"):
        motor.kv = 0.5


def test_methods_and_attributes_of_models_are_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    model, motor = tank_model(), motor_model()
    monkeypatch.setattr(model, "get_distance", lambda *_: (1.0, 0.0, 0.0))
    monkeypatch.setattr(motor, "compute", lambda *_: 7.0)
    model.my_own = motor.my_own = 1  # type: ignore[attr-defined]
    assert (model.get_distance(0, 0, 0), motor.compute(0, 0)) == ((1.0, 0.0, 0.0), 7.0)
    assert copy.deepcopy(tank_model()).get_distance(-1, 1, 0.02) == tank_model().get_distance(-1, 1, 0.02)


def test_a_vision_target_computes() -> None:
    target = VisionSim.Target(10, 10, 90, 270)
    assert target.compute(1.5, 4, 10, 0.0) == (1, 1.5, 0.0, 6.0)
    assert target.compute(now=2, x=10, y=12, angle=0) == pytest.approx((1, 2, -90.0, 2.0))
    assert target.compute(1.5, 16, 10, math.pi) is None


def test_a_vision_target_of_ones_own() -> None:
    class Moving(VisionSimTarget):
        def compute(self, now: float, x: float, y: float, angle: float) -> Any:
            self.x += 1.0
            return super().compute(now, x, y, angle)

    sim = VisionSim([Moving(9, 10, 0, 360)], 60, 1, 20)
    assert sim.compute(0.0, 4, 10, 0.0) is None
    assert sim.compute(1.0, 4, 10, 0.0) == [(1, 0.0, 0.0, 6.0)]
    assert sim.get_immediate_distance() == 7.0


# -- in a project ----------------------------------------------------------------------------------------------------

ROBOT = """
    import threading

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        work = None

        def robotInit(self):
            self.stick = wpilib.Joystick(0)
            self.motor = wpilib.PWMSparkMax(8)
            self.compressor = wpilib.Compressor(0, wpilib.PneumaticsModuleType.CTREPCM)
            self.piston = wpilib.Solenoid(0, wpilib.PneumaticsModuleType.CTREPCM, 3)
            self.power = wpilib.PowerDistribution(0, wpilib.PowerDistribution.ModuleType.kCTRE)
            self.devices = [wpilib.Encoder(0, 1), wpilib.AnalogInput(3), wpilib.DigitalInput(9), wpilib.AnalogGyro(1)]
            self.gyro = wpilib.ADXRS450_Gyro()
            self.switch, self.distance = wpilib.DigitalInput(6), wpilib.AnalogInput(2)
            self.first = self.switch.get(), wpilib.DigitalInput(7).get(), self.distance.getVoltage()
            self.messages = set()
            if self.work is not None:
                threading.Thread(target=self.work, daemon=True).start()

        def autonomousPeriodic(self):
            self.messages.add(wpilib.DriverStation.getGameSpecificMessage())

        def teleopPeriodic(self):
            self.motor.set(self.stick.getY())
"""

PHYSICS = """
    class PhysicsEngine:
        def __init__(self, physics_controller):
            self.controller = physics_controller
            robot = physics_controller.config_obj["pyfrc"]["robot"]
            self.size = robot["w"], robot["h"], robot["l"], robot["starting_x"]

        def initialize(self, hal_data):
            assert hal_data["pcm"][0][3]["value"] in (None, False)
            hal_data["pcm"][0][3]["value"] = None
            hal_data["pdp"][0]["voltage"] = 11.5
            hal_data["dio"][7]["value"] = False

        def update_sim(self, hal_data, now, tm_diff):
            assert hal_data["pwm"][8]["value"] is None or abs(hal_data["pwm"][8]["value"]) <= 1
            hal_data["custom"].update({"tm_diff": tm_diff, "count": 3, "of each": {"a": [1, 2.5, True], 2: None}})
"""

CONFIG = """
    {"other tool": {"a": [1]},
     "pyfrc": {"robot": {"w": 2, "h": 4, "starting_x": 3}, "game_specific_messages": ["LRL", "RRR"],
               "pwm": {"8": "Lift"}, "joysticks": {"0": {"axes": {"x": "Turn"}}}}}
"""

TESTS = r"""
    import threading

    import pytest
    import wpilib as wpi

    from pyfrc.test_support.fake_time import TestRanTooLong


    def test_nothing_returned_goes_on(control, fake_time):
        times = []
        control.set_practice_match()
        control.run_test(times.append)
        assert len(times) > 100
        assert fake_time.get() == pytest.approx(2.7, abs=0.05)


    def test_nothing_returned_by_a_class(control, fake_time):
        class Driver:
            steps = 0

            def on_step(self, tm):
                self.steps += 1

        control.set_practice_match()
        assert control.run_test(Driver).steps > 100


    def test_false_ends_a_match(control, fake_time):
        control.set_practice_match()
        control.run_test(lambda tm: tm < 1)
        assert fake_time.get() == 1


    def test_outside_of_a_match_nothing_returned_ends_the_run(control, fake_time):
        control.set_autonomous()
        with pytest.warns(UserWarning, match="returned None, which ends the run at 0.02 s: return True") as warned:
            control.run_test(lambda tm: None)
        assert warned[0].filename == __file__
        assert control.ended_early.startswith(f"{__file__}:{warned[0].lineno}: ")
        assert fake_time.get() == 0.02


    def test_a_second_run_is_an_assertion_error(control):
        control.run_test(lambda tm: False)
        with pytest.raises(AssertionError, match=r"has run already in this test, at tests/test_\w+\.py:\d+\. It can"):
            control.run_test(lambda tm: False)
        with pytest.raises(AssertionError, match="must be called before run_test"):
            control.set_practice_match()


    def test_what_cannot_be_called_is_a_value_error(control):
        for controller in (None, 5, object()):
            with pytest.raises(ValueError, match="run_test"):
                control.run_test(controller)


    class WithoutSelf:
        def on_step(tm):
            return True


    class NeedsMore:
        def __init__(self, speed):
            self.speed = speed

        def on_step(self, tm):
            return True


    def test_what_cannot_be_called_with_the_time_is_a_value_error(control, fake_time):
        wrong = {
            "lambda": (lambda: True, lambda tm, speed: True, lambda *, tm: True),
            "WithoutSelf.on_step": (WithoutSelf, WithoutSelf()),
            "NeedsMore": (NeedsMore,),
        }
        for name, controllers in wrong.items():
            for controller in controllers:
                with pytest.raises(ValueError, match=rf"run_test\(controller\): .*{name}.*\("):
                    control.run_test(controller)
        control.run_test(lambda tm, speed=1: tm < 1)  # the robot can still run
        assert fake_time.get() == 1


    @pytest.mark.parametrize("controller", [[].append, lambda *times: False, NeedsMore(1)])
    def test_what_can_be_called_with_the_time(control, fake_time, controller):
        fake_time.set_time_limit(1)
        try:
            control.run_test(controller)
        except TestRanTooLong:
            assert isinstance(controller, NeedsMore)


    def test_time_limits(control, fake_time):
        assert fake_time.time_limit == 500
        fake_time.set_time_limit(None)
        assert fake_time.time_limit is None
        fake_time.increment_time_by(600)
        fake_time.increment_time_by(0)
        assert fake_time.get() == 600
        fake_time.time_limit = 601
        with pytest.raises(TestRanTooLong):
            fake_time.increment_time_by(1.01)
        fake_time.reset()
        assert (fake_time.get(), fake_time.time_limit) == (0, 500)


    @pytest.mark.parametrize("wrong", [-1, float("nan"), float("inf"), "a", None])
    def test_what_is_no_duration_is_a_value_error(control, fake_time, wrong):
        with pytest.raises(ValueError, match=r"^increment_time_by\(.*\): .* seconds"):
            fake_time.increment_time_by(wrong)
        with pytest.raises(ValueError, match=r"^step_timing\(seconds=.*\): .* seconds"):
            control.step_timing(seconds=wrong, autonomous=True, enabled=True, assert_alive=False)
        if wrong is not None:
            with pytest.raises(ValueError, match=r"^set_time_limit\(.*\): .* seconds .*, or None"):
                fake_time.set_time_limit(wrong)
            with pytest.raises(ValueError):
                fake_time.time_limit = wrong
        assert (fake_time.get(), fake_time.time_limit) == (0, 500)


    def check_digital_input(control, hal_data, robot, value):
        hal_data["dio"][6]["value"] = value
        hal_data["analog_in"][2]["voltage"] = 3.3
        control.run_test(lambda tm: tm < 0.1)
        assert robot.first == (value, False, pytest.approx(3.3, abs=0.01))
        for later in (not value, value):
            hal_data["dio"][6]["value"] = later
            assert robot.switch.get() is later


    def test_a_digital_input_keeps_false(control, hal_data, robot):
        check_digital_input(control, hal_data, robot, False)


    def test_a_digital_input_keeps_true(control, hal_data, robot):
        hal_data["dio"][6]["value"] = False
        check_digital_input(control, hal_data, robot, True)


    def test_docstrings_asks_nothing_of_physics(robot, robot_path):
        import physics

        from pyfrc.tests.docstring_test import test_docstrings

        with pytest.raises(AssertionError) as raised:
            test_docstrings(robot, robot_path)
        assert "robot.py" in str(raised.value)
        assert "physics.py" not in str(raised.value)


    def test_ready_made_practice(control, fake_time, robot):
        from pyfrc.tests.basic import test_practice

        test_practice(control, fake_time, robot)
        assert robot.messages == {"LRL"}


    def test_none_shows_whether_the_robot_sets_a_motor(control, hal_data, robot):
        class Driver:
            before = None

            def on_step(self, tm):
                pwm = hal_data["pwm"][8]
                if self.before is not None:
                    assert pwm["value"] == pytest.approx(self.before, abs=0.01)
                    pwm["value"] = None
                    assert pwm["value"] is None
                    assert hal_data.snapshot()["pwm"][8]["value"] is None
                    assert robot.motor.get() == pytest.approx(0)
                self.before = hal_data["joysticks"][0]["axes"][1] = 0.5 if int(tm * 10) % 2 else 0.0
                return tm < 1

        control.set_operator_control()
        control.run_test(Driver)


    def test_none_stays_while_the_robot_does_nothing(control, hal_data):
        def on_step(tm):
            if tm == 0.5:
                hal_data["pwm"][8]["value"] = None
            return tm < 1

        control.set_autonomous()
        control.run_test(on_step)
        assert hal_data["pwm"][8]["value"] is None
        hal_data["pwm"][8]["value"] = 0.5
        assert hal_data["pwm"][8]["value"] == 0.5


    def test_none_stays_while_physics_of_a_disabled_robot_runs(control, hal_data):
        def on_step(tm):
            if tm == 0.1:
                hal_data["pwm"][8]["value"] = None
            return tm < 0.2

        control.set_operator_control(enabled=False)
        control.run_test(on_step)
        assert hal_data["pwm"][8]["value"] is None


    def test_pneumatics_and_power(control, hal_data, robot):
        assert hal_data["pcm"][0] is hal_data["solenoid"]
        hal_data["pcm"][0][3]["value"] = True
        assert hal_data["solenoid"][3]["value"] is hal_data.read("pcm[0][3].value") is True
        hal_data["solenoid"][3]["value"] = False
        assert hal_data["pcm"][0][3]["value"] is False
        assert not hal_data["pcm"]
        assert not hal_data["pdp"]
        hal_data["pdp"][0]["current"][2] = 4
        assert (hal_data["pdp"][0]["voltage"], hal_data["pdp"][0]["total_current"]) == (11.5, 4.0)
        with control.run_robot():
            assert robot.power.getVoltage() == 11.5
            robot.piston.set(True)
            assert hal_data["pcm"][0][3]["value"] is True
            assert list(hal_data["pcm"]) == list(hal_data["pdp"]) == [0]


    def test_config_obj(physics_controller):
        config = physics_controller.config_obj
        assert type(config) is dict
        assert config["other tool"] == {"a": [1]}
        found = config["pyfrc"]
        assert type(found["robot"]) is dict
        assert found["robot"] == {
            "w": 2, "h": 4, "l": 4, "starting_x": 3, "starting_y": 0, "starting_angle": 0, "start_positions": []
        }
        assert (found["pwm"], found["field"]["w"]) == ({"8": "Lift"}, 54.25)
        assert found["game_specific_messages"] == ["LRL", "RRR"]
        assert found["joysticks"]["0"]["axes"] == {"x": "Turn", "0": "Turn"}
        config["mine"] = 1


    def test_time_in_a_thread_of_the_robot(control, fake_time, robot):
        seen = []

        def work():
            seen.append(fake_time.get())
            fake_time.increment_time_by(0.05)
            seen.append(fake_time.get())
            fake_time.increment_new_packet()
            seen.append(fake_time.get())
            wpi.simulation.stepTiming(0.1)
            seen.append(fake_time.get())
            fake_time.set_time_limit(100)
            for call in (fake_time.initialize, fake_time.reset, lambda: control.run_test(lambda tm: True)):
                with pytest.raises(RuntimeError, match="it sleeps in robot time"):
                    call()
            fake_time.increment_time_by(50)

        robot.work = work
        control.set_operator_control()
        control.run_test(lambda tm: tm < 1)
        assert seen == pytest.approx([0, 0.05, 0.06, 0.16])
        assert fake_time.get() == 1


    def test_the_time_limit_in_a_thread_of_the_robot(control, fake_time, robot):
        fake_time.set_time_limit(2)

        def work():
            fake_time.increment_time_by(3)

        robot.work = work
        with pytest.raises(TestRanTooLong):
            control.run_test(lambda tm: True)


    def test_time_in_a_thread_that_knows_no_robot_time(control, fake_time):
        seen = []

        def attempt(call):
            try:
                call()
            except Exception as problem:
                seen.append(problem)

        def work():
            for call in (
                lambda: fake_time.increment_time_by(0.05),
                fake_time.increment_new_packet,
                fake_time.initialize,
                fake_time.reset,
                lambda: wpi.simulation.stepTiming(0.1),
                lambda: control.run_test(lambda tm: tm < 1),
                lambda: control.step_timing(seconds=1, autonomous=False, enabled=True, assert_alive=False),
            ):
                attempt(call)
            fake_time.set_time_limit(50)
            seen.append(fake_time.get())

        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        *problems, now = seen
        assert now == 0
        for problem in problems:
            assert isinstance(problem, RuntimeError), repr(problem)
            assert "does not live in robot time" in str(problem)
        assert len(problems) == 7
        control.run_test(lambda tm: tm < 1)
        assert fake_time.get() == 1


    def test_custom_keeps_what_is_set(control, hal_data):
        from enum import Enum

        class State(Enum):
            UP = 1

        values = {"int": 3, "float": 1.0, "nested": {"a": [1, 2.5, True], 2: None}, "text": "1", "state": State.UP}
        hal_data.setdefault("custom", {})["My Label"] = "---"
        hal_data["custom"].update(values)
        with control.run_robot():
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        for key, value in values.items():
            assert hal_data["custom"][key] == value
            assert type(hal_data["custom"][key]) is type(value)
        assert hal_data["custom"]["tm_diff"] == 0.02
        shown = hal_data.snapshot()["custom"]
        assert (shown["int"], shown["float"], shown["state"]) == (3, 1.0, "State.UP")
        assert type(shown["int"]) is int


    INPUTS = __INPUTS__


    def places(place, path):
        key, *rest = path
        keys = [int(key) if key.isdigit() else key]
        if key == "*":
            keys = list(place) if isinstance(place, dict) else list(range(len(place)))
        for each in keys:
            yield from places(place[each], rest) if rest else [(place, each)]


    def write_all(hal_data):
        for path, value in INPUTS.items():
            for place, key in places(hal_data, path.split(".")):
                for field, each in value.items() if isinstance(value, dict) else [(None, value)]:
                    owner, name = (place, key) if field is None else (place[key], field)
                    owner[name] = each
                    found = owner[name]
                    assert found[: len(each)] == each if isinstance(each, list) else found == each, (path, name)


    def test_every_documented_input_can_be_written(control, hal_data, robot):
        write_all(hal_data)
        with control.run_robot():
            write_all(hal_data)
"""

TESTS_NAMES = re.findall(r"def (test_\w+)\(", TESTS)


@pytest.fixture(scope="module")
def project(make_shared_project: MakeProject) -> RobotProject:
    """A robot with tests and physics of 2019."""
    return make_shared_project(
        {
            "robot.py": ROBOT,
            "physics.py": PHYSICS,
            "sim/config.json": CONFIG,
            "tests/test_of_2019.py": TESTS.replace("__INPUTS__", repr(INPUTS)),
            "pyproject.toml": "[tool.pyfrc.match]\nbefore = 0.1\nautonomous = 1\npause = 0.1\nteleop = 1.5\n",
        }
    )


@pytest.fixture(scope="module")
def outcomes(project: RobotProject) -> Result:
    """How the tests of 2019 went."""
    return project.run("test", "--", "-v", "-p", "no:cacheprovider", "-W", "ignore")


@for_each("name", TESTS_NAMES)
def test_in_a_project(name: str, outcomes: Result) -> None:
    of_name = [each for test, each in outcomes.outcomes().items() if test.rpartition("::")[2].partition("[")[0] == name]
    assert set(of_name) == {"PASSED"}, outcomes.blocks().get(name, outcomes.output)


def test_the_simulator_shows_numbers_as_numbers(project: RobotProject) -> None:
    with Simulation(Project(project.path / "robot.py"), SimOptions(speed=0, paused=True)) as simulation:
        run(simulation, 0.1)
        assert simulation.snapshot is not None
        values = simulation.snapshot.values
    assert (values["custom.tm_diff"], values["custom.count"]) == (0.02, 3)
    assert type(values["custom.count"]) is int
    assert values['custom["of each"]'] == {"a": (1, 2.5, True), "2": None}
