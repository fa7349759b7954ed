"""The first message to a page: what stays the same throughout a simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, get_args

from ...._version import __version__
from ...engine.commands import ChosenMode
from ..models.joysticks import JOYSTICKS, axis_labels, button_labels
from ..models.keyboard import BUTTON_KEYS, ENABLE_CHORD, GENTLE, LAYOUTS, layout_for
from ..models.time_controls import FASTEST, SLOWEST
from ..models.wording import STATIONS
from .layouts import load_layout

if TYPE_CHECKING:
    from ...engine.simulation import Simulation

#: The version of the messages; a page of another version asks to be reloaded.
PROTOCOL = 1


def greeting(simulation: Simulation, client: int, read_only: bool, watching: bool = False) -> dict[str, Any]:
    """Return the message without the state.

    :param client: the number of the page
    :param read_only: whether the page cannot drive
    :param watching: whether saved files bring new code
    """
    project = simulation.project
    config = project.sim_config
    return {
        "type": "hello",
        "protocol": PROTOCOL,
        "client": client,
        "readonly": read_only,
        "version": __version__,
        "project": {
            "name": project.root.resolve().name,
            "root": str(project.root.resolve()),
            "main": project.main_file.name,
        },
        "options": {
            "recording": simulation.options.recording,
            "watch": watching,
            "alliances": STATIONS,
            "game_messages": list(project.game_specific_messages),
            "modes": list(get_args(ChosenMode)),
            "speeds": {"slowest": SLOWEST, "fastest": FASTEST},
            "joysticks": [
                {"axes": axis_labels(config, stick), "buttons": button_labels(config, stick)}
                for stick in range(JOYSTICKS)
            ],
            "keyboard": {
                "layouts": [
                    {
                        "name": layout.name,
                        "help": layout.help,
                        "axes": {
                            key: [(*control, by) for control, by in moves.items()] for key, moves in layout.axes.items()
                        },
                    }
                    for layout in LAYOUTS
                ],
                "chosen": layout_for(config).name,
                "gentle": GENTLE,
                "button_keys": BUTTON_KEYS,
                "enable_chord": sorted(ENABLE_CHORD),
            },
        },
        "layout": load_layout(project.root),
    }
