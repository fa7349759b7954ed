def test_witness(control, hal_data, robot):
    operator = hal_data["joysticks"][1]
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
        operator["buttons"][7] = True
        operator["buttons"][1] = True
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        operator["axes"][2] = 1.0
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
