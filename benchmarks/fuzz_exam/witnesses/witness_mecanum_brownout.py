from wpilib.simulation import RoboRioSim


def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["axes"][3] = 1.0
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        RoboRioSim.setVInVoltage(7.2)
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
