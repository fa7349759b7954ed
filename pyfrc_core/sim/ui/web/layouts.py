"""The layout of a project's page: what a page has saved, in ``.pyfrc/sim-layout.json``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ....text_files import keep_out_of_version_control, write_whole

#: The largest layout, in characters of JSON.
MOST = 256 * 1024


def load_layout(root: Path) -> Any:
    """Return the saved layout; None if there is none that can be read."""
    try:
        file = _file(root).resolve()
        # Another file would be handed to those who look at the page.
        return json.loads(file.read_text("utf-8")) if file.is_relative_to(root.resolve()) else None
    except (OSError, ValueError, RuntimeError, RecursionError):
        return None


def save_layout(root: Path, changes: Any) -> None:
    """Save what a page has changed. What other pages have changed stays.

    :param changes: by name, the new values; of an object, its new values. None removes a value
    :raises ValueError: when it is no object, or the layout too large
    :raises OSError: when it cannot be written
    """
    if not isinstance(changes, dict):
        raise ValueError("a layout is one object")
    saved = load_layout(root)
    layout = dict(saved) if isinstance(saved, dict) else {}
    for name, value in changes.items():
        before = layout.get(name)
        layout[name] = _merged(before if isinstance(before, dict) else {}, value) if isinstance(value, dict) else value
    text = json.dumps(_merged(layout, {}), indent=1)
    if len(text) > MOST:
        raise ValueError(f"the layout has {len(text)} characters; at most {MOST} are saved")
    file = _file(root)
    file.parent.mkdir(exist_ok=True)
    keep_out_of_version_control(file.parent)
    write_whole(file, [text + "\n"])


def _merged(before: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in {**before, **changes}.items() if value is not None}


def _file(root: Path) -> Path:
    return root / ".pyfrc" / "sim-layout.json"
