"""What ``field.season`` in ``sim/config.json`` stands for."""

from __future__ import annotations

from dataclasses import dataclass

_FEET = 1 / 0.3048  # a metre in feet


@dataclass(frozen=True)
class Season:
    """One season's field, drawn with x to the right and y downwards, and what was particular to it."""

    #: Size of the field: along x, along y; in feet.
    w: float
    h: float
    #: Scale of the drawing, in pixels per foot.
    px_per_ft: float = 15.0
    #: The messages that the field may send before autonomous.
    messages: tuple[str, ...] = ()
    #: Whether the robot got joystick data in autonomous.
    auto_joysticks: bool = False


#: Until 2019: the fields that pyfrc had then, some of them only half of the real one. From 2020 on: the full field.
SEASONS = {
    2017: Season(29.0, 31.0),
    2018: Season(30.0, 27.0, messages=("RRR", "RLR", "LRL", "LLL")),
    2019: Season(27.0, 27.0, auto_joysticks=True),  # the sandstorm period
    # The game manuals: 52 ft 5 1/4 in by 26 ft 11 1/4 in, in both years.
    2020: Season(52.4375, 26.9375),
    2021: Season(52.4375, 26.9375),
    # WPILib's AprilTag layouts (of 2025, the welded field).
    2022: Season(54.0, 27.0),
    2023: Season(16.54175 * _FEET, 8.0137 * _FEET),
    2024: Season(16.541 * _FEET, 8.211 * _FEET),
    2025: Season(17.548 * _FEET, 8.052 * _FEET),
    # The game manual: 54 ft 3 in by 26 ft 5 in.
    2026: Season(54.25, 26 + 5 / 12),
}

#: Whose field is taken where none is named.
TODAY = max(SEASONS)
