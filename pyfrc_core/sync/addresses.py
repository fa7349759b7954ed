"""The addresses of a season's downloads, and the variables of the environment that replace them."""

from __future__ import annotations

import os

from ..season import Season

#: Another package index than WPILib's of the season, such as a mirror; empty: only those of pip's own settings.
INDEX_VARIABLE = "PYFRC_SYNC_INDEX"
#: Another address of the same file with the robot's Python.
PYTHON_VARIABLE = "PYFRC_SYNC_PYTHON"


def index_of(season: Season) -> str:
    """Return the address of WPILib's own index of a season."""
    return os.environ.get(INDEX_VARIABLE, season.downloads.index)


def python_url_of(season: Season) -> str:
    """Return the address of the file with the robot's Python."""
    return os.environ.get(PYTHON_VARIABLE) or season.downloads.python_url
