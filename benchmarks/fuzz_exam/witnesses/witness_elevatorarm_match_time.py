"""elevatorarm_match_time: fails with the patch, passes without it.

Needs: right bumper pressed in teleop; match time is -1 (no field, no practice mode).
"""


def test_witness(control, hal_data, robot):
    from wpilib.simulation import DriverStationSim

    with control.run_robot():
        DriverStationSim.setMatchTime(-1)
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        DriverStationSim.setMatchTime(-1)
        hal_data["joysticks"][0]["buttons"][6] = True
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
