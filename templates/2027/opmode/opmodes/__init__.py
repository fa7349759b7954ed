"""The opmodes: what the robot can do in a match. WPILib looks for them here; the driver station lists them by name."""
