"""The parts of the robot that can do only one thing at a time."""
