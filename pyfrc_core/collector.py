"""Python's collector of circular references, paused during imports."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def collector_paused() -> Iterator[None]:
    """Pause the collector during the ``with`` block, for imports of many modules.

    What they allocate stays, so the collector would look at it again and again in vain. It does not look at anything
    from before the end of the block again.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if was_enabled:
            gc.enable()
