"""What the robot can do, where that takes more than a line."""
