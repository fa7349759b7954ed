"""Support of robot tests: fake time, the controller of the robot's state, and the pytest plugin with its fixtures."""
