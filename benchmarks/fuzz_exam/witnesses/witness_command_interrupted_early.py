def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][3] = True
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][3] = False
        control.step_timing(seconds=0.5, autonomous=False, enabled=False)
