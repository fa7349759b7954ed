"""The page of one of the robot's cameras, which the page of the robot has in a frame.

Cameras are other servers, so their pictures come from other addresses than the page. The frame's own
Content-Security-Policy allows exactly the addresses of this camera; that of the page around it stays as it is.
"""

from __future__ import annotations

import html
import re
from collections.abc import Sequence
from urllib.parse import urlsplit

from ...engine.messages import VALUE

#: What a stream's address begins with that a browser can show as a picture.
_PICTURES = "mjpg:"
_HOST = re.compile(r"[A-Za-z0-9.-]+")
_PATH = re.compile(r"[A-Za-z0-9._~/%-]*")
#: The most addresses of one camera.
_MOST = 8


def streams_path(name: str) -> str:
    """Return the path of the value with a camera's addresses."""
    return f"{VALUE}/CameraPublisher/{name}/streams"


def picture_addresses(streams: object) -> list[str]:
    """Return the addresses of a camera's pictures, as robots publish them: numeric ones first, which need no lookup."""
    given = streams if isinstance(streams, (list, tuple)) else ()
    pictures = [each.removeprefix(_PICTURES) for each in given if isinstance(each, str) and each.startswith(_PICTURES)]
    found = [address for address in pictures if _source_of(address) is not None]
    return sorted(dict.fromkeys(found), key=lambda address: not _is_numeric(address))[:_MOST]


def camera_page(name: str, addresses: Sequence[str]) -> tuple[str, str]:
    """Return the page of a camera, and its Content-Security-Policy."""
    sources = dict.fromkeys(source for address in addresses if (source := _source_of(address)) is not None)
    policy = {
        "default-src": "'none'",
        "script-src": "'self'",
        "style-src": "'self'",
        "font-src": "'self'",
        "img-src": " ".join(sources) or "'none'",
        "base-uri": "'none'",
        "form-action": "'none'",
        "frame-ancestors": "'self'",
    }
    text = f"""<!doctype html>
<html lang="en">
  <head>
    <meta charset="utf-8">
    <meta name="color-scheme" content="light dark">
    <title>{html.escape(name)}</title>
    <link rel="stylesheet" href="/static/css/theme.css">
    <link rel="stylesheet" href="/static/css/camera.css">
    <script type="module" src="/static/js/camera.js"></script>
  </head>
  <body>
    <img alt="{html.escape(name)}" data-addresses="{html.escape(" ".join(addresses))}" hidden>
    <p hidden>{_explanation(addresses)}</p>
  </body>
</html>
"""
    return text, "; ".join(f"{name} {value}" for name, value in policy.items())


def _explanation(addresses: Sequence[str]) -> str:
    if not addresses:
        return "No picture: this camera has published no address."
    hosts = dict.fromkeys(urlsplit(address).netloc for address in addresses)
    return f"No picture from {html.escape(', '.join(hosts))}"


def _source_of(address: str) -> str | None:
    """Return what allows an address in a Content-Security-Policy; None for an address that is none."""
    try:
        parts = urlsplit(address)
        port = parts.port
    except ValueError:
        return None
    host = parts.hostname or ""
    if parts.scheme not in ("http", "https") or not _HOST.fullmatch(host) or re.search(r"[\s\"'<>]", address):
        return None
    path = parts.path if _PATH.fullmatch(parts.path) else ""
    return f"{parts.scheme}://{host}{f':{port}' if port else ''}{path}"


def _is_numeric(address: str) -> bool:
    return re.fullmatch(r"[0-9.]+", urlsplit(address).hostname or "") is not None
