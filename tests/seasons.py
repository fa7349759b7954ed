"""Which tests run in season 2027: those of its own, and those of some files that are about both seasons.

The robots in them are written in that season's spelling (`spelling`).
"""

from __future__ import annotations

from pathlib import Path

import pytest

from pyfrc_core.season import CURRENT

#: The files whose tests run in season 2027, too, but for those with the mark ``season_2026``. None uses WPILib outside
#: of robots' files.
IN_2027 = frozenset(
    {
        "deploy_installs",
        "determinism",
        "failures",
        "fuzz_lines",
        "fuzz_states",
        "hangs",
        "isolation",
        "lost_driver_station",
        "one_row",
        "robot_time",
        "scripts",
        "sim_headless",
        "sim_session",
        "sim_wpilog",
    }
)

#: Those that run nightly only: what they are about is ours, and meets little of the season's WPILib.
IN_2027_AT_NIGHT = frozenset(
    {
        "collector",
        "crash_reports",
        "failures_at_import",
        "fuzz_hints",
        "fuzz_plan",
        "fuzz_shrink",
        "hal_paths",
        "live_robot",
        "live_runs",
        "logs",
        "motion",
        "set_order",
        "sim_ending",
        "sim_scene",
        "sync",
        "sync_lock",
        "visionsim",
    }
)

TESTS = Path(__file__).parent


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out the files that are not for the installed season, and the directories that have none."""
    if CURRENT.year < 2027 or TESTS not in collection_path.parents:
        return None
    if collection_path.parent == TESTS:
        named = any(collection_path.name in argument for argument in config.args)
        files = IN_2027 | IN_2027_AT_NIGHT if named or config.getoption("run_slow") else IN_2027
        ours = collection_path.name == "season_2027" or collection_path.stem.removeprefix("test_") in files
        return None if ours else True
    return None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what only WPILib 2026 has."""
    if CURRENT.year < 2027:
        return
    others = [item for item in items if item.get_closest_marker("season_2026")]
    config.hook.pytest_deselected(items=others)
    items[:] = [item for item in items if not item.get_closest_marker("season_2026")]
