"""square_without_auto: fails with the patch, passes without it.

Needs: no autonomous since the program started; button 3 held in teleop.
"""


def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][3] = True
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
