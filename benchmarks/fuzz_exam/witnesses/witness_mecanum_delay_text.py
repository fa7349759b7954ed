import wpilib


def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=True, enabled=False)
        wpilib.SmartDashboard.putString("Auto delay", "1,5")
        control.step_timing(seconds=0.5, autonomous=True, enabled=True)
