"""Where WPILib 2027 is installed, and a project is for 2026, or the other way round: the same tests as in 2026."""

from test_season_of_a_project import *  # noqa: F403
