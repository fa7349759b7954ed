"""WPILib 2027: a module for each topic of `season_2026`, with the same functions."""
