"""How a test run was asked for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

from ..config.settings import TestSettings
from ..processors import usable_processors

Isolation: TypeAlias = Literal["auto", "fork", "spawn", "none"]

DEFAULT_SEED = 0

#: The package of the ready-made tests; they use this one, which imports none of them.
READY_MADE_TESTS = "pyfrc_core.tests"


@dataclass(frozen=True)
class TestOptions:
    """How a test run was asked for.

    :param seed: what the random generators of Python and numpy start from, in every test
    :param jobs: how many tests run at the same time
    :param isolation: what each test that uses the robot runs in
    :param trace_directory: where to write what the robot did in each test
    :param record_directory: where to write what the robot was told in each test, as scripts that can be replayed
    :param hang_seconds: processor seconds without progress after which robot code counts as hanging
    """

    __test__ = False  # pytest: not a test class, for all its name

    seed: int = DEFAULT_SEED
    jobs: int = 1
    isolation: Isolation = "auto"
    trace_directory: Path | None = None
    record_directory: Path | None = None
    hang_seconds: float = TestSettings.hang_seconds

    @classmethod
    def combined(
        cls,
        settings: TestSettings,
        *,
        seed: int | None = None,
        jobs: int | Literal["auto"] | None = None,
        isolation: Isolation | None = None,
        trace_directory: Path | None = None,
        record_directory: Path | None = None,
    ) -> TestOptions:
        """What the command line says, else what the project's settings say, else the defaults."""
        jobs = jobs or settings.jobs
        return cls(
            seed=DEFAULT_SEED if seed is None else seed,
            jobs=usable_processors() if jobs == "auto" else jobs,
            isolation=isolation or settings.isolation,
            trace_directory=trace_directory,
            record_directory=record_directory,
            hang_seconds=settings.hang_seconds,
        )
