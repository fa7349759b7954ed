"""A team's own rules: functions in its tests that are checked while the robot runs."""
