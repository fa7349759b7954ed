"""How `pyfrc fuzz` shortens scripts: what is removed together, what keeps its moment, and what is said of it."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from dataclasses import replace
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from pyfrc_core.fuzz.campaign.describe import late_failure, story_of
from pyfrc_core.fuzz.match.work import MatchExecutor, MatchResult, ReplayTask, Task
from pyfrc_core.fuzz.oracle.failure import HANGS, FuzzFailure
from pyfrc_core.fuzz.shrink.shrinker import Shrinker
from pyfrc_core.fuzz.shrink.starts import ScriptWrite, without_idle_releases
from pyfrc_core.project import Project
from pyfrc_core.runtime.scripts.script import InputScript, Step

PACKET_US = 20_000
FAILURE = FuzzFailure("KeyError", "robot.py:3", "f", "robot.py:3: KeyError: 3")
BUTTON = "joysticks[0].buttons[1]"


class Simulated(MatchExecutor):
    """An executor whose robot is a function.

    :param robot: makes the robot of a run: a function that is called in each packet with the time in seconds and the
        values of all targets that were written, and returns whether the robot fails
    """

    def __init__(self, robot: Callable[[], Callable[[float, dict[str, object]], bool]], failure: FuzzFailure) -> None:
        super().__init__(Project(Path("robot.py")), 1)
        self._robot = robot
        self._failure = failure
        self.tasks: list[ReplayTask] = []
        self.packets = 0

    def play(self, tasks: Iterable[Task]) -> Generator[MatchResult, None, None]:
        for task in tasks:
            assert isinstance(task, ReplayTask)
            self.tasks.append(task)
            yield self._result(task)

    def _result(self, task: ReplayTask) -> MatchResult:
        fails, values = self._robot(), dict[str, object]()
        steps = {step.at_us: step.writes for step in task.script.steps}
        for now_us in range(0, task.script.end_us, PACKET_US):
            self.packets += 1
            values |= steps.get(now_us, {})
            if fails(now_us / 1e6, values):
                end_us = now_us + PACKET_US
                return MatchResult(self._failure, InputScript(task.script.steps, end_us))
        return MatchResult(None, task.script)


# `MatchExecutor.lines` is not used here.
Simulated.__abstractmethods__ = frozenset()


def shrunk(
    robot: Callable[[], Callable[[float, dict[str, object]], bool]], script: InputScript, failure: FuzzFailure = FAILURE
) -> tuple[Shrinker, Simulated]:
    executor = Simulated(robot, failure)
    (first,) = executor.play([ReplayTask(script)])
    shrinker = Shrinker(executor, first.script, failure, {})
    shrinker.shrink()
    return shrinker, executor


def pressed(*times: float, target: str = BUTTON, held: float = 0.1) -> list[tuple[float, str, object]]:
    return [write for at in times for write in ((at, target, True), (at + held, target, False))]


def script_of(writes: Iterable[tuple[float, str, object]], end: float = 30.0) -> InputScript:
    moments: dict[int, dict[str, object]] = {}
    for at, target, value in sorted(writes, key=lambda write: write[0]):
        moments.setdefault(round(at * 50) * PACKET_US, {})[target] = value
    return InputScript(tuple(Step(at_us, writes) for at_us, writes in moments.items()), round(end * 1e6))


def written(script: InputScript) -> list[tuple[str, object]]:
    return [write for step in script.steps for write in step.writes.items()]


def toggling() -> Callable[[float, dict[str, object]], bool]:
    """A robot with a button that toggles, which fails when it is on and another one is pressed."""
    before, on = False, False

    def fails(now: float, values: dict[str, object]) -> bool:
        nonlocal before, on
        now_pressed = bool(values.get(BUTTON))
        if now_pressed and not before:
            on = not on
        before = now_pressed
        return on and not now_pressed and bool(values.get("joysticks[0].buttons[2]"))

    return fails


def test_a_button_that_toggles_is_pressed_once() -> None:
    # Pressed 7 times: one press less and the robot does not fail.
    many = pressed(1, 3, 5, 8, 11, 14, 18)
    shrinker, _ = shrunk(toggling, script_of([(0.5, "mode", "teleop"), *many, (25, "joysticks[0].buttons[2]", True)]))
    assert written(shrinker.script) == [(BUTTON, True), (BUTTON, False), ("joysticks[0].buttons[2]", True)]


def test_what_releases_a_control_that_is_not_pressed_is_left_out() -> None:
    writes = [(BUTTON, False, 0), (BUTTON, True, 1), ("dio[0].value", False, 2), (BUTTON, False, 3), (BUTTON, False, 4)]
    kept = without_idle_releases([ScriptWrite(0, target, value, number) for target, value, number in writes])
    assert [write.number for write in kept] == [1, 2, 3]


def test_what_depends_on_the_state_alone_needs_no_long_run() -> None:
    def held() -> Callable[[float, dict[str, object]], bool]:
        return lambda now, values: all(values.get(f"dio[{number}].value") is True for number in (3, 7))

    noise = [
        (at / 10, f"dio[{number}].value", (at + number) % 3 > 0) for number in range(9, 20) for at in range(5, 250, 7)
    ]
    shrinker, executor = shrunk(held, script_of([*noise, (20, "dio[3].value", True), (26, "dio[7].value", True)]))
    assert written(shrinker.script) == [("dio[3].value", True), ("dio[7].value", True)]
    # The match that was found and all shorter ones together: a minute of robot time, not one for each.
    assert executor.packets < 3_000


@given(count=st.integers(1, 100), needed=st.sets(st.integers(0, 99), min_size=1, max_size=4))
def test_only_what_is_needed_is_left(count: int, needed: set[int]) -> None:
    targets = {f"dio[{number % count}].value" for number in needed}
    script = script_of([(number / 50, f"dio[{number}].value", True) for number in range(count)])
    shrinker, _ = shrunk(lambda: lambda now, values: targets <= values.keys(), script)
    assert {target for target, _ in written(shrinker.script)} == targets
    assert shrinker.runs < 2_000


def test_gaps_become_as_short_as_possible() -> None:
    first, second = "dio[1].value", "dio[2].value"

    def robot() -> Callable[[float, dict[str, object]], bool]:
        since: list[float] = []

        def fails(now: float, values: dict[str, object]) -> bool:
            if values.get(first) and not values.get(second):
                since.append(now)
            return bool(since and values.get(second) and now - since[0] >= 0.1)

        return fails

    shrinker, _ = shrunk(robot, script_of([(10, first, True), (16, second, True)]))
    one, other = shrinker.script.steps
    assert (dict(one.writes), dict(other.writes)) == ({first: True}, {second: True})
    assert other.at_us - one.at_us <= 100_000


def test_what_remains_keeps_its_moment() -> None:
    def late() -> Callable[[float, dict[str, object]], bool]:
        return lambda now, values: values.get("dio[3].value") is True and now > 15.3

    shrinker, _ = shrunk(late, script_of([*pressed(1, 2, 3), (5, "dio[3].value", True)]))
    assert written(shrinker.script) == [("dio[3].value", True)]
    assert late_failure(shrinker.script) == 15.32
    assert story_of(shrinker.script, FAILURE)[-1].startswith("at 15.32 s: ")


def in_modes(needed: list[str]) -> Callable[[], Callable[[float, dict[str, object]], bool]]:
    """A robot that fails when it has been in these enabled modes, one after the other."""

    def robot() -> Callable[[float, dict[str, object]], bool]:
        seen = [""]

        def fails(now: float, values: dict[str, object]) -> bool:
            mode = str(values.get("mode", "disabled"))
            if mode != seen[-1]:
                seen.append(mode)
            return [each for each in seen[1:] if not each.startswith("disabled")][-len(needed) :] == needed

        return fails

    return robot


def match_of(*modes: str) -> InputScript:
    return script_of([(2.0 * number, "mode", mode) for number, mode in enumerate(modes)])


def test_no_mode_follows_another_without_a_pause() -> None:
    script = match_of("disabled autonomous", "autonomous", "disabled", "autonomous", "disabled", "teleop")
    shrinker, _ = shrunk(in_modes(["autonomous", "teleop"]), script)
    assert [value for _, value in written(shrinker.script)] == ["autonomous", "disabled", "teleop"]
    assert len(story_of(shrinker.script, FAILURE)) == 4


def test_a_second_autonomous_is_named() -> None:
    script = match_of("disabled autonomous", "autonomous", "disabled", "autonomous", "disabled", "teleop")
    shrinker, _ = shrunk(in_modes(["autonomous", "autonomous"]), script)
    assert [value for _, value in written(shrinker.script)] == ["autonomous", "disabled", "autonomous"]
    first = "needs a second autonomous, as when a match is started again without a restart"
    assert story_of(shrinker.script, FAILURE)[0] == first


def test_autonomous_after_teleoperated_is_named() -> None:
    script = match_of("disabled", "teleop", "disabled", "autonomous", "disabled", "teleop")
    shrinker, _ = shrunk(in_modes(["teleop", "autonomous"]), script)
    first = "needs autonomous after teleoperated, as when a match follows practice without a restart"
    assert story_of(shrinker.script, FAILURE)[0] == first


def test_a_hang_is_shortened_with_a_short_limit_and_checked_with_the_real_one() -> None:
    hangs = FuzzFailure(HANGS, "robot.py:3", "f", "robot.py:3: f() hangs")

    def robot() -> Callable[[float, dict[str, object]], bool]:
        return lambda now, values: values.get("dio[3].value") is True

    shrinker, executor = shrunk(robot, script_of([*pressed(1, 2, 3), (5, "dio[3].value", True)]), hangs)
    assert written(shrinker.script) == [("dio[3].value", True)]
    limits = [task.hang_seconds for task in executor.tasks[1:]]
    assert set(limits[:-1]) == {0.3}
    assert limits[-1] is None


def test_the_story_of_a_long_script_is_short() -> None:
    script = script_of([(0, "mode", "teleop"), *pressed(*range(1, 25))], 26)
    story = story_of(script, FAILURE)
    assert len(story) == 8
    assert story[0] == "(43 earlier moments are in the script)"
    assert story[1] == "at 22.00 s in teleoperated: joystick 0 button 1 pressed"


def test_a_failure_between_two_packets_is_shortened() -> None:
    def robot() -> Callable[[float, dict[str, object]], bool]:
        before: tuple[object, object] = (None, None)

        def fails(now: float, values: dict[str, object]) -> bool:
            nonlocal before
            (third, seventh), before = before, (values.get("dio[3].value"), values.get("dio[7].value"))
            return third is True and seventh is not True and before[1] is True

        return fails

    class BetweenPackets(Simulated):
        """A robot that fails 5 ms after a packet, as in a function with a period of its own."""

        def _result(self, task: ReplayTask) -> MatchResult:
            grid = [Step(-(-step.at_us // PACKET_US) * PACKET_US, step.writes) for step in task.script.steps]
            merged: dict[int, dict[str, object]] = {}
            for step in grid:
                merged.setdefault(step.at_us, {}).update(step.writes)
            steps = tuple(Step(at_us, writes) for at_us, writes in merged.items())
            played = super()._result(replace(task, script=replace(task.script, steps=steps)))
            late_us = 5_000 if played.failure is not None else 0
            return MatchResult(played.failure, replace(task.script, end_us=played.script.end_us + late_us))

    executor = BetweenPackets(robot, FAILURE)
    script = script_of([*pressed(1, 2, 3), (25.8, "dio[3].value", True), (26, "dio[7].value", True)])
    (first,) = executor.play([ReplayTask(script)])
    shrinker = Shrinker(executor, first.script, FAILURE, {})
    shrinker.shrink()
    assert written(shrinker.script) == [("dio[3].value", True), ("dio[7].value", True)]
    assert all(step.at_us % PACKET_US == 0 for step in shrinker.script.steps)
