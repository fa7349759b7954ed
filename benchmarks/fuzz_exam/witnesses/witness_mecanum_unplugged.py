from wpilib.simulation import DriverStationSim


def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][1] = True
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][1] = False
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        DriverStationSim.setJoystickAxisCount(0, 0)
        DriverStationSim.setJoystickButtonCount(0, 0)
        DriverStationSim.setJoystickPOVCount(0, 0)
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
