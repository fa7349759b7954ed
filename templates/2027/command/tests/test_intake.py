"""The intake: a broken beam means that a game piece is inside."""

from wpilib.simulation import DIOSim, PWMMotorControllerSim, XboxControllerSim


def teleop(control, seconds):
    control.step_timing(seconds=seconds, autonomous=False, enabled=True)


def test_takes_in_until_a_piece_is_inside(control, robot):
    gamepad, motor, beam = XboxControllerSim(0), PWMMotorControllerSim(2), DIOSim(4)
    with control.run_robot():
        gamepad.set_a_button(True)
        teleop(control, 0.2)
        assert motor.get_throttle() > 0.5

        beam.set_value(False)
        teleop(control, 0.1)
        assert robot.container.intake.has_piece()
        assert motor.get_throttle() == 0


def test_spits_out_while_the_button_is_held(control, robot):
    gamepad, motor = XboxControllerSim(0), PWMMotorControllerSim(2)
    with control.run_robot():
        gamepad.set_b_button(True)
        teleop(control, 0.2)
        assert motor.get_throttle() == -1.0
        gamepad.set_b_button(False)
        teleop(control, 0.1)
        assert motor.get_throttle() == 0
