"""The project's settings and sim/config.json, as typed objects."""
