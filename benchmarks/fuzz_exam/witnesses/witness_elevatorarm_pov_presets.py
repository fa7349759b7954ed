def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        for _ in range(4):
            hal_data["joysticks"][0]["povs"][0] = 0
            control.step_timing(seconds=0.2, autonomous=False, enabled=True)
            hal_data["joysticks"][0]["povs"][0] = -1
            control.step_timing(seconds=0.2, autonomous=False, enabled=True)
