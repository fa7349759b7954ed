"""What a campaign is asked for, and what it returns and reports."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from ...runtime.scripts.script import InputScript
from ..oracle.failure import PROCESS_ENDED, FuzzFailure
from ..oracle.hints import CampaignHints
from .corpus import CorpusEntry
from .describe import late_failure


@dataclass(frozen=True)
class Shard:
    """The part of a campaign that one machine plays: the matches ``number - 1``, ``number - 1 + count``, ...

    :param number: from 1 to `count`
    :param count: the number of machines
    """

    number: int = 1
    count: int = 1


@dataclass(frozen=True)
class CampaignOptions:
    """Options of a campaign.

    :param seed: the random seed
    :param runs: the number of matches, or None
    :param seconds: when to end, in seconds of real time, or None
    :param jobs: how many matches to run at a time
    :param recorded: recorded matches to begin with
    :param shard: which part of the campaign to run
    :param resume: whether to go on where the last campaign with this seed ended; its matches count in `runs`
    """

    seed: int
    runs: int | None
    seconds: float | None
    jobs: int
    recorded: tuple[InputScript, ...] = ()
    shard: Shard = Shard()
    resume: bool = False


@dataclass
class CampaignProgress:
    """Progress of a campaign.

    :param matches: how many matches were run
    :param simulated: robot time, in seconds
    :param covered: the share of the robot's lines that was reached, from 0 to 1; None when no lines were observed, as
        on systems where they cannot be
    :param crashes: the number of distinct failures
    :param doing: the current activity
    :param cost: processor seconds for a second of robot time; None before the first match
    """

    matches: int = 0
    simulated: float = 0.0
    covered: float | None = None
    crashes: int = 0
    doing: str = ""
    cost: float | None = None


@dataclass(frozen=True)
class FuzzFinding:
    """A failure, with what a user needs to know of it.

    :param failure: the failure
    :param story: the events that lead to it, one line each; the failure comes last
    :param entry: the saved script
    :param repeats: whether the robot failed again with the script; if not, it is the script of the whole match
    :param known: whether an earlier campaign saved it
    :param runs: how many matches it took to shrink the script
    :param writes: how many writes the shortest script has
    """

    failure: FuzzFailure
    story: tuple[str, ...]
    entry: CorpusEntry
    repeats: bool = True
    known: bool = False
    runs: int = 0
    writes: int = 0

    @property
    def fails_at(self) -> float | None:
        """Return when the robot fails, in seconds, if that is known and not soon after the last input."""
        return None if self.failure.kind == PROCESS_ENDED else late_failure(self.entry.script)


@dataclass
class Campaign:
    """Result of a campaign.

    :param progress: how far it came
    :param findings: the failures that it found
    :param interrupted: whether the user interrupted it
    :param unrepeatable: the robot's devices that do not repeat, as `compat.unrepeatable` names them
    :param problem: why scripts are not saved in the project; empty if they are
    :param hints: what is no failure, but may be a mistake, in words
    :param always_fails: how many starts of the robot have all failed in the same way, which has ended it; 0: no
    """

    progress: CampaignProgress = field(default_factory=CampaignProgress)
    findings: list[FuzzFinding] = field(default_factory=list)
    interrupted: bool = False
    unrepeatable: tuple[str, ...] = ()
    always_fails: int = 0
    problem: str = ""
    hints: CampaignHints = field(default_factory=CampaignHints)


class CampaignListener(Protocol):
    """Receives the progress and the findings of a campaign."""

    def on_seen(self, failure: FuzzFailure) -> None:
        """A match has failed in a new way; its script is shrunk now."""

    def on_progress(self, progress: CampaignProgress) -> None: ...

    def on_found(self, found: FuzzFinding) -> None: ...
