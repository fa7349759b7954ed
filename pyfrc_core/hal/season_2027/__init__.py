"""The devices of WPILib 2027: modules of the same names as in `season_2026`."""
