"""What robot tests use: fake time, the controller of the robot's state, the pytest plugin with its fixtures."""
