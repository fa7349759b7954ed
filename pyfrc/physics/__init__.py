"""The documented import names of the physics helpers."""
