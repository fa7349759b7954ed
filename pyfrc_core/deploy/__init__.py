"""Deploying the robot program in one transaction over one SSH connection. Never imports wpilib."""
