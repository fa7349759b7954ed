"""What the components, the state machine and the autonomous mode do to the motors."""

from wpilib.simulation import DriverStationSim, PWMSim, XboxControllerSim

LEFT, RIGHT, WHEEL, FEEDER = range(4)
A = 1


def test_autonomous_drives_and_fires(control, robot, hal_data):
    """Two seconds of driving, one to spin up, half a second to feed."""
    seen = []

    def on_step(tm):
        seen.append([hal_data["pwm"][channel]["value"] for channel in range(4)])
        return tm < 6

    control.set_autonomous(enabled=True)
    control.run_test(on_step)

    assert sum(values[LEFT] == 0.5 for values in seen) == 100
    assert sum(values[RIGHT] == -0.5 for values in seen) == 100
    assert sum(values[WHEEL] == 1.0 for values in seen) == 75
    assert sum(values[FEEDER] == 0.5 for values in seen) == 25
    assert seen[-1] == [0.0, 0.0, 0.0, 0.0]
    assert robot.launcher_control.thrown == 1


def test_a_shot_is_given_up_while_spinning_up(control, robot, hal_data):
    """Half a second of A is not enough: the state machine starts over."""

    def on_step(tm):
        hal_data["joysticks"][0]["buttons"][A] = 1.0 <= tm < 1.5
        return tm < 4

    control.set_operator_control(enabled=True)
    control.run_test(on_step)

    assert robot.launcher_control.thrown == 0
    assert not robot.launcher_control.is_executing


def test_components_are_enabled_with_each_mode(control, robot):
    """Today's style: the stick drives while the robot is enabled, and only then."""
    with control.run_robot():
        gamepad = XboxControllerSim(0)
        left = PWMSim(LEFT)

        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
        gamepad.setLeftY(-1.0)
        DriverStationSim.notifyNewData()
        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
        assert left.getSpeed() == 0.0
        assert robot.drivetrain.enabled_times == 0

        control.step_timing(seconds=1.0, autonomous=False, enabled=True)
        assert left.getSpeed() == 1.0
        assert robot.drivetrain.enabled_times == 1

        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
        control.step_timing(seconds=0.5, autonomous=True, enabled=True)
        assert robot.drivetrain.enabled_times == 2
        assert robot.teleop_entered == 1
