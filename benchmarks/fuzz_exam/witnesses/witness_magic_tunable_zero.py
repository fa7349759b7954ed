def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        robot.shooter.speed = 0.0
        hal_data["joysticks"][0]["buttons"][1] = True
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
