def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][5] = True
        hal_data["joysticks"][0]["axes"][1] = 0.05
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["axes"][4] = 0.7
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
