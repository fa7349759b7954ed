"""Labels: values that helpers show in the simulator, under `hal_data['custom']`."""

from __future__ import annotations

from ..runtime.redirect import redirection


def show_label(label: str, value: object) -> None:
    """Show `value` as text in a box with this label; does nothing while no robot runs."""
    if redirection.run is not None:
        redirection.run.hal_data["custom"][label] = value
