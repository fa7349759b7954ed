"""What a loop of the robot's own does under the clock of the tests."""


def test_fifty_loops_a_second(control, robot):
    """Each wpilib.wait(0.02) takes 20 ms of robot time and nothing else does."""
    loops = {}

    def on_step(tm):
        loops[round(tm, 2)] = robot.loops["teleop"]
        return tm < 21

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    assert loops[2.0] - loops[1.0] == 50
    assert loops[21.0] - loops[1.0] == 1000


def test_every_mode_gets_its_second(control, robot):
    """Disabled, autonomous, teleop, test: the loop follows the driver station."""
    modes = []

    def on_step(tm):
        if tm < 1:
            control.set_operator_control(enabled=False)
        elif tm < 2:
            control.set_autonomous(enabled=True)
        elif tm < 3:
            control.set_operator_control(enabled=True)
        elif tm < 4:
            control.set_test_mode(enabled=True)
        else:
            control.set_test_mode(enabled=False)
        modes.append(control.get_mode())
        return tm < 5

    control.run_test(on_step)

    assert robot.loops["autonomous"] == 50
    assert robot.loops["teleop"] == 50
    assert robot.loops["test"] == 50
    assert list(dict.fromkeys(modes)) == ["disabled", "autonomous", "teleop", "test"]


def test_endcompetition_ends_the_loop(control, robot):
    """Today's style: the program runs inside the block, and has come to its end after it."""
    with control.run_robot():
        control.step_timing(seconds=1.0, autonomous=False, enabled=False)
        loops = robot.loops["disabled"]
        seconds = control.step_timing(seconds=1.0, autonomous=False, enabled=False)
        assert robot.loops["disabled"] - loops == round(seconds * 50)
        assert control.robot_is_alive

    assert not robot.running
