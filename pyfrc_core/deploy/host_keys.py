"""The host keys of a project's robots: pinned when first seen, compared ever after.

Kept in ``.pyfrc/known_hosts``, in OpenSSH's format, for one person and one checkout: not committed. Written and read
here rather than with `paramiko.HostKeys`, which keeps one key of a kind for an address: a team's robots (this year's,
the one for practice) have the same addresses and different keys.

Who helps in the pit, outside of any project, has the keys of the robots they have met in ``~/.pyfrc/known_hosts``.
"""

from __future__ import annotations

import base64
import hashlib
from dataclasses import dataclass
from pathlib import Path

from ..text_files import write_whole
from .discovery import USB_CABLE, Address
from .errors import HostKeyError

KNOWN_HOSTS = Path(".pyfrc", "known_hosts")


@dataclass(frozen=True)
class HostKey:
    """A server's public key.

    :param kind: such as ``ssh-ed25519``
    :param blob: the key as SSH sends it
    """

    kind: str
    blob: bytes

    @property
    def fingerprint(self) -> str:
        """``SHA256:...``, as `ssh-keygen -l` shows it."""
        return "SHA256:" + base64.b64encode(hashlib.sha256(self.blob).digest()).decode().rstrip("=")


class HostKeys:
    """The keys that a project knows.

    :param directory: the project's
    """

    #: Whether they are those of robots of many teams.
    _of_many_teams = False

    def __init__(self, directory: Path) -> None:
        self._file = directory / KNOWN_HOSTS
        self._lines = _lines_of(self._file)

    @classmethod
    def of_user(cls) -> HostKeys:
        """Those that this user knows outside of projects."""
        keys = cls(Path.home())
        keys._of_many_teams = True
        return keys

    def known(self, address: Address) -> list[HostKey]:
        """The keys pinned for an address."""
        return [key for host, key in self._lines if host == _host(address)]

    def check(self, address: Address, key: HostKey, accepted: str | None = None) -> bool:
        """Whether the key is new to this project; it is pinned then.

        :param accepted: the fingerprint of a changed key that the user accepts
        :raises HostKeyError: when others are pinned for the address, and it is none of them
        """
        known = self.known(address)
        if key in known:
            return False
        new = all(key != other for _, other in self._lines)
        # Each robot answers at this address, and nobody is between the two ends of a cable.
        expected = self._of_many_teams and address.host == USB_CABLE
        if known and new and accepted != key.fingerprint and not expected:
            raise HostKeyError(
                f"the robot's key has changed: it is {key.fingerprint} ({key.kind}), "
                f"and was {', '.join(old.fingerprint for old in known)}",
                where=str(address),
                remedy="That is so when the robot was reimaged, or it is another robot of yours; else somebody is "
                f"between you and it. If it is yours, run the command again with: --accept-host-key {key.fingerprint}",
            )
        self._pin(address, key)
        return new

    def _pin(self, address: Address, key: HostKey) -> None:
        # Read anew: another deploy of this project may have pinned a key meanwhile.
        self._lines = [*_lines_of(self._file), (_host(address), key)]
        write_whole(
            self._file,
            (f"{host} {each.kind} {base64.b64encode(each.blob).decode()}\n" for host, each in self._lines),
        )
        ignore = self._file.with_name(".gitignore")
        if not ignore.exists():
            write_whole(ignore, ["*\n"])


def _host(address: Address) -> str:
    return address.host if address.port == 22 else f"[{address.host}]:{address.port}"


def _lines_of(file: Path) -> list[tuple[str, HostKey]]:
    if not file.is_file():
        return []
    lines = []
    for number, line in enumerate(file.read_text("utf-8", errors="replace").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        try:
            host, kind, blob = line.split()[:3]
            lines.append((host, HostKey(kind, base64.b64decode(blob, validate=True))))
        except ValueError:
            raise HostKeyError(
                "this line is no host key",
                where=f"{file.as_posix()}:{number}",
                remedy="Remove the line, or the file: the robot's key is then pinned anew.",
            ) from None
    return lines
