"""Fuzzing: matches in which everything the robot has is mashed, until something breaks; then the shortest way there."""
