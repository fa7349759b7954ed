"""The fields of seasons before pyfrc had a record of them, for ``field.season`` in ``sim/config.json``."""

from __future__ import annotations

from .record import SeasonField

_FEET = 1 / 0.3048  # a metre in feet

#: Until 2019: the fields that pyfrc had then, some of them only half of the real one. From 2020 on: the full field.
EARLIER_FIELDS = {
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
}
