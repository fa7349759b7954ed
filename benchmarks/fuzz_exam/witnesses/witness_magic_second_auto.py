def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=True, enabled=False)
        control.step_timing(seconds=6, autonomous=True, enabled=True)
        control.step_timing(seconds=1, autonomous=True, enabled=False)
        control.step_timing(seconds=6, autonomous=True, enabled=True)
