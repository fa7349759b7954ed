"""`pyfrc sim --log`: the inputs of a log drive today's code, and the log is shown beside it.

What a log has is given to the robot: the driver station, dashboards' choices, and each sensor whose value the log has
by its path in `hal_data`, as pyfrc's own logs do (`scripts.sensors`). Physics moves the rest. Both have the moment in
common at which the robot is first enabled; the times of pyfrc's own recordings are those of the simulation.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import partial
from pathlib import Path
from typing import Any, Literal

from ..compat.unrepeatable import may_not_repeat
from ..errors import UsageError
from ..hal.rows import is_input
from ..project import Project
from ..runtime.robot_time import PACKET_US
from ..runtime.scripts import kit_names
from ..runtime.scripts.inputs_file import is_data_log, load_inputs
from ..runtime.scripts.network_targets import NETWORK, parse_entry_target
from ..runtime.scripts.script import InputScript, Step, script_beside, trace_beside
from ..runtime.scripts.sensors import HOLD, INFINITE, is_sensor
from ..season import CURRENT
from ..shell import quoted
from ..wording import from_here
from .engine.field import field_of, robot_at, start_named
from .engine.messages import POSE, VALUE
from .engine.past_run import Comparison, PastRun
from .engine.scene import Pose
from .engine.value_history import MISSING, ValueHistory
from .logs import open_log
from .logs.align import moment_of

#: What moves the sensors that a log has: the log, or the project's physics.
SensorSource = Literal["log", "physics"]
#: The default share of a value's range that does not count as a difference, of runs that do not repeat exactly.
SHARE = 0.05
#: The most names that are offered in place of one that the log does not have.
_MOST_NEAR = 3
#: How late a value of such a run may come, in seconds: three turns of the loop.
_LATE = 0.06
#: How long after it is enabled robot code has set its place, in seconds; and what is the same place, in feet.
_PLACED, _SAME_PLACE = 0.1, 0.5


@dataclass(frozen=True)
class LogRun:
    """A log, ready to drive a simulation.

    :param script: the inputs that it has
    :param run: what it shows, as a branch
    """

    script: InputScript
    run: PastRun

    @property
    def end(self) -> float:
        """The moment of the last packet, in seconds of robot time."""
        return (self.script.end_us - 1) // PACKET_US * PACKET_US / 1_000_000


def log_run(
    project: Project,
    file: Path,
    share: float | None = None,
    given: tuple[str, ...] = (),
    ignored: tuple[str, ...] = (),
    moved_by: SensorSource = "log",
) -> LogRun:
    """Open a log.

    :param share: values of log and simulation are equal if they differ by at most this share of their range; None: 0 if
        both repeat exactly, else `SHARE`
    :param given: further entries of NetworkTables that a person has set, by name
    :param ignored: values that are not compared, by name, besides those of the project's settings
    :param moved_by: what moves the sensors, also cameras, that the log has
    :raises PyfrcError: when it is no log, or has no inputs
    """
    file = _script_of(file)
    given = asked = tuple(name.removeprefix(VALUE).removeprefix("/") for name in given)
    given = (*given, *(f"/{name}" for name in given))  # with and without the slash that most names begin with
    script = _inputs(file, given)
    opened = open_log(file, field_of(project).height)
    run = opened.run
    _check_given(file, asked, run.histories["network"])
    hal = run.histories["hal"]
    offset = _offset(script, run)
    is_own = "power.vin_voltage" in hal.paths()  # a simulation has it, and no other log calls it so
    sensors = frozenset(filter(partial(_is_measured, hal), hal.paths() if is_own and moved_by == "log" else ()))
    if moved_by == "physics":
        script = _without_sensors(script)
    if is_own:  # to its end; that of a robot's log ends soon after the match
        script = replace(script, end_us=max(script.end_us, round((run.end + offset) * 1_000_000) + PACKET_US))
    script = _with_sensors(_placed(project, script, run, is_own), hal, sensors, offset)
    repeats = is_own and not any(map(may_not_repeat, hal.paths()))
    if share is None:
        share = 0.0 if repeats else SHARE
    written = {_path_of(target.removeprefix(HOLD)) for step in script.steps for target in step.writes}
    late = _LATE
    if repeats and not share:  # a data log does not tell what was there before the loop and what came after it
        late = PACKET_US / 1_000_000 if is_data_log(file) else 0.0
    logged = () if is_own else (path.removeprefix(VALUE) for path in run.histories["network"].paths())
    replayed = tuple(sorted(kit_names.subsystems(logged)))
    ignored = (*project.settings.sim.ignore, *ignored)
    script = replace(script, problem=opened.problem)  # that of a trace, too
    limits = tuple(_limits(script, run.name))
    compared = Comparison(True, share, late, frozenset(written | sensors), replayed, ignored, limits)
    return LogRun(script, replace(run, offset=offset, compared=compared))


def _limits(script: InputScript, name: str) -> Iterator[tuple[float, str]]:
    """Yield what of a log cannot be compared, with since when a difference may come from that.

    :param name: that of the log
    """
    for since, lack in script.lacks:
        yield since, f"{name} has {lack}: what follows from that cannot be compared"
    if script.problem:
        yield math.inf, f"not all of {name} can be read, so its rest cannot be compared"
    if script.year not in (None, CURRENT.year):
        yield 0.0, f"{name} is of {script.year}: what is different since then cannot be compared"


def _script_of(file: Path) -> Path:
    """Return the file with the inputs: of a trace, that is the script beside it."""
    script = script_beside(file)
    if script is None:
        return file
    if script.is_file():
        return script
    raise UsageError(
        "a trace has no inputs, and its input script is not beside it",
        where=from_here(file),
        remedy=f"It was recorded with {script.name}: put both into one directory.",
    )


def _inputs(file: Path, given: tuple[str, ...]) -> InputScript:
    script = load_inputs(file, given)
    if not is_data_log(file) and not trace_beside(file).is_file():
        raise UsageError(
            "this input script has no trace beside it, so what the robot did is not known",
            where=from_here(file),
            remedy=f"pyfrc sim --record writes both. To run the robot with its inputs: pyfrc replay {from_here(file)}",
        )
    return script


def _check_given(file: Path, asked: tuple[str, ...], network: ValueHistory) -> None:
    """:raises UsageError: when a log does not have a value that a person is said to have set"""
    names = {path.removeprefix(VALUE).removeprefix("/") for path in network.paths() if path.startswith(VALUE)}
    for name in asked:
        if name in names or any(each.startswith(f"{name}/") for each in names):
            continue
        ending = name.rpartition("/")[2].lower()
        near = sorted(each for each in names if each.lower().rpartition("/")[2] == ending)
        near = (near or get_close_matches(name, sorted(names), n=_MOST_NEAR, cutoff=0.7))[:_MOST_NEAR]
        raise UsageError(
            f"--input {name}: {from_here(file)} has no value of this name",
            remedy=f"It has {', '.join(near)}." if near else f"To see its values: pyfrc view {quoted(from_here(file))}",
        )


def _offset(script: InputScript, run: PastRun) -> float:
    """Return what is added to the log's times: the robot is enabled for the first time at the same moment."""
    enabled = (
        step.at_us for step in script.steps if not str(step.writes.get("mode", "disabled")).startswith("disabled")
    )
    at_us, logged = next(enabled, None), moment_of(run.histories["network"], "enabled")
    return 0.0 if at_us is None or logged is None else round(at_us / 1_000_000 - logged, 6)


def _placed(project: Project, script: InputScript, run: PastRun, is_own: bool) -> InputScript:
    """Return the script with the robot's place in the log, as soon as it is enabled, if that is not where it starts.

    Code that has not set the robot's place shows it at 0, 0 in WPILib's coordinates, a corner of the field.
    """
    network = run.histories["network"]
    moment = PACKET_US / 1_000_000 if is_own else (moment_of(network, "enabled") or 0.0) + _PLACED
    place = network.value_at(POSE, moment)
    field = field_of(project)
    start = start_named(field, None)
    if place is MISSING or any(
        math.hypot(place[0] - x, place[1] - y) < _SAME_PLACE for x, y in ((start.x, start.y), (0.0, field.height))
    ):
        return script
    return replace(script, steps=(Step(0, robot_at(field, Pose(*place))), *script.steps))


def _path_of(target: str) -> str:
    """Return the path of what a target writes: of an entry of NetworkTables, without its type."""
    return VALUE + parse_entry_target(target)[0] if target.startswith(NETWORK) else target


def _is_measured(hal: ValueHistory, path: str) -> bool:
    """Return whether a path is of a sensor that the log has; of devices on the CAN bus, one that moves in the log.

    A motor controller has dozens of values for sensors that are not connected.
    """
    if not (is_sensor(path) and is_input(path, hal.now)):
        return False
    return not path.startswith("CAN[") or hal.moves(path)


def _without_sensors(script: InputScript) -> InputScript:
    """Return the script without what sensors and cameras have measured."""
    steps = (
        Step(step.at_us, {to: each for to, each in step.writes.items() if not to.startswith(HOLD)})
        for step in script.steps
    )
    return replace(script, steps=tuple(step for step in steps if step.writes))


def _with_sensors(script: InputScript, hal: ValueHistory, sensors: frozenset[str], offset: float) -> InputScript:
    """Return the script with what the log's sensors have measured."""
    writes: defaultdict[int, dict[str, Any]] = defaultdict(dict)
    for step in script.steps:
        writes[step.at_us] |= step.writes
    for path in sorted(sensors):
        for time, value in zip(*hal.changes(path), strict=True):
            at_us = round((time + offset) * 1_000_000)
            if isinstance(value, (int, float)) and 0 <= at_us < script.end_us:
                writes[at_us // PACKET_US * PACKET_US][HOLD + path] = INFINITE if value == math.inf else value
    return replace(script, steps=tuple(Step(at_us, writes[at_us]) for at_us in sorted(writes)))
