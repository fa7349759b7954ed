"""WPILib 2026: a module for each topic. The package of another season has the same modules, with the same functions."""
