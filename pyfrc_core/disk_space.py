"""Whether there is room for more where a file is written."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryFile

#: More than WPILib's data log holds back, in bytes.
_ENOUGH = 1 << 17


def lack_of_room(beside: Path) -> str:
    """Why no more can be written into this file's directory, in the system's words; "" where it can be."""
    try:
        with TemporaryFile(dir=beside.parent) as probe:
            probe.write(bytes(_ENOUGH))
    except OSError as error:
        return error.strerror or str(error)
    return ""
