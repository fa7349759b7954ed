"""The intake: with the beam broken, there is a game piece inside."""

from wpilib.simulation import DIOSim, PWMSim, XboxControllerSim


def teleop(control, seconds):
    control.step_timing(seconds=seconds, autonomous=False, enabled=True)


def test_takes_in_until_a_piece_is_inside(control, robot):
    gamepad, motor, beam = XboxControllerSim(0), PWMSim(2), DIOSim(4)
    with control.run_robot():
        gamepad.setAButton(True)
        teleop(control, 0.2)
        assert motor.getSpeed() > 0.5

        beam.setValue(False)
        teleop(control, 0.1)
        assert robot.container.intake.has_piece()
        assert motor.getSpeed() == 0


def test_spits_out_while_the_button_is_held(control, robot):
    gamepad, motor = XboxControllerSim(0), PWMSim(2)
    with control.run_robot():
        gamepad.setBButton(True)
        teleop(control, 0.2)
        assert motor.getSpeed() == -1.0
        gamepad.setBButton(False)
        teleop(control, 0.1)
        assert motor.getSpeed() == 0
