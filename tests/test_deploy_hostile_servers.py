"""100 servers that are no robot, or one that misbehaves: one sentence and exit code 1, within the time limits."""

from __future__ import annotations

import random
import socket
import struct
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from pyfrc_core.deploy import connection, login
from pyfrc_core.deploy.connection import connect
from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.errors import DeployError
from pyfrc_core.deploy.host_keys import HostKeys
from pyfrc_core.deploy.targets.roborio import ROBORIO

SSH = b"SSH-2.0-robot\r\n"
#: Time limits of each step, and of everything with them, which only a connection that hangs reaches; seconds.
_STEP, _ALL = 0.3, 25.0


#: What a server does with a connection.
Serve = Callable[[socket.socket, threading.Event], None]

_KEX = [
    "curve25519-sha256@libssh.org",
    "ecdsa-sha2-nistp256",
    "aes128-ctr",
    "aes128-ctr",
    "hmac-sha2-256",
    "hmac-sha2-256",
]


@contextmanager
def serving(serve: Serve) -> Iterator[Address]:
    """Serve each connection in a thread of its own."""
    over = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def accept() -> None:
            while True:
                try:
                    connected = listener.accept()[0]
                except OSError:
                    return
                threading.Thread(target=one, args=(connected,), daemon=True).start()

        def one(connected: socket.socket) -> None:
            with connected, suppress(OSError):  # the client may be gone
                serve(connected, over)

        threading.Thread(target=accept, daemon=True).start()
        try:
            yield Address("127.0.0.1", listener.getsockname()[1])
        finally:
            over.set()
            listener.shutdown(socket.SHUT_RDWR)


def packet(payload: bytes) -> bytes:
    """An SSH packet, as it is before there are keys."""
    padding = 8 - (5 + len(payload)) % 8 + (8 if (5 + len(payload)) % 8 > 4 else 0)
    return struct.pack(">IB", len(payload) + padding + 1, padding) + payload + bytes(padding)


def kex_init(*lists: str, tail: bytes = bytes(5)) -> bytes:
    """The packet that begins a key exchange."""
    names = [*lists, *_KEX[len(lists) :], "none", "none", "", ""]
    return packet(b"\x14" + bytes(16) + b"".join(struct.pack(">I", len(each)) + each.encode() for each in names) + tail)


def says(data: bytes, then: str = "close") -> Serve:
    """Send data, then close the connection, reset it, or be silent."""

    def serve(connected: socket.socket, over: threading.Event) -> None:
        connected.sendall(data)
        if then == "reset":
            connected.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        elif then == "close":
            connected.shutdown(socket.SHUT_WR)
            connected.settimeout(1.0)
            while connected.recv(4096):
                pass
        else:
            over.wait(30)

    return serve


def repeats(data: bytes, begin: bytes = b"", pause: float = 0.0) -> Serve:
    """Send the same for ever."""

    def serve(connected: socket.socket, over: threading.Event) -> None:
        connected.sendall(begin)
        while not over.wait(pause):
            connected.sendall(data)

    return serve


def garbage(seed: int, count: int) -> bytes:
    return random.Random(seed).randbytes(count)


def before_the_greeting() -> Iterator[tuple[str, Serve]]:
    for seed in range(12):
        for then in ("close", "silence"):
            yield f"garbage {seed}, {then}", says(garbage(seed, 3**seed % 4000), then)
    texts = {
        "nothing": b"",
        "half of it": b"SSH-",
        "without an end": SSH[:-2],
        "an old version": b"SSH-1.5-old\r\n",
        "a number": b"SSH-99.9-robot\r\n",
        "a long one": b"SSH-2.0-" + b"x" * 10_000 + b"\r\n",
        "no text": b"SSH-2.0-\xff\xfe\0\r\n",
        "a web server": b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n",
        "TLS": bytes.fromhex("15030100020228"),
        "mail": b"220 mail\r\n" * 200,
        "only lines": b"\n" * 5_000,
    }
    for name, text in texts.items():
        for then in ("close", "reset", "silence"):
            yield f"{name}, {then}", says(text, then)
    yield "lines for ever", repeats(b"wait\r\n")
    yield "bytes for ever", repeats(b"x" * 1000)
    yield "zeros for ever", repeats(bytes(1000))
    yield "a greeting for ever", repeats(SSH)
    yield "a greeting in an endless line", repeats(b"SSH-")
    yield "a slow line", repeats(b"S", pause=0.1)
    yield "slow lines", repeats(b"wait\r\n", pause=0.1)


def in_the_key_exchange() -> Iterator[tuple[str, Serve]]:
    packets = {
        "a packet of no length": bytes(64),
        "a huge packet": b"\xff" * 64,
        "a packet of 32 MB": struct.pack(">IB", 1 << 25, 4) + b"\x14" + bytes(64),
        "too much padding": struct.pack(">IB", 12, 250) + bytes(64),
        "an odd length": struct.pack(">IB", 13, 4) + bytes(64),
        "a disconnect": packet(b"\x01" + struct.pack(">II", 2, 4) + b"away" + bytes(4)),
        "a disconnect of no text": packet(b"\x01" + struct.pack(">II", 2, 99) + b"\xff"),
        "an empty packet": packet(b""),
        "a second greeting": SSH,
        "a packet of the login without keys": packet(b"\x06" + struct.pack(">I", 12) + b"ssh-userauth"),
        "an unknown packet": packet(b"\xc8" + b"x" * 20),
        "a packet of the login": packet(b"\x34"),
        "a key without an exchange": packet(b"\x1f" + bytes(60)),
        "no kex in common": kex_init("rot13"),
        "no key in common": kex_init("curve25519-sha256@libssh.org", "rot13"),
        "no cipher in common": kex_init("curve25519-sha256@libssh.org", "ecdsa-sha2-nistp256", "rot13", "rot13"),
        "names that are no text": kex_init("\udcff".encode(errors="surrogateescape").decode("latin-1")),
        "an exchange cut short": packet(b"\x14" + bytes(16) + struct.pack(">I", 1000) + b"x"),
        "an exchange and garbage": kex_init() + garbage(5, 300),
        "a wrong reply": kex_init() + packet(b"\x1f" + struct.pack(">I", 4) + b"evil" + bytes(40)),
        "a reply cut short": kex_init() + packet(b"\x1f" + struct.pack(">I", 1 << 20)),
        "new keys too soon": kex_init() + packet(b"\x15"),
    }
    for name, data in packets.items():
        for then in ("close", "silence"):
            yield f"{name}, {then}", says(SSH + data, then)
    yield "ignored packets for ever", repeats(packet(b"\x02" + struct.pack(">I", 4) + b"text"), SSH)
    yield "debug packets for ever", repeats(packet(b"\x04\0" + struct.pack(">I", 4) + b"text" + bytes(4)), SSH)
    yield "exchanges for ever", repeats(kex_init(), SSH, 0.01)
    yield "one byte after the other", repeats(b"\0", SSH, 0.1)


SERVERS = {
    f"{stage.__name__}: {name}": serve
    for stage in (before_the_greeting, in_the_key_exchange)
    for name, serve in stage()
}


def meet(serve: Serve, directory: Path) -> tuple[BaseException | None, float]:
    """Connect to a server. Return what is raised, and how long it took."""
    begin = time.monotonic()
    with serving(serve) as address:
        try:
            connect(address, ROBORIO, HostKeys(directory).of_robot(address, ROBORIO)).close()
        except BaseException as error:
            return error, time.monotonic() - begin
    return None, time.monotonic() - begin


def test_all_servers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """At once, since most of the time is spent with waiting."""
    for module in (connection, login):
        monkeypatch.setattr(module, "STEP_SECONDS", _STEP)
    assert len(SERVERS) >= 100
    found: dict[str, tuple[BaseException | None, float]] = {}
    waiting = list(SERVERS)

    def work() -> None:
        while waiting:
            name = waiting.pop()
            directory = tmp_path / str(len(waiting))
            directory.mkdir()
            found[name] = meet(SERVERS[name], directory)

    threads = [threading.Thread(target=work, daemon=True) for _ in range(16)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)
    assert found.keys() == SERVERS.keys(), "some connection never ends"
    assert not [*tmp_path.rglob("known_hosts")], "no key is pinned without a login"
    for name, (error, seconds) in found.items():
        assert isinstance(error, DeployError), f"{name}: {error!r}"
        assert error.exit_code == 1, name
        text = str(error)
        assert all(line.isprintable() for line in text.splitlines()), f"{name}: {text!r}"
        if name.startswith("in_the_key_exchange"):
            assert ": could not log in to the robot: " in text, f"{name}: {text!r}"
            assert "Check the link" in text
        assert error.remedy, name
        assert seconds < _ALL, f"{name}: {seconds:.1f} s"
