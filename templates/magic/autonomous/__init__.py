"""What the robot can do in autonomous: one mode a file, all of them on the dashboard to choose from."""
