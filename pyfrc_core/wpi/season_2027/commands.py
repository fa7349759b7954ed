"""commands2 and magicbot: what runs of a robot that uses them. Neither is imported by this."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from typing import Any

from ...compat.private_name import PrivateName

SUBSYSTEMS = PrivateName(
    "commands2:CommandScheduler._subsystems", "runtime.time.simulation_periodic finds the robot's subsystems by it"
)
SCHEDULED_COMMANDS = PrivateName(
    "commands2:CommandScheduler._scheduled_commands", "fuzz.states finds the commands that run by it"
)
STATE_OF_MACHINE = PrivateName(
    "magicbot.state_machine:_StateData", "fuzz.states finds the states of magicbot's state machines by it"
)


def simulated_subsystems() -> Iterator[tuple[Any, str]]:
    """Yield the registered subsystems that simulate themselves, with the name of the method that does."""
    commands2 = sys.modules.get("commands2")
    if commands2 is not None:
        for subsystem in SUBSYSTEMS.of(commands2.CommandScheduler.get_instance()):
            if type(subsystem).simulation_periodic is not commands2.Subsystem.simulation_periodic:
                yield subsystem, "simulation_periodic"


def scheduled_commands() -> tuple[Any, ...]:
    """Return the commands that run, in the order in which they began. commands2 must have been imported.

    Without this private name of commands2, return none.
    """
    import commands2

    return tuple(getattr(commands2.CommandScheduler.get_instance(), SCHEDULED_COMMANDS.name, ()))


def names_of_scheduled() -> list[str]:
    """Return the names of the commands that run; none if commands2 has not been imported."""
    return [name_of(command) for command in scheduled_commands()] if "commands2" in sys.modules else []


def watch_commands(
    began: Callable[[Any], None], finished: Callable[[Any], None], interrupted: Callable[[Any], None]
) -> None:
    """Call a function with each command that begins, is finished, or is interrupted from now on.

    commands2 must have been imported.
    """
    import commands2

    scheduler = commands2.CommandScheduler.get_instance()
    scheduler.on_command_initialize(began)
    scheduler.on_command_finish(finished)
    scheduler.on_command_interrupt(interrupted)


def name_of(command: Any) -> str:
    """Return the name of a command."""
    name: str = command.get_name()
    return name


def is_default(command: Any) -> bool:
    """Return whether a command runs because its subsystem has nothing else to do."""
    return any(each.get_default_command() is command for each in command.get_requirements())


def is_state_of_machine(thing: object) -> bool:
    """Return whether this is a state of one of magicbot's state machines."""
    kind = type(thing)
    return kind.__name__ == STATE_OF_MACHINE.name and kind.__module__ == "magicbot.state_machine"


def forget_all() -> None:
    """Release what the scheduler holds of a robot, if it has imported commands2."""
    commands2 = sys.modules.get("commands2")
    if commands2 is not None:
        commands2.CommandScheduler.reset_instance()
