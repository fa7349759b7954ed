"""The parts of the robot, one module each."""
