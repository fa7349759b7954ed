"""What a season fixes: dates, match lengths, field, controller, packages.

Adding a season is a module such as `season_2026`, and its record in `SEASONS`. docs/architecture.md says what else
a new season needs.
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
