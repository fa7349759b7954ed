"""Simulate physics, in tests and in the simulator: compute sensor values and the robot's motion from its motors."""
