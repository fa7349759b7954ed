"""What the robot's code did while it ran: which lines, and how long they took."""
