def test_witness(control, hal_data, robot):
    hal_data["alliance_station"] = "unknown"
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][7] = True
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
