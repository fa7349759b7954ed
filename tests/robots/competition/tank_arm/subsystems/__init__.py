"""The robot's subsystems."""
