"""Random numbers are the same in every run, also those of libraries that are imported later."""

from __future__ import annotations

import subprocess
import sys

SEED = "from pyfrc_core.runtime.seeds import seed_generators; seed_generators({seed})"


def drawn(*lines: str) -> str:
    """Run the lines in a new interpreter, and return what they print."""
    done = subprocess.run([sys.executable, "-c", "\n".join(lines)], capture_output=True, text=True, check=True)
    return done.stdout


def test_numpy_draws_the_same_however_and_whenever_it_is_imported() -> None:
    draw = "print(numpy.random.random(), numpy.random.normal())"
    fifth, sixth = drawn("import numpy", SEED.format(seed=5), draw, SEED.format(seed=6), draw).splitlines(keepends=True)
    assert fifth != sixth
    for imported in ("import numpy.linalg, numpy", "from numpy import random; import numpy"):
        assert drawn(SEED.format(seed=5), imported, draw) == fifth
    assert drawn(SEED.format(seed=5), SEED.format(seed=6), "import numpy", draw) == sixth, "the last seed counts"


def test_a_library_that_is_not_installed_is_still_missing() -> None:
    missing = "import sys; sys.path = [p for p in sys.path if 'site-packages' not in p]"
    tried = "try: import numpy\nexcept ModuleNotFoundError as error: print(error)"
    assert drawn(SEED.format(seed=5), missing, tried) == "No module named 'numpy'\n"
