"""Where WPILib 2027 is installed, and a project is for 2026, or the other way round: the same tests as in 2026."""

from pyfrc_core.season import SEASONS

if len(SEASONS) > 1:  # not without 2026: see .ci/run
    from test_season_of_a_project import *  # noqa: F403
