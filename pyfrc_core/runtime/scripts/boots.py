"""Scripts in which the robot program is started again: what each boot of the program gets of it.

``{"t": 12.5, "set": {"restart": true}}`` ends the program at 12.5 s, as a loss of power does: no code of it is called.
It starts again at once, at the same robot time. The roboRIO has kept the entries of NetworkTables that are persistent
(Preferences among them), and files. The driver station and dashboards send what they had sent before. All controls of
joysticks are released, and sensors begin again with their first values.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import starmap
from typing import Any

from ...hal.rows import stays
from ...wpi import network
from .network_targets import NETWORK, parse_entry_target
from .script import InputScript, Step
from .targets import MATCH_TIME, MODE, RESTART


def boots_of(script: InputScript) -> list[InputScript]:
    """Return a script for each boot of the robot program; just `script` if the program is never started again.

    The first step of each boot, except for the first boot, has what is sent again.
    """
    found, start_us = [], script.start_us
    steps: list[Step] = []
    for step in script.steps:
        if not step.writes.get(RESTART) or step.at_us >= script.end_us:
            steps.append(step)
            continue
        found.append(replace(script, steps=tuple(steps), start_us=start_us, end_us=step.at_us))
        start_us = step.at_us
        steps = [Step(start_us, what_stays(steps, start_us)), _without_restart(step)]
    return [*found, replace(script, steps=tuple(steps), start_us=start_us)] if found else [script]


def what_stays(steps: Iterable[Step], now_us: int) -> dict[str, Any]:
    """Return what the driver station and dashboards send again when the program starts at this time."""
    found: dict[str, Any] = {}
    for step in steps:
        for target, value in step.writes.items():
            if target in (MODE, MATCH_TIME) or target.startswith(NETWORK) or stays(target):
                found.pop(target, None)  # the last write comes last
                left = step.at_us + round(value * 1e6) - now_us if target == MATCH_TIME else None
                found[target] = value if left is None else max(0, left) / 1e6
    return found


def without_entries(writes: Mapping[str, Any], entries: Iterable[PersistentEntry]) -> dict[str, Any]:
    """Return what of these writes is sent again: not to the entries that the roboRIO has kept."""
    kept = {entry.name for entry in entries}
    return {
        target: value
        for target, value in writes.items()
        if not target.startswith(NETWORK) or parse_entry_target(target)[0] not in kept
    }


def _without_restart(step: Step) -> Step:
    return replace(step, writes={target: value for target, value in step.writes.items() if target != RESTART})


@dataclass(frozen=True)
class PersistentEntry:
    """An entry of NetworkTables that the roboRIO keeps in a file.

    :param type_name: the name of its type
    """

    name: str
    type_name: str
    value: Any


def persistent_entries() -> tuple[PersistentEntry, ...]:
    """Return the persistent entries, by name; those with other types than plain ones and lists are left out."""
    return tuple(sorted(starmap(PersistentEntry, network.persistent_values()), key=lambda entry: entry.name))


def restore_entries(entries: Iterable[PersistentEntry]) -> None:
    """Write the persistent entries of the boot before."""
    for each in entries:
        entry = network.Entry(each.name)
        entry.write(each.value, each.type_name)
        entry.keep()
