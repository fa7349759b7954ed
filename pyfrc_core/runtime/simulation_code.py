"""Which code runs in simulations only: ``physics.py``, and what WPILib calls to simulate."""

from __future__ import annotations

from types import FrameType

from ..wpi import names

_PHYSICS = "physics.py"


def is_of_simulation(frame: FrameType | None) -> bool:
    """Return whether simulation code has called what runs in this frame."""
    while frame is not None:
        code = frame.f_code
        if code.co_name in names.OF_SIMULATION or code.co_filename.endswith(_PHYSICS):
            return True
        frame = frame.f_back
    return False
