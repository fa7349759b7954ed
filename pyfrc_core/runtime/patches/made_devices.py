"""Note the devices that robot code makes, where WPILib's simulation does not report what `hal_data` shows of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...patch_table import Patch


def noting(device_class: type[Any], note: Callable[..., object]) -> Patch:
    """Return the constructor that also calls a function, with the new device and the constructor's arguments."""
    real: Callable[..., None] = device_class.__init__

    def __init__(self: Any, *args: Any, **kwargs: Any) -> None:
        __tracebackhide__ = True
        real(self, *args, **kwargs)
        note(self, *args, **kwargs)

    return Patch(device_class, "__init__", __init__)
