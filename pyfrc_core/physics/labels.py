"""Labels: values shown in the simulator, stored in `hal_data['custom']`."""

from __future__ import annotations

from ..runtime.patches import patches


def show_label(label: str, value: object) -> None:
    """Show `value` as text in a box with this label. Does nothing while no robot runs."""
    if patches.run is not None:
        patches.run.hal_data["custom"][label] = value
