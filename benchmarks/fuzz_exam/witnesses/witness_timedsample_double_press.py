def test_witness(control, hal_data, robot):
    buttons = hal_data["joysticks"][0]["buttons"]
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        buttons[2] = True
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        buttons[2] = False
        control.step_timing(seconds=0.06, autonomous=False, enabled=True)
        buttons[2] = True
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
