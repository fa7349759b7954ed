"""What the driver station and the field say of a match: alliance, event, match number, and how much time is left."""

from __future__ import annotations

import random

from .values import Value

_STATIONS = ("red1", "red2", "red3", "blue1", "blue2", "blue3")

#: Names of events, as the field sends them.
_EVENTS = ("CASJ", "2026casj", "NYRO", "Einstein")
#: The highest match numbers of large events.
_MOST_MATCHES = {"practice": 60, "qualification": 130, "elimination": 16}
_REPLAYS = (1, 1, 1, 2, 3)

#: How often the robot is ready before its driver station, and the driver station before it knows the alliance.
_NO_STATION, _NO_ALLIANCE = 0.1, 0.12
#: How often the driver station counts the time without a field, in its practice mode; else it sends -1.
_PRACTICE = 0.6

#: The seconds left that the driver station sends when it does not count them.
NOT_COUNTED = -1.0


class FieldData:
    """What is known of one match.

    :ivar at_start: what is written before the robot starts
    :ivar later: what is written later, and when, in seconds
    :ivar counts: whether the time left is known
    """

    def __init__(self, rng: random.Random) -> None:
        self.at_start: dict[str, Value] = {}
        self.later: tuple[float, dict[str, Value]] | None = None
        station, how = rng.choice(_STATIONS), rng.random()
        if how < _NO_STATION:
            self.at_start |= {"control.dsAttached": False, "alliance_station": "unknown"}
            self.later = (rng.uniform(0.1, 0.5), {"control.dsAttached": True, "alliance_station": station})
        elif how < _NO_STATION + _NO_ALLIANCE:
            self.at_start["alliance_station"] = "unknown"
            self.later = (rng.choice((0.1, 1.0, 5.0, 20.0)) * rng.random(), {"alliance_station": station})
        else:
            self.at_start["alliance_station"] = station
        if rng.random() < 0.5:
            self.counts = True
            self.at_start |= {
                "control.fmsAttached": True,
                "event.match_type": (sort := rng.choice(("qualification", "qualification", "elimination", "practice"))),
                "event.match_number": rng.randint(1, _MOST_MATCHES[sort]),
                "event.replay_number": rng.choice(_REPLAYS),
                "event.name": rng.choice(_EVENTS),
            }
        else:
            self.counts = rng.random() < _PRACTICE
            if self.counts:
                self.at_start["event.match_type"] = "practice"
            if rng.random() < 0.5:
                self.at_start["event.name"] = ""
