"""Files that tests write."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from zipfile import ZipFile, ZipInfo


def write_files(directory: Path, files: Mapping[str, str | bytes]) -> Path:
    """Write files, named relative to a directory, and return this."""
    for name, content in files.items():
        file = directory / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content.encode() if isinstance(content, str) else content)
    return directory


def zip_of(files: Mapping[str, str | bytes]) -> bytes:
    """Return an archive of files, as a wheel is one: always of the same time, so of the same bytes."""
    content = io.BytesIO()
    with ZipFile(content, "w") as archive:
        for path, text in files.items():
            archive.writestr(ZipInfo(path), text)
    return content.getvalue()
