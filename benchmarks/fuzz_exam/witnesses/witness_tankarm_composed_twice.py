def test_witness(control, hal_data, robot):
    operator = hal_data["joysticks"][1]
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)
        for _ in range(2):
            operator["povs"][0] = 270
            control.step_timing(seconds=0.3, autonomous=False, enabled=True)
            operator["povs"][0] = -1
            control.step_timing(seconds=0.3, autonomous=False, enabled=True)
