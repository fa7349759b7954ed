"""Options of a test run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

from ..config.settings import DEFAULT_SEED, TestSettings

Isolation: TypeAlias = Literal["auto", "fork", "reuse", "none"]
Jobs: TypeAlias = int | Literal["auto"]

#: The package of the ready-made tests; they use this one, which imports none of them.
READY_MADE_TESTS = "pyfrc_core.tests"
READY_MADE_DIRECTORY = Path(__file__).parents[1] / "tests"


@dataclass(frozen=True)
class TestOptions:
    """Options of a test run.

    :param seed: the seed of Python's and numpy's random generators in every test
    :param jobs: how many tests run at the same time; "auto": as many as there are processors, and one more if they wait
        for devices that are simulated in real time
    :param isolation: where each test that uses the robot runs
    :param trace_directory: where to write a trace of the robot in each test
    :param record_directory: where to record the robot's inputs in each test, as scripts for replay
    :param only_changed: run only tests that a change since their last pass can have reached
    :param hang_seconds: CPU time without progress, in seconds, after which robot code is considered hanging
    """

    __test__ = False  # pytest: not a test class, despite its name

    seed: int = DEFAULT_SEED
    jobs: Jobs = 1
    isolation: Isolation = "auto"
    trace_directory: Path | None = None
    record_directory: Path | None = None
    hang_seconds: float = TestSettings.hang_seconds
    only_changed: bool = False

    @classmethod
    def combined(
        cls,
        settings: TestSettings,
        *,
        seed: int | None = None,
        jobs: Jobs | None = None,
        isolation: Isolation | None = None,
        trace_directory: Path | None = None,
        record_directory: Path | None = None,
        only_changed: bool = False,
    ) -> TestOptions:
        """Return the options of the command line, completed by the project's settings and the defaults."""
        return cls(
            seed=DEFAULT_SEED if seed is None else seed,
            jobs=jobs or settings.jobs,
            isolation=isolation or settings.isolation,
            trace_directory=trace_directory,
            record_directory=record_directory,
            hang_seconds=settings.hang_seconds,
            only_changed=only_changed,
        )
