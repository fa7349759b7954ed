"""The hints of a campaign: what many of its matches show, in words."""

from __future__ import annotations

from collections.abc import Iterator

from ..wording import counted
from .growth import NETWORK_TABLES, Growth
from .match_hints import MatchHints

#: In how many matches something must show.
_LEAST_MATCHES = 5


class CampaignHints:
    """Collects the hints of matches, in the order of their numbers."""

    def __init__(self) -> None:
        self._growths: dict[str, list[Growth]] = {}
        self._unfinished: dict[str, list[int]] = {}
        self._finished: set[str] = set()
        self._slow: list[MatchHints] = []

    def add(self, hints: MatchHints) -> None:
        """Add what a match shows."""
        for growth in hints.growths:
            self._growths.setdefault(growth.name, []).append(growth)
        for name, ran_us in hints.unfinished.items():
            self._unfinished.setdefault(name, []).append(ran_us)
        self._finished |= hints.finished
        if hints.loop_seconds > hints.period:
            self._slow.append(hints)

    def texts(self) -> Iterator[str]:
        """Yield each hint in words."""
        for name, growths in sorted(self._growths.items()):
            if len(growths) >= _LEAST_MATCHES:
                what = "NetworkTables grow" if name == NETWORK_TABLES else f"robot.{name} grows"
                shown = sorted(growths, key=lambda growth: growth.per_second)[len(growths) // 2]
                yield (
                    f"{what} all the time: by about {shown.per_second:.0f} elements a second, to {shown.size} at the "
                    f"end of a match ({counted(len(growths), 'match', 'matches')})"
                )
        for name, times in sorted(self._unfinished.items()):
            if len(times) >= _LEAST_MATCHES and name not in self._finished:
                yield (
                    f"{name} was never true: the command ran for up to {max(times) / 1e6:.0f} s "
                    f"({counted(len(times), 'match', 'matches')})"
                )
        if len(self._slow) >= _LEAST_MATCHES:
            slow = sorted(self._slow, key=lambda hints: hints.loop_seconds)[len(self._slow) // 2]
            yield (
                f"several loops of a match need {slow.loop_seconds * 1000:.0f} ms of processor time or more on this "
                f"computer, and a period is {slow.period * 1000:.0f} ms "
                f"({counted(len(self._slow), 'match', 'matches')}): a roboRIO needs many times as long"
            )
