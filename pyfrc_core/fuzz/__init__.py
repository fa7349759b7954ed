"""Fuzzing: run matches with random inputs until the robot fails, then find the shortest script of the failure."""
