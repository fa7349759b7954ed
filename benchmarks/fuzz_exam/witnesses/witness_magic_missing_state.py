from wpilib.simulation import PWMSim


def test_witness(control, hal_data, robot):
    with control.run_robot():
        hal_data["joysticks"][0]["buttons"][1] = True
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        while PWMSim(3).getSpeed() == 0:
            control.step_timing(seconds=0.02, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][2] = True
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
