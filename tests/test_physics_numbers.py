"""The numbers that physics computes: the same in every season. `season_2027/` has these tests, too."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from conftest import MakeProject
from loops import for_each

from pyfrc.physics import drivetrains, motion, motor_cfgs, tankmodel
from pyfrc.physics.can_motors import Mechanism, SwerveDrive, SwerveModule
from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.units import units
from pyfrc.physics.visionsim import VisionSim
from pyfrc_core.wpi import motors, station


def tank() -> list[float]:
    model = tankmodel.TankModel.theory(motor_cfgs.MOTOR_CFG_CIM, 110 * units.lbs, 10.71, nmotors=4)
    controller = _controller()
    for step in range(100):
        controller.move_robot(model.calculate(0.9, -0.7 + step / 200, 0.02))
    return [model.l_position, model.r_position, model.l_velocity, model.r_velocity, *controller.get_position()]


def two_motors() -> list[float]:
    drivetrain = drivetrains.TwoMotorDrivetrain(22 * units.inch, 10 * units.feet / units.second)
    controller = _controller()
    for step in range(50):
        controller.drive(drivetrain.calculate(0.5, -0.6 + step / 100), 0.02)
    return [*drivetrain.get_vector(0.3, -0.2), drivetrain.wheelSpeeds.left, *controller.get_position()]


def mecanum() -> list[float]:
    drivetrain = drivetrains.MecanumDrivetrain(2, 3, 5, drivetrains.linear_deadzone(0.1))
    speeds = drivetrain.calculate(0.5, -0.3, -0.8, 0.05)
    controller = _controller()
    controller.drive(speeds, 0.5)
    vector = drivetrain.get_vector(0.5, -0.3, 0.8, 0.05)
    return [speeds.vx, speeds.vy, speeds.omega, *vector, drivetrain.lf_speed, *controller.get_position()]


def swerve() -> list[float]:
    controller = _controller()
    vector = drivetrains.four_motor_swerve_drivetrain(0.5, 0.4, 0.6, 0.3, 10, 20, -30, 15)
    controller.drive(vector, 0.5)
    return [*vector, *controller.get_position()]


class _Controller:
    """A motor controller with a given output."""

    motor = motors.with_gears(motors.usual_motor("SparkMax")[1](1), 1.0)
    gearing = 8.0

    def __init__(self, value: float) -> None:
        self.value = value

    def steps(self) -> int:
        return 5

    def output(self) -> float:
        return self.value

    def measure(self, turns: float, speed: float, tm_diff: float) -> None:
        """Nothing is measured."""


def can_swerve() -> list[float]:
    modules = []
    for number, (x, y) in enumerate([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)]):
        driving, steering = (Mechanism(_Controller(power), 0.02) for power in (0.5 + number / 10, 0.01))
        modules.append(SwerveModule(driving, steering, x, y, 0.1))
    drive = SwerveDrive(*modules)
    speeds = [drive.update(0.02) for _ in range(30)][-1]
    return [speeds.vx, speeds.vy, speeds.omega, modules[0].drive.turns, modules[3].drive.speed]


def lift() -> list[float]:
    moved = motion.LinearMotion("Lift", 2, 360, max_position=6)
    return [moved.compute(0.7, 0.02 * step) for step in range(10)] + [moved.position_ft]


def vision() -> list[float]:
    sim = VisionSim([VisionSim.Target(30, 10, 90, 270)], 60, 1, 25, data_frequency=15)
    seen = [sim.compute(0.1 * step, 15 + step, 5, 0.3) for step in (0, 3, 6)]
    return [number for sightings in seen if sightings for sighting in sightings for number in sighting]


def _controller() -> PhysicsInterface:
    station.reset_driver_station()
    station.set_mode(enabled=True)
    robot = {"starting_x": 3, "starting_y": 13, "starting_angle": 20}
    return PhysicsInterface("", None, {"pyfrc": {"robot": robot, "field": {"w": 54, "h": 27}}}, None)


NUMBERS: dict[Callable[[], list[float]], list[float]] = {
    tank: [
        19.06070390843847,
        8.688787702976242,
        10.275798705156266,
        1.6938329649228376,
        4.000835605462604,
        16.61070518847596,
        7.857965684087579,
    ],
    two_motors: [-2.5, -0.5454545454545455, -0.9144, 6.6984659749937245, 14.907474129959542, 1.139974941307957],
    mecanum: [
        0.38100000000000006,
        0.04233333333333337,
        0.2777777777777778,
        0.138888888888889,
        1.25,
        0.7222222222222223,
        3.8888888888888893,
        3.619392972749536,
        13.105662665148875,
        0.210176961509977,
    ],
    swerve: [
        0.001597324618111129,
        2.097092393722314,
        -0.06226381878580814,
        3.9904724111940926,
        13.343984551745143,
        0.31793394100596184,
    ],
    can_swerve: [2.263600128684834, 0.953392711033669, -0.07060094726818628, 3.1722304440153515, 9.622496828894127],
    lift: [0.0, 10.0, 30.0, 60.0, 100.0, 151.0, 211.0, 282.0, 362.0, 453.0, 1.2599999999999998],
    vision: [1.0, 0.0, 1.2462149689973145, 15.811388300841896, 1.0, 0.30000000000000004, 5.431131094115729, 13.0],
}


@for_each("computed", NUMBERS)
def test_numbers(computed: Callable[[], list[float]]) -> None:
    try:
        assert computed() == pytest.approx(NUMBERS[computed], rel=1e-12, abs=1e-12)
    finally:
        station.reset_driver_station()


#: In 2026, a PWM output has a resolution of about 0.004.
SAME_DRIVE = """
from pytest import approx


def test_same(control, hal_data, robot, physics_controller):
    def is_at(x, left, right, count):
        assert physics_controller.get_position() == approx((x, 13.2, 0), abs=0.02)  # feet
        outputs = [hal_data["pwm"][channel]["value"] for channel in range(4)]
        assert outputs == approx([left, left, right, right], abs=0.005)
        assert [hal_data["encoder"][index]["count"] for index in range(2)] == approx([count, count], abs=5)

    with control.run_robot():
        control.step_timing(seconds=1.5, autonomous=True, enabled=True)
        is_at(16.629, 0.49, -0.49, 1543)
        control.step_timing(seconds=0.5, autonomous=True, enabled=False)
        for stick in range(2):
            hal_data["joysticks"][stick]["axes"][1] = -0.7
        control.step_timing(seconds=1, autonomous=False, enabled=True)
        is_at(21.415, 0.482, -0.482, 2657)
"""


def test_a_template_drives_the_same_way(make_project: MakeProject) -> None:
    """Its code is that of the season; its script and what comes out are the same."""
    project = make_project({})
    assert project.run("init", "--template", "tank").code == 0
    project.write({"tests/test_same.py": SAME_DRIVE})
    result = project.run("test", "--", "-k", "test_same")
    assert result.code == 0, result.output
