"""Where random generators start from, so that chance is the same in every run."""

from __future__ import annotations

import random
import sys

from ..compat.rev_noise import seed_noise


def seed_generators(seed: int) -> None:
    """Start Python's global generator, and those of numpy and REV's library if they are imported, from `seed`."""
    random.seed(seed)
    numpy = sys.modules.get("numpy")
    if numpy is not None:
        numpy.random.seed(seed % 2**32)
    seed_noise(seed)
