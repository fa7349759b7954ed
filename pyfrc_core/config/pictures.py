"""The field's picture: a real picture inside the project. Pages hand it to viewers, who must get no other file."""

from __future__ import annotations

import re
from pathlib import Path

#: How pictures begin, and their media types.
_KINDS = (
    (re.compile(rb"\x89PNG\r\n\x1a\n"), "image/png"),
    (re.compile(rb"\xff\xd8\xff"), "image/jpeg"),
    (re.compile(rb"GIF8[79]a"), "image/gif"),
    (re.compile(rb"RIFF....WEBP", re.DOTALL), "image/webp"),
    (re.compile(rb"P6\s+\d+\s+\d+\s+\d+\s"), "image/x-portable-pixmap"),  # Tk shows it, browsers do not
    (re.compile(rb"BM.{12}\x28\x00\x00\x00", re.DOTALL), "image/bmp"),
    (re.compile(rb"(?:\xef\xbb\xbf)?\s*<(?:\?xml\s[^>]*>\s*(?:<!--.*?-->\s*)*<)?svg[\s>]", re.DOTALL), "image/svg+xml"),
)
_BEGINNING = 1024


def picture_kind(file: Path) -> str | None:
    """Return a picture's media type; None for another file, and where there is none."""
    try:
        if not file.is_file():  # a pipe would be waited for
            return None
        with file.open("rb") as opened:
            beginning = opened.read(_BEGINNING)
    except (OSError, ValueError):  # a name that no file can have
        return None
    return next((kind for pattern, kind in _KINDS if pattern.match(beginning)), None)


def field_picture(root: Path, name: str) -> tuple[Path | None, str]:
    """Return the field's picture, or None and the reason for it.

    :param root: the project's directory
    :param name: the picture's path, relative to ``sim/``
    """
    file = root / "sim" / name
    try:
        if not file.is_file():
            return None, "there is no such file"
        if not file.resolve().is_relative_to(root.resolve()):
            return None, "it is outside of the project, and is not shown"
    except (OSError, ValueError, RuntimeError):
        return None, "there is no such file"
    if picture_kind(file) is None:
        return None, "it is no picture (PNG, JPEG, GIF, WebP, BMP or SVG)"
    return file, ""
