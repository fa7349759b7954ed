"""Measure the robot's code: which lines ran, and how long its functions took."""
