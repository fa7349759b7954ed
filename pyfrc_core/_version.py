"""The version: the season's year, then the release within it, as WPILib and robotpy number theirs."""

__version__ = "2026.1.0"
