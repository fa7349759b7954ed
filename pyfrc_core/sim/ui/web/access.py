"""Who may see and drive: tokens, and the hosts and origins that requests may have.

The token in the address is the only key: no cookie, which other servers on this computer would get and other pages
could use. `Host` is checked since a page from elsewhere could have its own name resolved to this computer, and `Origin`
since any page may open a WebSocket to it.
"""

from __future__ import annotations

import ipaddress
import os
import secrets
import socket
from collections.abc import Awaitable, Callable, MutableMapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal
from urllib.parse import parse_qs, urlsplit

from ....errors import UsageError
from .single_file import import_map_source


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


Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

#: What a client may do; None: nothing.
Role = Literal["drive", "view"]
#: What clients on the network may do; None: only this computer is served.
Share = Literal["view", "drive"]

_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}


def _token() -> str:
    return secrets.token_urlsafe(24)


@dataclass(frozen=True)
class Access:
    """The keys of one server.

    :param share: what clients on the network may do
    :param origins: where else browsers find the page, through a forwarded port
    :param drive: the token that drives; `view` is the one that only sees
    """

    share: Share | None = None
    origins: tuple[str, ...] = ()
    drive: str = field(default_factory=_token)
    view: str = field(default_factory=_token)

    def role_of(self, scope: Scope) -> Role | None:
        """Return what the client of a request may do."""
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[-1].encode()
        # Both are always compared: the time that it takes shows nothing.
        drives = secrets.compare_digest(given, self.drive.encode())
        sees = secrets.compare_digest(given, self.view.encode())
        if drives and (self.share == "drive" or _is_this_computer(scope)):
            return "drive"
        return "view" if sees else None

    def allows_host(self, host: str) -> bool:
        """Return whether a request may have this `Host` header."""
        name = _name_of(host)
        if name in ("localhost", "127.0.0.1", "::1") or name in map(name_of, self.origins):
            return True
        if self.share is None:
            return False
        own = socket.gethostname().lower()
        return _is_address(name) or name in (own, f"{own}.local")  # no page from elsewhere has such a name

    def allows_origin(self, origin: str, host: str) -> bool:
        """Return whether a request with this `Host` header, which is allowed, may have this `Origin` header.

        What forwards a port may change the one header and not the other, and it ends TLS.
        """
        if origin == f"http://{host}" or origin in self.origins:
            return True
        return bool(self.origins) and origin == f"https://{host}"


def _name_of(host: str) -> str:
    """Return the name in a `Host` header, without the port."""
    if host.startswith("["):
        return host[1:].partition("]")[0]
    return host.partition(":")[0].lower()


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _is_this_computer(scope: Scope) -> bool:
    client = scope.get("client")
    if not client:
        return False
    try:
        return ipaddress.ip_address(client[0]).is_loopback
    except ValueError:
        return False


class Guard:
    """Refuses requests of other hosts and origins, and adds the headers that keep a page to its own files.

    :param app: what is guarded
    """

    def __init__(self, app: App, access: Access) -> None:
        self._app, self._access = app, access

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        host = headers.get("host", "")
        origin = headers.get("origin")
        access = self._access
        if not access.allows_host(host) or (origin is not None and not access.allows_origin(origin, host)):
            await _refuse(scope, receive, send)
            return

        async def send_guarded(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                added = {**_HEADERS, "Content-Security-Policy": _policy(host, access.origins)}
                given = list(message.get("headers", ()))
                known = {name.lower() for name, _ in given}  # the page of a camera has others
                new = ((name.lower().encode(), value.encode()) for name, value in added.items())
                message["headers"] = [*given, *(header for header in new if header[0] not in known)]
            await send(message)

        await self._app(scope, receive, send_guarded)


def _policy(host: str, origins: Sequence[str]) -> str:
    """Return a page's Content-Security-Policy. `connect-src` names WebSockets for browsers in which 'self' has none."""
    forwarded = "".join(f" ws{origin.removeprefix('http')}" for origin in origins)  # wss for https
    rules = {
        "default-src": "'none'",
        "script-src": f"'self' {import_map_source()}",
        "style-src": "'self'",
        "img-src": "'self' data: blob:",
        "font-src": "'self'",
        "frame-src": "'self'",
        "connect-src": f"'self' ws://{host}{forwarded}",
        "base-uri": "'none'",
        "form-action": "'none'",
        "frame-ancestors": "'none'",
    }
    return "; ".join(f"{name} {value}" for name, value in rules.items())


async def _refuse(scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008})
        return
    text = b"This address is not served here.\n"
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(text)).encode())]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": text})
