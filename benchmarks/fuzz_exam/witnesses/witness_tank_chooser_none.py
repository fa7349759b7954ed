from contextlib import suppress

from wpilib.simulation import SendableChooserSim


def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=True, enabled=False)
        with suppress(Exception):  # with the bug, it fails here
            SendableChooserSim("/SmartDashboard/After the line/").setSelected("Stay")
        control.step_timing(seconds=0.2, autonomous=True, enabled=False)
        control.step_timing(seconds=4, autonomous=True, enabled=True)
