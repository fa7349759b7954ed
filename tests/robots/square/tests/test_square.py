"""The robot drives its square, and its sensors say so."""

import json
import math
from pathlib import Path


def test_square(control, hal_data, physics_controller, robot_path):
    """Four corners, four feet apart, and back at the start; the gyro agrees with where the robot is."""
    path = []
    start = physics_controller.get_position()
    assert start == (10, 12, 0)

    def on_step(tm):
        path.append(physics_controller.get_position())
        return tm < 14

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    x, y, angle = path[-1]
    assert math.dist((x, y), start[:2]) < 0.1
    assert abs(math.degrees(angle) - 360) < 1.5
    for corner in ((14, 12), (14, 16), (10, 16)):  # y grows downwards: clockwise
        assert min(math.dist(corner, (x, y)) for x, y, _ in path) < 0.1

    assert abs(hal_data["analog_gyro"][0]["angle"] - math.degrees(angle)) < 1e-6
    pose = physics_controller.get_pose()
    assert abs(pose.X() / 0.3048 - x) < 1e-9
    assert abs(pose.rotation().radians() + angle) < 1e-9
    (Path(robot_path) / "path.json").write_text(json.dumps(path))


def test_encoders_and_gyro_agree_with_the_pose(control, hal_data, physics_controller, robot):
    """Out of a curve: the mean of the encoders is the way driven, their difference the turn."""
    hal_data["joysticks"][0]["axes"][1] = -0.6
    hal_data["joysticks"][0]["axes"][0] = 0.2
    control.set_operator_control(enabled=True)
    travelled = 0.0
    last = physics_controller.get_position()

    def on_step(tm):
        nonlocal travelled, last
        here = physics_controller.get_position()
        turned = here[2] - last[2]
        chord = math.dist(here[:2], last[:2])
        travelled += chord if turned == 0 else chord * (turned / 2) / math.sin(turned / 2)
        last = here
        return tm < 3

    control.run_test(on_step)
    left, right = (hal_data["encoder"][side]["count"] / 360 for side in (0, 1))
    assert travelled > 5
    assert abs((left + right) / 2 - travelled) < 0.01
    assert abs((left - right) / 2 - last[2]) < 0.01
    assert abs(hal_data["analog_gyro"][0]["angle"] - math.degrees(last[2])) < 1e-6


def test_stands_still_while_disabled(control, hal_data, physics_controller, robot):
    """Whatever the sticks say."""
    hal_data["joysticks"][0]["axes"][1] = -1.0
    control.set_operator_control(enabled=False)
    control.run_test(lambda tm: tm < 2)
    assert physics_controller.get_position() == (10, 12, 0)
