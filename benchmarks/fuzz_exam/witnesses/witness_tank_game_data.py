def test_witness(control, hal_data, robot):
    control.game_specific_message = "b"
    with control.run_robot():
        control.step_timing(seconds=1, autonomous=True, enabled=True)
        control.step_timing(seconds=1, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][1] = True
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
