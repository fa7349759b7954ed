"""`pyfrc create-physics`: a ``physics.py`` and a ``sim/config.json`` for the robot at hand."""
