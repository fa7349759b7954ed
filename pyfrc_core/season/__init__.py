"""What a season fixes: dates, match lengths, field, controller, packages.

All of it is one `record.Season`; other rooms ask `CURRENT`. Of earlier seasons only the field is known, for
`field.season` in sim/config.json. CONTRIBUTING.md says how to add a season.
"""

from .choice import (
    SEASONS,
    SeasonSetting,
    installed_wpilib,
    refuse_other_season,
    refuse_unknown_wpilib,
    season_of,
    year_of,
)
from .earlier_fields import EARLIER_FIELDS
from .record import FieldPart, Season, SeasonField

__all__ = [
    "CURRENT",
    "FIELDS",
    "SEASONS",
    "FieldPart",
    "Season",
    "SeasonField",
    "SeasonSetting",
    "installed_wpilib",
    "refuse_other_season",
    "refuse_unknown_wpilib",
    "season_of",
    "year_of",
]

#: The season of the WPILib that is installed.
CURRENT = season_of(installed_wpilib())

#: The field of each season, by year; of earlier seasons pyfrc knows only this.
FIELDS: dict[int, SeasonField] = EARLIER_FIELDS | {year: season.field for year, season in SEASONS.items()}
