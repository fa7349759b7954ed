"""Which tests run in season 2027: those of its own, and those of some files that are about both seasons.

The robots in them are written in that season's spelling (`spelling`).
"""

from __future__ import annotations

from pathlib import Path

import pytest

from pyfrc_core.season import CURRENT

#: The files whose tests run in season 2027, too, but for those with the mark ``season_2026``. None uses WPILib outside
#: of robots' files. By day, the named tests of a file run; without names, all of them.
IN_2027: dict[str, set[str]] = {
    "deploy_installs": {"test_from_nothing_to_two_rollbacks"},
    "determinism": {"test_sample_robot_passes_all_tests_and_does_the_same_again_and_again[worker]"},
    "failures": set(),
    "fuzz_lines": set(),
    "fuzz_states": set(),
    "lost_driver_station": set(),
    "one_row": set(),
    "robot_time": set(),
    "scripts": {"test_a_recordings_replay_does_the_same[command]"},
    "sim_headless": set(),
    "sim_session": set(),
    "sim_wpilog": set(),
}

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
        "hangs",
        "isolation",
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
        name = collection_path.stem.removeprefix("test_")
        at_night = name in IN_2027_AT_NIGHT and _all_run(collection_path, config)
        return None if collection_path.name == "season_2027" or name in IN_2027 or at_night else True
    return None


def _all_run(file: Path, config: pytest.Config) -> bool:
    """Return whether all tests of a file run: at night, and if it is named."""
    return bool(config.getoption("run_slow")) or any(file.name in argument for argument in config.args)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out what only WPILib 2026 has, and by day what is left for the night."""
    if CURRENT.year < 2027:
        return
    others = [item for item in items if item.get_closest_marker("season_2026") or _is_left_for_the_night(item, config)]
    config.hook.pytest_deselected(items=others)
    items[:] = [item for item in items if item not in others]


def _is_left_for_the_night(item: pytest.Item, config: pytest.Config) -> bool:
    by_day = IN_2027.get(item.path.stem.removeprefix("test_"), set()) if item.path.parent == TESTS else set()
    return bool(by_day) and item.name not in by_day and not _all_run(item.path, config)
