"""The HAL as it is where a robot runs: resets of its data are announced, so that its reports can be relied on."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from pyfrc_core.compat.hal_callbacks import resets
from pyfrc_core.runtime.hal_resets import patches
from pyfrc_core.runtime.patch_table import patched


@contextmanager
def announced_resets(announced: bool = True) -> Iterator[None]:
    """Announce resets in this context, as `runtime.patches` has it."""
    if not announced:
        yield
        return
    with patched(patches(lambda: None)):
        resets.announced = True
        try:
            yield
        finally:
            resets.announced = False
