"""What a season fixes: dates, match lengths, field, controller, packages.

All of it is one `record.Season`; other rooms ask `CURRENT`. Of earlier seasons only the field is known, for
`field.season` in sim/config.json. CONTRIBUTING.md says how to add a season, and when one leaves: pyfrc 2026.x knows
2026 and 2027, so that teams can try the previews; pyfrc 2027.1 knows 2027 only.
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
from .field_2026 import FIELD_2026
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

_FEET = 1 / 0.3048  # a metre in feet

#: Until 2019: the fields that pyfrc had then, some of them only half of the real one. From 2020 on: the full field.
_EARLIER_FIELDS = {
    2017: SeasonField(29.0, 31.0),
    2018: SeasonField(30.0, 27.0, messages=("RRR", "RLR", "LRL", "LLL")),
    2019: SeasonField(27.0, 27.0, auto_joysticks=True),  # the sandstorm period
    # The game manuals: 52 ft 5 1/4 in by 26 ft 11 1/4 in, in both years.
    2020: SeasonField(52.4375, 26.9375),
    2021: SeasonField(52.4375, 26.9375),
    # WPILib's AprilTag layouts (of 2025, the welded field).
    2022: SeasonField(54.0, 27.0),
    2023: SeasonField(16.54175 * _FEET, 8.0137 * _FEET),
    2024: SeasonField(16.541 * _FEET, 8.211 * _FEET),
    2025: SeasonField(17.548 * _FEET, 8.052 * _FEET),
    2026: FIELD_2026,
}

#: The field of each season, by year; of earlier seasons pyfrc knows only this.
FIELDS: dict[int, SeasonField] = _EARLIER_FIELDS | {year: season.field for year, season in SEASONS.items()}
