"""What moves on the robot, and what tells the drivers about it: one module for each mechanism."""
