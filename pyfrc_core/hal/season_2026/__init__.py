"""The devices of WPILib 2026. The package of another season has the same modules, with the same names."""
