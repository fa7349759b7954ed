"""The replaced names of WPILib 2027: modules with the same functions as in `season_2026`."""
