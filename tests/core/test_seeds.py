"""Random numbers are the same in every run, also those of libraries that are imported later."""

from __future__ import annotations

import subprocess
import sys

import pytest

SEED = "from pyfrc_core.runtime.seeds import seed_generators; seed_generators({seed})"


def drawn(*lines: str) -> str:
    """Run the lines in a new interpreter, and return what they print."""
    done = subprocess.run([sys.executable, "-c", "\n".join(lines)], capture_output=True, text=True, check=True)
    return done.stdout


def test_numpy_draws_the_same_whether_it_is_imported_before_or_after() -> None:
    draw = "print(numpy.random.random(), numpy.random.normal())"
    before = drawn("import numpy", SEED.format(seed=5), draw)
    after = drawn(SEED.format(seed=5), "import numpy", draw)
    assert before == after != ""


@pytest.mark.parametrize("first", ["import numpy.linalg, numpy", "from numpy import random; import numpy"])
def test_it_is_seeded_however_it_is_imported(first: str) -> None:
    draw = "print(numpy.random.random())"
    assert drawn(SEED.format(seed=5), first, draw) == drawn("import numpy", SEED.format(seed=5), draw)


def test_the_last_seed_counts() -> None:
    draw = "print(numpy.random.random())"
    twice = drawn(SEED.format(seed=5), SEED.format(seed=6), "import numpy", draw)
    assert twice == drawn("import numpy", SEED.format(seed=6), draw)
    again = drawn(SEED.format(seed=5), "import numpy; numpy.random.random()", SEED.format(seed=6), draw)
    assert again == twice


def test_a_library_that_is_not_installed_is_still_missing() -> None:
    missing = "import sys; sys.path = [p for p in sys.path if 'site-packages' not in p]"
    tried = "try: import numpy\nexcept ModuleNotFoundError as error: print(error)"
    assert drawn(SEED.format(seed=5), missing, tried) == "No module named 'numpy'\n"
