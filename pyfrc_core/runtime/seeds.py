"""Where random generators start from, so that chance is the same in every run."""

from __future__ import annotations

import random
from typing import Any

from ..compat.unrepeatable import forget_noise
from .after_import import after_import


def seed_generators(seed: int) -> None:
    """Start Python's global generator and numpy's from `seed`, at the begin of a run.

    If numpy is imported later, by physics.py or in `robotInit`, it is seeded when it is imported.
    """

    def seed_numpy(numpy: Any) -> None:
        numpy.random.seed(seed % 2**32)

    forget_noise()
    random.seed(seed)
    after_import("numpy", seed_numpy)
