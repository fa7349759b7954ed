"""What robot code may ask of the simulator while it runs in one."""

from __future__ import annotations


def get_user_renderer() -> None:
    """What draws on the simulated field: None, as nothing does in tests."""
    return
