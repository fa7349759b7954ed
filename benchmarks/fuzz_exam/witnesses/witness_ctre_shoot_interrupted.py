def test_witness(control, hal_data, robot):
    operator = hal_data["joysticks"][1]
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
        hal_data["dio"][1]["value"] = False
        control.step_timing(seconds=0.3, autonomous=False, enabled=True)
        operator["axes"][3] = 1.0
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        operator["axes"][3] = 0.0
        control.step_timing(seconds=0.3, autonomous=False, enabled=True)
