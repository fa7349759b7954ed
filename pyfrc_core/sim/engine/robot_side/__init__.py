"""What runs in the robot's process: the session between the robot and the `Simulation`."""
