"""The inputs that a robot's process begins with.

At first, these are the script of the user, or where the robot stands and whose it is. Another process gets what was
chosen before, and what was held is released.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from ...runtime.scripts.joysticks import releases
from ...runtime.scripts.script import InputScript, Step
from ...runtime.scripts.sensors import released
from ...season import CURRENT
from .commands import ChooseMode, ChooseOpmode, Command, Write
from .field import robot_at, start_named
from .options import SimOptions
from .recording import Recording
from .scene import Field
from .snapshot import Snapshot


def first_script(options: SimOptions, robot: str, field: Field) -> InputScript:
    """Return the inputs at the robot's start, and later those of the options' script.

    :param robot: the name of the robot's file
    :raises UsageError: when the field has no such start
    """
    start = start_named(field, options.start_position)
    if options.script is None:
        # The blue alliance's wall is at x = 0: a robot of the other one would drive into the wall behind it.
        station = "blue1" if start.x < field.width / 2 else "red1"
        script = InputScript((Step(0, {"alliance_station": station}),), 0, robot=robot)
    else:
        script = ending_released(options.script)
    if options.start_position is None:
        return script
    return replace(script, steps=(Step(0, robot_at(field, start)), *script.steps))


def first_recording(options: SimOptions, robot: str, field: Field, has_log: bool) -> Recording:
    """Return a recording that begins with these inputs.

    :param has_log: whether what the robot does on the way to `start_at` is compared with a log, and so reported
    """
    recording = Recording(first_script(options, robot, field), known=not (has_log and options.start_at))
    recording.is_open = bool(has_log and options.start_at)
    return recording


def releases_after(recording: Recording) -> tuple[Command, ...]:
    """Return the commands that release the joysticks at a recording's end: they are not held in another run."""
    held = releases({**_values_after(recording.past.steps), **recording.station.sticks})
    return (Write(held),) if held else ()


def ending_released(script: InputScript) -> InputScript:
    """Return a script after whose end the joysticks are released."""
    values = _values_after(script.steps)
    held = releases(values) | released(values)
    return replace(script, steps=(*script.steps, Step(script.end_us + 1, held))) if held else script


def choices_of(
    recording: Recording, pending: Iterable[Command], first: InputScript, snapshot: Snapshot | None
) -> tuple[Command, ...]:
    """Return the commands that choose again what a user has chosen at the driver station and on dashboards.

    :param pending: commands that are not recorded yet
    :param first: the script that the robot starts with, which chooses for itself
    """
    pending = tuple(pending)
    writes = [command for command in pending if isinstance(command, Write)]
    modes = [command for command in pending if isinstance(command, ChooseMode)]
    by_itself = _values_after(first.steps)
    chosen = {
        target: value
        for target, value in _values_after([*recording.inputs().steps, *writes]).items()
        if _is_choice(target) and not (target in by_itself and by_itself[target] == value)
    }
    commands: list[Command] = [Write(chosen)] if chosen else []
    commands += [ChooseOpmode(name, mode) for mode, name in recording.station.opmodes.items()]
    commands += [command for command in pending if isinstance(command, ChooseOpmode)]
    # A match chooses modes by itself, as a script does.
    if modes:
        commands.append(modes[-1])
    elif snapshot is not None and snapshot.practice_since is None and "mode" not in by_itself:
        commands.append(ChooseMode(snapshot.chosen_mode))
    return tuple(commands)


def _is_choice(target: str) -> bool:
    chooser = target.startswith("nt:") and target.endswith(f"/{CURRENT.dashboards.choice}")
    return chooser or target in ("alliance_station", "event.game_specific_message")


def _values_after(steps: Iterable[Step | Write]) -> dict[str, Any]:
    """Return the last value of each target."""
    values: dict[str, Any] = {}
    for step in steps:
        values.update(step.writes)
    return values
