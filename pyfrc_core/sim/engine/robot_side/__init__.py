"""What runs in the robot's process: the session between the robot and the `Simulation`.

Only this part of `sim` names WPILib.

In: commands over a connection. Out: updates. `session` lets robot time go on, carries out commands between two packets,
and reports what has changed. What dashboards write (`network`) is taken in at the same moments: in the middle of the
robot's loop, no recording could place it. While a robot in place waits in its loop, the clock does not return, so the
session does the same inside that wait.
"""
