"""The commands of a page: a table of their names, with what each does to the simulation."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from ....errors import PyfrcError
from ...engine.commands import ChosenMode
from ..models.time_controls import rewind, toggle
from ..models.wording import STATIONS
from .json_text import read_value

if TYPE_CHECKING:
    from ...engine.simulation import Simulation
    from .collector import Collector

Message = Mapping[str, Any]
#: The answer to a command, besides that it was carried out.
Answer = dict[str, Any]

_MOST_STEPS = 3000


class CommandError(Exception):
    """A command is impossible; the text is for the person."""


class Commands:
    """Carries out the commands of pages.

    :param close: ends the simulation
    """

    def __init__(self, simulation: Simulation, collector: Collector, close: Callable[[], object]) -> None:
        self._simulation, self._collector = simulation, collector
        s = simulation
        self._table: dict[str, Callable[[Message], Any]] = {
            "enable": lambda m: s.enable(),
            "disable": lambda m: s.disable(),
            "e_stop": lambda m: s.emergency_stop(),
            "choose_mode": lambda m: s.choose_mode(_one_of(m, "mode", get_args(ChosenMode))),
            "practice": lambda m: s.practice(),
            "attach": lambda m: s.attach_driver_station(_boolean(m, "attached")),
            "alliance": lambda m: s.set_alliance(_one_of(m, "station", tuple(STATIONS.values()))),
            "game_message": lambda m: s.set_game_message(_text(m, "text")),
            "choose": lambda m: s.choose(_text(m, "chooser"), _text(m, "option")),
            "pause": lambda m: s.pause(),
            "resume": lambda m: s.resume(),
            "toggle": lambda m: toggle(s),
            "step": lambda m: s.step(int(_number(m, "packets", 1.0, 1, _MOST_STEPS))),
            "speed": lambda m: s.set_speed(_number(m, "factor")),
            "rewind": lambda m: rewind(s, _number(m, "t", None, 0.0)),
            "restart": lambda m: s.restart(),
            "reload": lambda m: s.reload(),
            "place": lambda m: s.place(_number(m, "x"), _number(m, "y"), _number(m, "degrees")),
            "reset_position": lambda m: s.reset_position(None if m.get("start") is None else _text(m, "start")),
            "write": self._write,
            "axis": lambda m: s.set_axis(_stick(m), int(_number(m, "axis", None, 0, 11)), _number(m, "value")),
            "button": lambda m: s.set_button(_stick(m), int(_number(m, "button", None, 1, 32)), _boolean(m, "pressed")),
            "pov": lambda m: s.set_pov(
                _stick(m), int(_number(m, "pov", 0.0, 0, 11)), int(_number(m, "angle", None, -1, 360))
            ),
            "plug": lambda m: s.plug(_stick(m), _boolean(m, "plugged")),
            "mark": lambda m: collector.marks.add(_number(m, "t"), "own", _text(m, "text")),
            "name_branch": self._name_branch,
            "save": self._save,
            "quit": lambda m: close(),
        }

    def carry_out(self, message: Message) -> Answer:
        """Carry out one command.

        :raises CommandError: when it is impossible
        """
        name = message.get("name")
        act = self._table.get(name) if isinstance(name, str) else None
        if act is None:
            raise CommandError(f"There is no command {name!r}. Reload the page.")
        try:
            answer = act(message)
        except (PyfrcError, OSError) as wrong:
            raise CommandError(str(wrong)) from None
        return answer if isinstance(answer, dict) else {}

    def _write(self, message: Message) -> None:
        values = message.get("values")
        if not isinstance(values, dict) or not values:
            raise CommandError("values: an object with a value for each target is needed")
        self._simulation.write({target: read_value(value) for target, value in values.items()})

    def _name_branch(self, message: Message) -> None:
        number, name = int(_number(message, "branch")), _text(message, "text").strip()[:80]
        if not self._collector.runs.name(number, name):
            raise CommandError("This branch is no longer kept.")

    def _save(self, message: Message) -> Answer:
        root = self._simulation.project.root.resolve()
        given = _text(message, "file").strip()
        file = (root / given).resolve()
        if not file.is_relative_to(root) or file == root:
            raise CommandError("A recording is saved in the project's directory.")
        if file.suffix != ".jsonl":
            file = Path(f"{file}.jsonl")
        file.parent.mkdir(parents=True, exist_ok=True)
        self._simulation.save(file)
        return {"file": file.relative_to(root).as_posix()}


def _text(message: Message, key: str) -> str:
    value = message.get(key)
    if not isinstance(value, str):
        raise CommandError(f"{key}: a text is needed, not {value!r}")
    return value


def _one_of(message: Message, key: str, names: tuple[str, ...]) -> Any:
    value = _text(message, key)
    if value not in names:
        raise CommandError(f"{key}: one of {', '.join(names)} is needed, not {value!r}")
    return value


def _boolean(message: Message, key: str) -> bool:
    value = message.get(key)
    if not isinstance(value, bool):
        raise CommandError(f"{key}: true or false is needed, not {value!r}")
    return value


def _number(
    message: Message, key: str, default: float | None = None, low: float = -math.inf, high: float = math.inf
) -> float:
    value = message.get(key, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise CommandError(f"{key}: a number is needed, not {value!r}")
    if not low <= value <= high:
        raise CommandError(f"{key}: from {low:g} to {high:g}, not {value!r}")
    return value


def _stick(message: Message) -> int:
    return int(_number(message, "stick", None, 0, 5))
