"""``sim/config.json``: what the runtime needs of it so far, the game's messages.

Other keys are left alone here: the file also belongs to the physics and the simulator.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import SettingsError
from .validation import validated

#: The messages of seasons whose field sent any, for configs that only name the season.
SEASON_MESSAGES = {2018: ("RRR", "RLR", "LRL", "LLL")}


@dataclass(frozen=True)
class FieldConfig:
    #: A year, as number or string.
    season: int | None = None


@dataclass(frozen=True)
class SimConfig:
    """The object under the key ``pyfrc``."""

    game_specific_messages: list[str] | None = None
    field: FieldConfig = field(default_factory=FieldConfig)

    @property
    def messages(self) -> tuple[str, ...]:
        """The messages that the field may send in autonomous; none in most seasons."""
        if self.game_specific_messages is not None:
            return tuple(self.game_specific_messages)
        return SEASON_MESSAGES.get(self.field.season or 0, ())


def load_sim_config(root: Path) -> SimConfig:
    """What ``sim/config.json`` below the project's directory says, or the defaults where there is none.

    :raises SettingsError: with the file and the place
    """
    file = root / "sim" / "config.json"
    if not file.is_file():
        return SimConfig()
    try:
        document = json.loads(file.read_text("utf-8-sig"))
    except json.JSONDecodeError as malformed:
        raise SettingsError(f"not valid JSON: {malformed.msg}", where=f"sim/config.json:{malformed.lineno}") from None
    except UnicodeDecodeError as malformed:
        raise SettingsError(f"not UTF-8 text: {malformed}", where="sim/config.json") from None
    if not isinstance(document, dict):
        raise SettingsError("the file must hold a JSON object with the key 'pyfrc'", where="sim/config.json")
    return validated(SimConfig, document.get("pyfrc", {}), file, "pyfrc")
