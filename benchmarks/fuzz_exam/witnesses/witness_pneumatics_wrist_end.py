def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["analog_in"][0]["voltage"] = 5.0
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["dio"][2]["value"] = False
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
