"""Files of programs in Java and C++ on a robot."""

from __future__ import annotations

import re

from .disk import text_of
from .robot_paths import RobotPaths


def find_other_languages(paths: RobotPaths) -> list[str]:
    """Return the files and directories of programs in Java and C++ that can be removed."""
    layout = paths.layout
    commands = [f"{layout.home}/{name}" for name in layout.command_files]
    found = [file for file in commands if re.search(layout.other_start, text_of(paths.of(file)) or "")]
    for pattern in layout.other_files:
        parent, _, name = pattern.rpartition("/")
        if name:
            found += sorted(f"{parent}/{each.name}" for each in paths.of(parent).glob(name))
        elif paths.of(parent).is_dir() and any(paths.of(parent).iterdir()):
            found.append(parent)
    return found
