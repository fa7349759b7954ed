"""The commands of a page: a table of their names, with what each does to the source, as far as that can be driven."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

from ....errors import PyfrcError
from ....runtime.scripts.script import trace_beside
from ...engine.commands import ChosenMode, chooser_target
from ...engine.controls import Driver
from ...engine.simulation import Simulation
from ...live.tuning import Tuner
from ...logs.source import LogSource
from ..models.joysticks import FIRST_BUTTON, MOST_BUTTONS
from ..models.time_controls import rewind, toggle
from ..models.wording import STATIONS
from .messages import CommandError, Message, read_value

if TYPE_CHECKING:
    from ...engine.source import Source, Writer
    from .collector import Collector

#: The answer to a command, besides that it was carried out.
Answer = dict[str, Any]

_MOST_STEPS = 3000
#: The numbers of the first and the last button.
_BUTTONS = FIRST_BUTTON, FIRST_BUTTON + MOST_BUTTONS - 1
#: The largest place that a page may name, in feet and degrees.
_FARTHEST = 1e6


class PageCommands:
    """Carries out the commands of one page.

    :param writer: the person at the page; None: there is nothing to do to the source
    :param close: ends the source
    """

    def __init__(
        self, source: Source, writer: Writer | None, collector: Collector, close: Callable[[], object]
    ) -> None:
        self._collector = collector
        self._table: dict[str, Callable[[Message], Any]] = {
            "mark": lambda m: collector.marks.add(m.time("t"), "own", m.text("text")),
            "name_branch": self._name_branch,
            "move_branch": self._move_branch,
            "quit": lambda m: close(),
        }
        if isinstance(source, LogSource) and (what_if := source.what_if) is not None:
            self._table["what_if"] = lambda m: {"address": what_if()}
        if writer is not None:
            self._table["write"] = lambda m: writer.write(_writes(m))
            self._table["choose"] = lambda m: writer.write({chooser_target(m.text("chooser")): m.text("option")})
        if isinstance(writer, Tuner):
            self._table["tune"] = lambda m: writer.tune(m.boolean("on"))
        if isinstance(writer, Driver) and isinstance(source, Simulation):
            self._table |= self._driving(source, writer)

    def _driving(self, simulation: Simulation, driver: Driver) -> dict[str, Callable[[Message], Any]]:
        s, d = simulation, driver
        return {
            "enable": lambda m: d.enable(),
            "disable": lambda m: d.disable(),
            "e_stop": lambda m: d.emergency_stop(),
            "choose_mode": lambda m: d.choose_mode(m.one_of("mode", get_args(ChosenMode))),
            "choose_opmode": lambda m: d.choose_opmode(m.text("opmode"), m.one_of("mode", get_args(ChosenMode))),
            "practice": lambda m: d.practice(),
            "attach": lambda m: d.attach_driver_station(m.boolean("attached")),
            "alliance": lambda m: d.set_alliance(m.one_of("station", tuple(STATIONS.values()))),
            "game_message": lambda m: d.set_game_message(m.text("text")),
            "pause": lambda m: d.pause(),
            "resume": lambda m: d.resume(),
            "toggle": lambda m: toggle(s),
            "step": lambda m: d.step(m.integer("packets", 1, _MOST_STEPS, 1)),
            "speed": lambda m: d.set_speed(m.number("factor", 0, 1000)),
            "rewind": lambda m: rewind(s, m.time("t")),
            "restart": lambda m: s.restart(),
            "reload": lambda m: s.reload(),
            "place": lambda m: s.place(*(m.number(key, -_FARTHEST, _FARTHEST) for key in ("x", "y", "degrees"))),
            "reset_position": lambda m: s.reset_position(m.text("start") if "start" in m else None),
            "axis": lambda m: d.set_axis(_stick(m), m.integer("axis", 0, 11), m.number("value", -1, 1)),
            "button": lambda m: d.set_button(_stick(m), m.integer("button", *_BUTTONS), m.boolean("pressed")),
            "pov": lambda m: d.set_pov(_stick(m), m.integer("pov", 0, 11, 0), m.integer("angle", -1, 360)),
            "plug": lambda m: d.plug(_stick(m), m.boolean("plugged")),
            "save": lambda m: _save(s, m),
        }

    def carry_out(self, message: Message) -> Answer:
        """Carry out one command.

        :raises CommandError: when it is impossible
        """
        act = self._table.get(message.text("name"))
        if act is None:
            raise CommandError(f"There is no command {message.text('name')[:80]!r} here. Reload the page.")
        try:
            answer = act(message)
        except PyfrcError as wrong:
            raise CommandError(str(wrong)) from None
        except OSError as wrong:  # with a name of any length
            raise CommandError(f"The file cannot be written: {wrong.strerror}") from None
        return answer if isinstance(answer, dict) else {}

    def _name_branch(self, message: Message) -> None:
        number, name = message.branch(), message.text("text").strip()[:80]
        if number is None or not self._collector.runs.name(number, name):
            raise CommandError("This branch is no longer kept.")

    def _move_branch(self, message: Message) -> None:
        number, offset = message.branch(), message.time("offset")
        if number is None or not self._collector.runs.move(number, offset):
            raise CommandError("This branch cannot be moved.")


def _writes(message: Message) -> dict[str, Any]:
    values = message.raw("values")
    if not isinstance(values, dict) or not values:
        raise CommandError("values: an object with a value for each target is needed")
    return {target: read_value(value) for target, value in values.items()}


def _save(simulation: Simulation, message: Message) -> Answer:
    root = simulation.project.root.resolve()
    given = root / message.text("file").strip()
    try:
        file = (given if given.suffix == ".jsonl" else Path(f"{given}.jsonl")).resolve()
    except (ValueError, RuntimeError):  # a null character; a symbolic link to itself
        raise CommandError("This is no name of a file.") from None
    if not file.is_relative_to(root):
        raise CommandError("A recording is saved in the project's directory.")
    name = file.relative_to(root).as_posix()
    if not ("replace" in message and message.boolean("replace")):
        for written in (file, trace_beside(file)):
            if written.exists():
                return {"exists": written.relative_to(root).as_posix()}
    file.parent.mkdir(parents=True, exist_ok=True)
    simulation.save(file)
    return {"file": name}


def _stick(message: Message) -> int:
    return message.integer("stick", 0, 5)
