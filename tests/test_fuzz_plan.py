"""What fuzzed matches have of a season: stages at their real length, second enables, a program that is restarted."""

from __future__ import annotations

import random
from collections.abc import Callable
from itertools import pairwise

from loops import for_each

from pyfrc_core.config.settings import MatchSettings
from pyfrc_core.fuzz.inputs.match_plan import SHORT, MatchEvent, length_of, plan_match

SETTINGS = MatchSettings()
SECONDS = 30.0

Moments = list[tuple[float, str]]


def modes_of(plan: list[MatchEvent]) -> Moments:
    """When each mode begins, in seconds."""
    found: Moments = []
    for event in plan:
        mode = str(event.writes.get("mode", ""))
        if mode and (not found or mode != found[-1][1]):
            found.append((event.at_us / 1e6, mode))
    return found


def enabled(modes: Moments) -> list[str]:
    return [mode for _, mode in modes if not mode.startswith("disabled")]


def has_whole_autonomous(modes: Moments) -> bool:
    return any(mode == "autonomous" and end - start >= 14.9 for (start, mode), (end, _) in pairwise(modes))


SEASON: dict[str, Callable[[Moments], bool]] = {
    "autonomous of 15 s": has_whole_autonomous,
    "no autonomous": lambda modes: "autonomous" not in enabled(modes),
    "test mode first": lambda modes: enabled(modes)[:1] == ["test"],
    "a second autonomous at once": lambda modes: enabled(modes)[:2] == ["autonomous", "autonomous"],
    "autonomous after teleoperated": lambda modes: ("teleop", "autonomous") in pairwise(enabled(modes)),
    "teleoperated enabled four times": lambda modes: enabled(modes).count("teleop") >= 4,
    "the program starts in teleoperated": lambda modes: modes[0] == (0.0, "teleop"),
    "the program starts in autonomous": lambda modes: modes[0] == (0.0, "autonomous"),
}


@for_each("what", SEASON)
def test_what_a_season_has_comes_every_fifty_matches(what: str) -> None:
    plans = [modes_of(plan_match(random.Random(seed), SECONDS, SETTINGS)) for seed in range(200)]
    assert sum(map(SEASON[what], plans)) >= 4


def test_modes_of_the_robot_are_repeated_three_to_five_times() -> None:
    plans = [
        enabled(modes_of(plan_match(random.Random(seed), SECONDS, SETTINGS, (), ("testInit", "teleopPeriodic"))))
        for seed in range(200)
    ]
    repeated = [modes for modes in plans if set(modes) == {"test"}]
    assert 12 < len(repeated) < 60  # what is only called in each loop is not repeated
    assert min(map(len, repeated)) >= 3
    assert sum(modes[:1] == ["test"] and "teleop" in modes for modes in plans) > 15


def test_messages_are_like_those_of_past_seasons() -> None:
    plans = [plan_match(random.Random(seed), SECONDS, SETTINGS) for seed in range(200)]
    target = "event.game_specific_message"
    sent = [str(event.writes[target]) for plan in plans for event in plan if target in event.writes]
    assert {"LRL", "R", "Y", ""} <= set(sent)
    assert {len(message) for message in sent} >= {0, 1, 3}
    assert 2 not in {len(message) for message in sent if set(message) <= set("LR") and len(set(message)) > 1}


def test_the_match_time_is_sometimes_over_before_the_period() -> None:
    early = 0
    for seed in range(200):
        plan = plan_match(random.Random(seed), SECONDS, SETTINGS)
        modes, times = modes_of(plan), [each.writes.get("match_time") for each in plan]
        last = next((float(time) for time in reversed(times) if isinstance(time, float) and time), 0.0)
        early += modes[-1][1] == "teleop" and 0 < last <= SECONDS - modes[-1][0] - 0.98
    assert early > 10


def test_the_match_time_counts_to_zero_or_begins_as_in_a_real_match_or_there_is_none() -> None:
    begins: dict[str, int] = {"short": 0, "real": 0, "none": 0}
    for seed in range(100):
        plan = plan_match(random.Random(seed), SECONDS, SETTINGS)
        if plan[0].writes.get("time.remaining") == -1.0:
            assert not any("match_time" in event.writes for event in plan)
            assert "control.fmsAttached" not in plan[0].writes
            begins["none"] += 1
        else:
            (*_, left) = (event.writes["match_time"] for event in plan if event.writes.get("mode") == "teleop"
                          and "match_time" in event.writes)  # fmt: skip
            begins["real" if left == SETTINGS.teleop else "short"] += 1
    assert min(begins.values()) >= 5
    assert begins["short"] > 50


def test_some_matches_are_as_long_as_real_ones() -> None:
    lengths = [length_of(f"fuzz 1 {number}", SECONDS, SETTINGS) for number in range(400)]
    assert set(lengths) == {30.0, 154.0, 308.0}
    assert 4 <= lengths.count(154.0) <= 16
    assert 4 <= lengths.count(308.0) <= 16
    assert max(length_of(f"fuzz 1 {number}", 4.0, SETTINGS) for number in range(400)) == 48.0
    assert max(length_of(f"fuzz 1 {number}", 310.0, SETTINGS) for number in range(400)) == 310.0
    assert length_of(f"fuzz 1 4{SHORT}", 30.0, SETTINGS) == 5.0
    assert length_of(f"fuzz 1 4{SHORT}", 2.0, SETTINGS) == 2.0


def test_match_numbers_are_those_of_events() -> None:
    """130 qualification matches at most, and as many matches of a playoff as there are."""
    starts = [plan_match(random.Random(seed), SECONDS, SETTINGS)[0].writes for seed in range(2000)]
    highest = {"practice": 0, "qualification": 0, "elimination": 0}
    for writes in starts:
        if "event.match_number" in writes:
            sort = str(writes["event.match_type"])
            highest[sort] = max(highest[sort], int(str(writes["event.match_number"])))
    assert highest == {"practice": 60, "qualification": 130, "elimination": 16}
