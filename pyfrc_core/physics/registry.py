"""Build the unit registry from pint's definitions, cached on disk.

The registry is built on import: Python's import lock ensures that there is only one.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    from types import ModuleType
    from typing import TypeAlias

    UnitRegistry: TypeAlias = "pint.UnitRegistry[Any]"


@contextmanager
def _without_dask() -> Iterator[None]:
    """Have imports behave as if dask were not installed: pint would import it for arrays that no robot has."""
    imported = sys.modules.setdefault("dask", cast("ModuleType", None))
    try:
        yield
    finally:
        if imported is None:
            del sys.modules["dask"]


with _without_dask():
    import pint
    import platformdirs

DEFINITIONS = [
    # pint's own rpm includes an angle, which makes it 2 pi times as large.
    "counts_per_minute = count / minute = cpm",
    "@alias ampere = amps",  # otherwise attometres per second
    "N_m = newton * meter",
    # The voltage per speed and per acceleration, in the units of the drivetrain characterization paper.
    "tm_kv = volt / (foot / second)",
    "tm_ka = volt / (foot / second ** 2)",
]


def cache_folder() -> Path | None:
    """Return the folder of the parsed definitions; None when the user has no cache directory, as in some containers.

    Each version of Python and of pint has its own folder, since they cannot read each other's pickles.
    """
    try:
        cache = platformdirs.user_cache_path("pyfrc", appauthor=False)
    except Exception:  # no home directory; the exception depends on the platform
        return None
    version = f"pint-{pint.__version__}-{sys.implementation.cache_tag}-{'.'.join(map(str, sys.version_info[:3]))}"
    return cache / version if cache.is_absolute() else None


def build(folder: Path | None) -> UnitRegistry:
    """Return a registry with our units, from the definitions in `folder`; write them there if they are missing.

    Without a usable folder the registry is built from the source definitions. What a killed process has left there is
    removed: the next run writes it again.
    """
    registry: UnitRegistry | None = None
    if folder is not None:
        try:
            registry = pint.UnitRegistry(cache_folder=folder)
        except Exception:  # a damaged pickle may raise any; also where nothing can be written
            shutil.rmtree(folder, ignore_errors=True)
    if registry is None:
        registry = pint.UnitRegistry()
    registry.load_definitions(DEFINITIONS)
    return registry


registry = build(cache_folder())
