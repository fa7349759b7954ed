import wpilib


def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=True, enabled=False)
        wpilib.SmartDashboard.putBoolean("Wait for partner", True)
        control.step_timing(seconds=12, autonomous=True, enabled=True)
