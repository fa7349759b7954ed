"""Where random generators start from, so that chance is the same in every run."""

from __future__ import annotations

import random
import sys


def seed_generators(seed: int) -> None:
    """Start Python's global generator, and numpy's if it is imported, from `seed`."""
    random.seed(seed)
    numpy = sys.modules.get("numpy")
    if numpy is not None:
        numpy.random.seed(seed % 2**32)
