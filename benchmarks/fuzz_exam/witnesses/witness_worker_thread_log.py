def test_witness(control, hal_data, robot):
    with control.run_robot():
        hal_data["analog_in"][0]["voltage"] = 2.0
        control.step_timing(seconds=1, autonomous=False, enabled=True)
        hal_data["analog_in"][0]["voltage"] = 0.0
        control.step_timing(seconds=1, autonomous=False, enabled=True)
