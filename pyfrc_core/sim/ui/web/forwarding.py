"""The addresses at which a browser finds the page through a forwarded port, besides this computer's own."""

from __future__ import annotations

import os
from collections.abc import Sequence
from urllib.parse import urlsplit

from ....errors import UsageError


def allowed_origins(hosts: Sequence[str]) -> tuple[str, ...]:
    """Return the origins (scheme, host and port) of the page at the hosts that the user allows.

    :raises UsageError: when one of them is no host
    """
    return tuple(map(_origin_of, hosts))


def name_of(origin: str) -> str:
    """Return the host's name in an origin."""
    return urlsplit(origin).hostname or ""


def _origin_of(host: str) -> str:
    """Return the origin of ``NAME``, ``NAME:PORT`` or ``http://NAME:PORT``. Services that forward a port use https."""
    wrong = UsageError(
        f"--allow-host {host}: this is no host", remedy="Write NAME, NAME:PORT, or an address such as http://NAME:8080."
    )
    try:
        parts = urlsplit(host if "://" in host else f"https://{host}")
        port = parts.port
    except ValueError:
        raise wrong from None
    name = parts.hostname or ""
    bare = not (parts.username or parts.query or parts.fragment or parts.path.strip("/"))
    if parts.scheme not in ("http", "https") or not bare or not name or not set(name).isdisjoint("*?,; '\"<>"):
        raise wrong
    usual = 443 if parts.scheme == "https" else 80
    shown = f"[{name}]" if ":" in name else name
    return f"{parts.scheme}://{shown}" if port in (None, usual) else f"{parts.scheme}://{shown}:{port}"


def codespace_origins(port: int) -> tuple[str, ...]:
    """Return the origin at which GitHub forwards a port of this computer, if it is a Codespace."""
    name = os.environ.get("CODESPACE_NAME")
    domain = os.environ.get("GITHUB_CODESPACES_PORT_FORWARDING_DOMAIN")
    return (f"https://{name}-{port}.{domain}".lower(),) if name and domain else ()
