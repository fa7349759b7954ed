"""pneumatics_waits: fails with the patch, passes without it.

Needs: button 4 pressed in teleop; the lift does not go up a quarter of a metre within 2 s.
"""


def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][4] = True
        control.step_timing(seconds=3, autonomous=False, enabled=True)
