"""Simulate physics, in tests and in the simulator: compute sensor values and the robot's motion from its motors.

In: a project's `physics.py`, and the robot's outputs. Out: its sensors, and its pose on the field. `engine` imports the
file after the robot's modules, and calls it in each run, after the robot's loop. The other modules are what users build
physics of.

- Two generations of the interface work: that of 2019, and that of today's pyfrc. `engine` tells them apart by their
  signatures, so that users need no flag.
- There is one pose (`pose`), in feet and clockwise, as in sim/config.json. Metres and WPILib's axes are a view of it.
- Physics reads the outputs of a disabled robot as off (`hal.output_gate`), as the hardware does. Robot code, tests and
  traces see what the code has set.
- The tank model keeps its equations, because users have tuned numbers to them, but has no time steps: between two
  changes of voltage, `arc` computes the path at once. So the result does not depend on how often it is called.
- Quantities with units become plain numbers when they are passed (`quantities`): pint is imported only where it is
  used.
"""
