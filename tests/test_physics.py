"""`PhysicsInterface`: one pose with two views, and the gyros that turn with it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import pytest
from hal import simulation as hs
from hypothesis import example, given
from hypothesis import strategies as st
from loops import for_each
from wpimath.geometry import Pose2d, Rotation2d, Transform2d
from wpimath.kinematics import ChassisSpeeds

from pyfrc.physics import drivetrains
from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.visionsim import VisionSimTarget
from pyfrc_core.hal import HalData
from pyfrc_core.wpi import station

FOOT = 0.3048
HEIGHT_FT = 27.0

speeds = st.floats(-20, 20)
turns = st.floats(-15, 15)
times = st.floats(0.001, 2)
distances = st.floats(-50, 50)


@pytest.fixture(autouse=True)
def _enabled() -> Iterator[None]:
    station.reset_driver_station()
    station.set_mode(enabled=True)
    yield
    hs.resetDriverStationData()


def controller(x: float = 0, y: float = 0, angle: float = 0, hal_data: HalData | None = None) -> PhysicsInterface:
    """A robot that starts here: feet, and degrees clockwise."""
    robot = {"starting_x": x, "starting_y": y, "starting_angle": angle}
    config = {"pyfrc": {"robot": robot, "field": {"w": 54, "h": HEIGHT_FT}}}
    return PhysicsInterface("", None, config, hal_data)


def same(one: Pose2d, other: Pose2d) -> bool:
    apart = one.relativeTo(other)
    turned = math.remainder(one.rotation().radians() - other.rotation().radians(), math.tau)
    return math.hypot(apart.X(), apart.Y()) < 1e-9 and abs(turned) < 1e-9


def test_it_starts_where_the_config_says() -> None:
    assert controller(2, 20, 0).get_position() == (2, 20, 0)
    assert controller(2, 20, 90).get_position() == pytest.approx((2, 20, math.pi / 2))


def test_forward_is_to_the_right_and_clockwise_is_downwards() -> None:
    robot = controller(10, 10)
    robot.drive(5, 0, 2)
    assert robot.get_position() == pytest.approx((20, 10, 0))
    robot.drive(0, math.pi / 2, 1)
    robot.drive(5, 0, 1)
    assert robot.get_position() == pytest.approx((20, 15, math.pi / 2))


def test_a_half_circle_ends_where_a_half_circle_does() -> None:
    robot = controller(10, 10)
    robot.drive(drivetrains.DriveVector(0, math.pi * 3, math.pi), 1)  # radius 3
    assert robot.get_position() == pytest.approx((10, 16, math.pi))


def test_the_pose_in_metres_has_y_upwards_from_the_bottom() -> None:
    pose = controller(10, 20, 30).get_pose()
    assert pose.X() == pytest.approx(10 * FOOT)
    assert pose.Y() == pytest.approx((HEIGHT_FT - 20) * FOOT)
    assert pose.rotation().degrees() == pytest.approx(-30)


def test_the_angle_goes_on_counting_beyond_a_full_turn() -> None:
    robot = controller()
    robot.drive(0, 4, 5)
    assert robot.get_position()[2] == pytest.approx(20)


def drives(speed: float, side: float, turn: float) -> list[Callable[[PhysicsInterface, float], object]]:
    """The same constant movement along an arc: feet and clockwise, metres and counter-clockwise."""
    metres = ChassisSpeeds(speed * FOOT, -side * FOOT, -turn)
    return [
        lambda robot, time: robot.drive(metres, time),
        lambda robot, time: robot.drive(metres, tm_diff=time),
        lambda robot, time: robot.drive(drivetrains.DriveVector(side, speed, turn), time),
    ]


@given(speeds, st.one_of(st.just(0.0), speeds), turns, times, st.floats(-180, 180))
def test_all_ways_to_say_a_movement_lead_to_one_pose(
    speed: float, side: float, turn: float, time: float, angle: float
) -> None:
    robots = []
    for drive in drives(speed, side, turn):
        robots.append(controller(5, 5, angle))
        drive(robots[-1], time)
    for robot in robots[1:]:
        assert same(robots[0].get_pose(), robot.get_pose())
        assert robot.get_position() == pytest.approx(robots[0].get_position(), abs=1e-9)


@given(speeds, st.one_of(st.just(0.0), speeds), turns, times, st.integers(0, 2))
def test_one_step_or_a_hundred_end_in_the_same_pose(
    speed: float, side: float, turn: float, time: float, way: int
) -> None:
    drive = drives(speed, side, turn)[way]
    once, often = controller(5, 5, 30), controller(5, 5, 30)
    drive(once, time)
    for _ in range(100):
        drive(often, time / 100)
    assert same(once.get_pose(), often.get_pose())


@given(st.lists(st.tuples(distances, distances, st.floats(-4, 4)), max_size=10))
@example([(0.0, 0.0, 1e-10), (50.0, 0.0, 0.0)] * 5)
def test_the_two_views_agree_after_any_moves(moves: list[tuple[float, float, float]]) -> None:
    feet, metres = controller(3, 4, 20), controller(3, 4, 20)
    for forward, right, turn in moves:
        feet.distance_drive(forward, right, 0)
        feet.distance_drive(0, 0, turn)
        metres.move_robot(Transform2d(forward * FOOT, -right * FOOT, Rotation2d(-turn)))
    assert same(feet.get_pose(), metres.get_pose())
    x, y, angle = feet.get_position()
    assert same(feet.get_pose(), Pose2d(x * FOOT, (HEIGHT_FT - y) * FOOT, Rotation2d(-angle)))


@given(speeds, turns, times)
def test_back_again_is_where_it_began(speed: float, turn: float, time: float) -> None:
    robot = controller(5, 5, 70)
    before = robot.get_pose()
    robot.drive(drivetrains.DriveVector(0, speed, turn), time)
    robot.drive(drivetrains.DriveVector(0, -speed, -turn), time)
    assert same(before, robot.get_pose())


@for_each(
    "start, move, end",
    [
        ((2, 20, 0), lambda robot: robot.distance_drive(3, 1, math.pi / 2), (1, 23, math.pi / 2)),
        ((2, 20, 90), lambda robot: robot.distance_drive(3, 1, 0), (1, 23, math.pi / 2)),
        # The direction of `drive` and of `vector_drive` forward is that after another such turn.
        ((0, 0, 0), lambda robot: robot.drive(1, math.pi / 4, 1), (0, 1, math.pi / 4)),
        ((0, 0, 0), lambda robot: robot.vector_drive(0, 1, math.pi / 4, 1), (0, 1, math.pi / 4)),
        ((0, 0, 0), lambda robot: robot.vector_drive(1, 0, math.pi / 4, 1), (0, 1, math.pi / 4)),
        ((0, 0, 0), lambda robot: robot.vector_drive(1, 2, 0, 0.5), (1, 0.5, 0)),
        ((0, 0, 0), lambda robot: robot.vector_drive(1, 2, 0.5, 0.5), (0.877583, 0.979426, 0.25)),
    ],
)
def test_moves_in_feet_turn_first_as_in_2019(
    start: tuple[float, float, float],
    move: Callable[[PhysicsInterface], object],
    end: tuple[float, float, float],
) -> None:
    robot = controller(*start)
    move(robot)
    assert robot.get_position() == pytest.approx(end, abs=1e-6)


@given(distances, distances, st.floats(-180, 180))
def test_a_coordinates_offset_leads_back_from_it(x: float, y: float, angle: float) -> None:
    distance, offset = controller(10, 10, angle).get_offset(x, y)
    assert -180 <= offset <= 180
    robot = controller(x, y, offset)
    robot.distance_drive(distance, 0, 0)
    assert robot.get_position()[:2] == pytest.approx((10, 10), abs=1e-9)


@for_each("heading", [0, 90, -30])
@for_each("target, offset", [((2, 21), -90), ((3, 20), 180), ((2, 19), 90), ((1, 20), 0), ((3, 21), -135)])
def test_the_offset_is_that_of_2019(heading: float, target: tuple[float, float], offset: float) -> None:
    assert controller(2, 20, heading).get_offset(*target) == pytest.approx((math.dist((2, 20), target), offset))


# -- while the robot is not enabled --------------------------------------------------------------------------------


def stop_in_an_emergency() -> None:
    hs.setDriverStationEStop(True)


@for_each(
    "stop",
    [lambda: station.set_mode(enabled=False), lambda: hs.setDriverStationDsAttached(False), stop_in_an_emergency],
)
def test_a_robot_that_is_not_enabled_rolls_on(stop: Callable[[], None]) -> None:
    """In all ways to move it: physics that set encoders by the wheels' speed move the pose with them."""
    stop()
    for drive in (*drives(5, 0, 0), lambda robot, time: robot.drive(5, 0, time)):
        robot = controller(10, 10)
        drive(robot, 2)
        assert robot.get_position() == pytest.approx((20, 10, 0))
    robot = controller(10, 10)
    robot.distance_drive(1, 2, math.pi)
    assert robot.get_position() == pytest.approx((9, 8, math.pi))


def test_an_engine_may_place_a_disabled_robot() -> None:
    station.set_mode(enabled=False)
    robot = controller()
    answer = robot.move_robot(Transform2d(1, 0, Rotation2d()))
    assert answer == robot.get_pose()
    assert robot.get_position()[0] == pytest.approx(1 / FOOT)
    robot.field.setRobotPose(Pose2d(2, 1, Rotation2d(0.5)))
    assert same(robot.move_robot(Transform2d(1, 0, Rotation2d())), Pose2d(2 + math.cos(0.5), 1 + math.sin(0.5), 0.5))


# -- gyros -----------------------------------------------------------------------------------------------------------


@pytest.fixture
def hal_data() -> Iterator[HalData]:
    """HAL, with its gyros at rest: HAL lives as long as the process, and other tests turn gyros too."""
    tree = HalData()
    _rest(tree)
    yield tree
    _rest(tree)


def _rest(tree: HalData) -> None:
    for gyro in tree["analog_gyro"]:
        gyro["angle"] = gyro["rate"] = 0.0


def test_analog_gyros_turn_with_the_robot(hal_data: HalData) -> None:
    robot = controller(hal_data=hal_data)
    robot.drive(3, math.radians(45), 1)
    robot.distance_drive(0, 0, math.radians(45))
    robot.vector_drive(0, 0, math.radians(10), 1)
    assert [gyro["angle"] for gyro in hal_data["analog_gyro"]] == pytest.approx([100, 100])
    hal_data["analog_gyro"][0]["angle"] = 0.0  # as when the robot resets it
    robot.drive(0, math.radians(-30), 1)
    assert [gyro["angle"] for gyro in hal_data["analog_gyro"]] == pytest.approx([-30, 70])


def test_analog_gyros_are_left_to_engines_in_metres(hal_data: HalData) -> None:
    robot = controller(hal_data=hal_data)
    robot.drive(ChassisSpeeds(0, 0, 1), 1)
    robot.move_robot(Transform2d(0, 0, Rotation2d(1)))
    assert hal_data["analog_gyro"][0]["angle"] == 0


def test_registered_gyros_turn_however_the_robot_moves(hal_data: HalData) -> None:
    key = "somegyro_spi_4_angle"
    robot = controller(hal_data=hal_data)
    robot.add_device_gyro_channel(key)
    robot.add_device_gyro_channel(key)  # it is one gyro all the same
    robot.drive(1, 1, 1)
    robot.drive(ChassisSpeeds(0, 0, -1), 1)
    robot.move_robot(Transform2d(0, 0, Rotation2d(-1)))
    assert hal_data["robot"][key] == pytest.approx(math.degrees(3))


def test_a_registered_gyro_is_there_while_the_robot_rests(hal_data: HalData) -> None:
    robot = controller(hal_data=hal_data)
    robot.add_device_gyro_channel("resting_spi_4_angle")
    robot.move_robot(Transform2d())
    assert hal_data["robot"].pop("resting_spi_4_angle") == 0


def test_what_is_no_longer_needed_can_still_be_called(hal_data: HalData) -> None:
    robot = controller(hal_data=hal_data)
    robot.add_analog_gyro_channel(1)
    robot.add_gyro_channel(1)
    robot.drive(0, 1, 1)
    assert hal_data["analog_gyro"][1]["angle"] == pytest.approx(math.degrees(1))


# -- drawing and mistakes --------------------------------------------------------------------------------------------


def test_vision_targets_are_shown_on_the_field() -> None:
    robot = controller()
    near, far = VisionSimTarget(10, 7, 0, 90), VisionSimTarget(20, 7, 0, 90)
    robot.draw_vision_targets([near, far], [near])
    shown = robot.field.getObject("vision targets").getPoses()
    assert [pose.X() for pose in shown] == pytest.approx([10 * FOOT, 20 * FOOT])
    assert [pose.Y() for pose in shown] == pytest.approx([20 * FOOT, 20 * FOOT])
    assert len(robot.field.getObject("vision targets in view").getPoses()) == 1


@for_each(
    "move",
    [
        lambda robot: robot.drive(math.nan, 0, 0.02),
        lambda robot: robot.drive(1, math.inf, 0.02),
        lambda robot: robot.vector_drive(1, 0, math.nan, 0.02),
        lambda robot: robot.distance_drive(0, math.nan, 0),
        lambda robot: robot.drive(ChassisSpeeds(0, math.nan, 0), 0.02),
        lambda robot: robot.move_robot(Transform2d(math.nan, 0, 0)),
    ],
)
def test_what_is_no_number_does_not_get_into_the_pose(move: Callable[[PhysicsInterface], object]) -> None:
    robot = controller(10, 10)
    with pytest.raises(ValueError, match="the robot cannot move by"):
        move(robot)
    assert robot.get_position() == (10, 10, 0)


@for_each("arguments", [(1.0,), (1.0, 2.0), (ChassisSpeeds(),), (ChassisSpeeds(), 1.0, 2.0)])
def test_a_call_that_cannot_be_says_what_can(arguments: tuple[float, ...]) -> None:
    with pytest.raises(TypeError, match=r"drive\(.+, tm_diff\) takes"):
        controller().drive(*arguments)  # type: ignore[call-overload]


def test_a_transform_is_for_move_robot() -> None:
    with pytest.raises(TypeError, match="and a time, not a Transform2d"):
        controller().drive(Transform2d(), 0.02)  # type: ignore[call-overload]
    with pytest.raises(TypeError, match="takes a Transform2d, not a NoneType"):
        controller().move_robot(None)  # type: ignore[arg-type]
