"""The subsystems."""
