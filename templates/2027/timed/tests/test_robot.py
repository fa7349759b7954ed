"""Our own tests: the driver moves the sticks, and the robot drives.

`hal_data` has the robot's inputs and outputs, `control` is the driver station, and `physics_controller` has
the robot's pose: x and y in metres, its rotation counter-clockwise.
"""


def test_autonomous_leaves_the_starting_line(control, robot, physics_controller):
    start = physics_controller.get_pose()
    control.set_autonomous(enabled=True)
    control.run_test(lambda tm: tm < 3)  # for three seconds of robot time

    moved = physics_controller.get_pose().relative_to(start)
    assert 1.0 < moved.x < 2.0
    assert abs(moved.y) < 0.01


def test_the_right_stick_turns_on_the_spot(control, hal_data, robot, physics_controller):
    start = physics_controller.get_pose()
    hal_data["joysticks"][0]["axes"][2] = -0.5  # halfway to the left
    control.set_operator_control(enabled=True)
    control.run_test(lambda tm: tm < 0.5)

    moved = physics_controller.get_pose().relative_to(start)
    assert moved.rotation().degrees() > 30
    assert abs(moved.x) < 0.01


def test_a_disabled_robot_stands_still(control, hal_data, robot):
    hal_data["joysticks"][0]["axes"][1] = -1.0
    with control.run_robot():
        control.step_timing(seconds=1, autonomous=False, enabled=True)
        assert hal_data["pwm"][0]["value"] > 0.9
        control.step_timing(seconds=0.1, autonomous=False, enabled=False)
        assert hal_data["pwm"][0]["value"] == 0
