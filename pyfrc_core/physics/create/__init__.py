"""`pyfrc create-physics`: write a ``physics.py`` and a ``sim/config.json`` that fit the robot."""
