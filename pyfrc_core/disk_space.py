"""Check the disk space of a directory."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryFile

#: Bytes to try to write: more than WPILib's data log buffers.
_ENOUGH = 1 << 17


def check_disk_space(beside: Path) -> str:
    """Return why nothing more can be written into this file's directory, as the system's message; "" if it can be."""
    try:
        with TemporaryFile(dir=beside.parent) as probe:
            probe.write(bytes(_ENOUGH))
    except OSError as error:
        return error.strerror or str(error)
    return ""
