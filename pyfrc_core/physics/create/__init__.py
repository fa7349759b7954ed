"""`pyfrc create-physics`: write a ``physics.py`` and a ``sim/config.json`` that fit the robot.

In: a project without physics. Out: both files, which the user completes. The robot runs in a separate process, where it
may crash, print or end. Its sticks are moved to see which motors follow, since code seldom says which motors drive. The
names in the code are the second source.
"""
