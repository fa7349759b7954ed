def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][4] = True
        hal_data["dio"][0]["value"] = False
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        if 1 in range(len(hal_data["dio"])):
            hal_data["dio"][1]["value"] = False
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
