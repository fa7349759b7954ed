"""Builds the unit registry, with pint's definitions kept on disk: parsing them anew takes as long as importing pint.

The registry is built where this module is imported: Python's own import lock sees to it that there is one.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing import TypeAlias

    UnitRegistry: TypeAlias = "pint.UnitRegistry[Any]"


@contextmanager
def _collector_paused() -> Iterator[None]:
    """No garbage collection inside: it would look through thousands of new definitions, and find them all in use."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


with _collector_paused():
    import pint
    import platformdirs

DEFINITIONS = [
    # pint's own rpm has an angle in it, which makes it 2 pi times as much.
    "counts_per_minute = count / minute = cpm",
    "N_m = newton * meter",
    # What a motor needs at a speed, and for an acceleration, in the units of the drivetrain characterization paper.
    "tm_kv = volt / (foot / second)",
    "tm_ka = volt / (foot / second ** 2)",
]


def cache_folder() -> Path | None:
    """Where parsed definitions are kept; None when this user has no such place, as in a container without a home.

    One folder for each version of Python and of pint, since neither reads what the other has pickled.
    """
    try:
        cache = platformdirs.user_cache_path("pyfrc", appauthor=False)
    except Exception:  # no home directory to be found; what is raised then depends on the platform
        return None
    version = f"pint-{pint.__version__}-{sys.implementation.cache_tag}-{'.'.join(map(str, sys.version_info[:3]))}"
    return cache / version if cache.is_absolute() else None


def build(folder: Path | None) -> UnitRegistry:
    """A registry with our units, from the definitions in `folder`, where they are put if they cannot be had.

    Works without a cache as with one: a folder that cannot be written, or holds something else, only costs time.
    """
    registry: UnitRegistry | None = None
    if folder is not None:
        if folder.is_dir():
            # Whatever a damaged pickle raises, which may be anything.
            with suppress(Exception):
                registry = pint.UnitRegistry(cache_folder=folder)
        if registry is None:
            with suppress(OSError):
                registry = _build_and_keep(folder)
    if registry is None:
        registry = pint.UnitRegistry()
    registry.load_definitions(DEFINITIONS)
    return registry


def _build_and_keep(folder: Path) -> UnitRegistry:
    """Parse the definitions beside `folder`, then move them there: another process never sees half of them."""
    import shutil
    import tempfile

    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f"{folder.name}-", dir=folder.parent, ignore_cleanup_errors=True) as new:
        complete = Path(new) / "definitions"
        registry: UnitRegistry = pint.UnitRegistry(cache_folder=complete)
        shutil.rmtree(folder, ignore_errors=True)
        with suppress(OSError):  # another process was first: its definitions are the same
            complete.rename(folder)
    return registry


with _collector_paused():
    registry = build(cache_folder())
