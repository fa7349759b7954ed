"""magicsample_shots: fails with the patch, passes without it.

Needs: four complete shots (A held for about 6 s in all, or in autonomous) in one run of the program.
"""


def test_witness(control, hal_data, robot):
    with control.run_robot():
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        hal_data["joysticks"][0]["buttons"][1] = True
        control.step_timing(seconds=8, autonomous=False, enabled=True)
