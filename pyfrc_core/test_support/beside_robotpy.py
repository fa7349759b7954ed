"""Our fixtures in `robotpy test` of WPILib 2027, which has none of them: each fails, and says what to do.

Without these, pytest would list the fixtures that there are.
"""

from __future__ import annotations

import pytest


class FixturesOfPyfrc:
    """A pytest plugin with the fixtures that only `pyfrc test` has."""

    @pytest.fixture
    def fake_time(self, request: pytest.FixtureRequest) -> None:
        pytest.fail(
            f"{request.fixturename} is a fixture of pyfrc, which robotpy test does not have. "
            "Run: pyfrc test. To deploy then: robotpy deploy --skip-tests",
            pytrace=False,
        )

    gamedata = hal_data = physics_controller = fake_time
