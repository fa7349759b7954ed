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
    "deploy_installs": {"test_from_nothing_to_a_rollback"},
    "determinism": {"test_sample_robot_passes_all_tests_and_does_the_same_again_and_again[worker]"},
    "failures": {
        "test_a_run_with_failures_exits_with_1_and_tells_each",
        "test_a_robot_whose_own_loop_returns_early_fails",
    },
    "fuzz_lines": set(),
    "fuzz_states": set(),
    "lost_driver_station": set(),
    "one_row": set(),
    "robot_time": {
        "test_python_time_is_robot_time_in_robot_code_only",
        "test_fake_time",
        "test_threads_locks_queues_events_timers_and_pools_keep_robot_time",
        "test_loops_and_callbacks_keep_their_rates",
        "test_practice_match_of_another_season",
        "test_whose_loop_it_is_shows_nowhere_outside[wpilib's]",
        "test_whose_loop_it_is_shows_nowhere_outside[its own]",
    },
    "scripts": {"test_a_failure_comes_back"},
    "sim_headless": {"test_a_practice_match", "test_a_robot_that_fails"},
    "sim_session": {
        "test_driving_as_from_a_driver_station",
        "test_going_back_lands_on_the_same_snapshot",
        "test_new_code_is_brought_to_the_same_moment",
        "test_where_processes_cannot_be_forked",
        "test_a_robot_that_fails_takes_nothing_with_it[5-ZeroDivisionError: division by zero]",
        "test_the_robot_of_todays_physics_begins_at_the_start_that_is_chosen",
        "test_a_practice_match",
        "test_an_emergency_stop_lasts_until_the_robot_is_restarted",
        "test_a_robot_that_has_just_been_switched_on",
        "test_one_packet_is_a_fiftieth_of_a_second",
    },
    "sim_wpilog": {
        "test_the_log_has_what_the_robot_publishes_and_each_run_writes_the_same",
        "test_the_log_has_the_console",
    },
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
