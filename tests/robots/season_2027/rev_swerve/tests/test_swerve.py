import pytest
from wpilib.simulation import XboxControllerSim


@pytest.mark.parametrize("way", ["left_y", "left_x", "right_x"])
def test_drives_and_knows_where_it_is(control, robot, physics_controller, way):
    gamepad = XboxControllerSim(0)
    with control.run_robot():
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        start, believed = physics_controller.get_pose(), robot.odometry.get_pose()
        getattr(gamepad, f"set_{way}")(-0.4)
        control.step_timing(seconds=2, autonomous=False, enabled=True)
        moved = physics_controller.get_pose().relative_to(start)
        thought = robot.odometry.get_pose().relative_to(believed)
        ways = {"left_y": moved.x, "left_x": moved.y, "right_x": moved.rotation().radians() % 6.3}
        assert ways[way] > 1
        assert moved.translation().distance(thought.translation()) < 0.1
        assert abs((moved.rotation() - thought.rotation()).degrees()) < 5
