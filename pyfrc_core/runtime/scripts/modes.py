"""The driver station's mode: its name, and how robots publish it."""

from __future__ import annotations

#: The bits of ``FMSControlData``, which robots publish until 2026.
ENABLED, AUTONOMOUS, TEST, STOPPED, FMS_ATTACHED, DS_ATTACHED = 1, 2, 4, 8, 16, 32
#: What is selected, by the number ``robotMode`` that robots publish from 2027 on; others are teleop.
SELECTED_BY_NUMBER = {1: "autonomous", 3: "test"}


def selected(autonomous: object, test: object) -> str:
    """Return which mode is selected; an empty text is teleop."""
    return "autonomous" if autonomous else "test" if test else ""


def mode_name(enabled: object, selected: str) -> str:
    """Return the mode: ``teleop``, ``disabled``, ``disabled autonomous``, and so on.

    :param selected: ``autonomous`` or ``test``; ``teleop`` or empty: neither
    """
    if enabled:
        return selected or "teleop"
    return "disabled" if selected in ("", "teleop") else f"disabled {selected}"
