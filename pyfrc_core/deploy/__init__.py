"""Bringing the program onto the robot: one transaction over one connection. Never imports wpilib."""
