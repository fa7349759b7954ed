"""The addresses of a season's downloads, and the variables of the environment that replace or extend them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import unquote, urlsplit

from ..season import Season

#: Another package index than WPILib's of the season, such as a mirror; empty: only those of pip's own settings.
INDEX_VARIABLE = "PYFRC_SYNC_INDEX"
#: Another address of the robot's Python, or the path of its archive.
PYTHON_VARIABLE = "PYFRC_SYNC_PYTHON"
#: pip's own variable for its option ``--find-links``: places with spaces between them.
_PIP_LINKS_VARIABLE = "PIP_FIND_LINKS"


def index_of(season: Season) -> str:
    """Return the address of WPILib's own index of a season."""
    return os.environ.get(INDEX_VARIABLE, season.downloads.index)


def replaced_python_url() -> str | None:
    """Return the address that the user names for the robot's Python; ``file:`` for a path. None: the season's."""
    named = os.environ.get(PYTHON_VARIABLE)
    if not named or urlsplit(named).scheme in ("http", "https", "file"):
        return named or None
    return Path(named).absolute().as_uri()


def file_name_in(url: str) -> str:
    """Return the name of the file at an address."""
    return unquote(urlsplit(url).path.rpartition("/")[2])


def link_directories(find_links: Sequence[str]) -> list[Path]:
    """Return the directories where pip looks for packages: those of the option, and of pip's variable."""
    places = [*find_links, *os.environ.get(_PIP_LINKS_VARIABLE, "").split()]
    return [Path(each) for each in places if Path(each).is_dir()]
