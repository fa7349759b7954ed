def test_witness(control, hal_data, robot):
    from wpilib.simulation import DriverStationSim

    with control.run_robot():
        DriverStationSim.setMatchTime(-1)
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        DriverStationSim.setMatchTime(-1)
        hal_data["joysticks"][0]["buttons"][6] = True
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
