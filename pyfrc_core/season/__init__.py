"""What a season fixes: dates, match lengths, field, controller, packages.

All of it is one `record.Season`; other rooms ask `CURRENT`. Of earlier seasons only the field is known, for
`field.season` in sim/config.json. CONTRIBUTING.md says how to add a season.
"""

from .earlier_fields import EARLIER_FIELDS
from .record import Season, SeasonField
from .season_2026 import SEASON_2026

__all__ = ["CURRENT", "FIELDS", "SEASONS", "Season", "SeasonField"]

#: The seasons that pyfrc knows entirely, by year.
SEASONS = {season.year: season for season in (SEASON_2026,)}

#: The season that pyfrc is for.
CURRENT = SEASONS[max(SEASONS)]

#: The field of each season, by year; of earlier seasons pyfrc knows only this.
FIELDS: dict[int, SeasonField] = EARLIER_FIELDS | {year: season.field for year, season in SEASONS.items()}
