"""The host keys of robots: pinned at the first connection, compared at all later ones.

A key is pinned for the robot's team: for all addresses that a robot of the team may have, together. Any other key is
refused at each of them, until the user accepts it. A robot at an address of its own (``--robot HOST:PORT``) is pinned
for that address alone.

The file is ``.pyfrc/known_hosts`` in the project, in OpenSSH's format, and is not committed. Outside of a project, it
is ``~/.pyfrc/known_hosts``. `paramiko.HostKeys` is not used because it keeps only one key of each kind for an address:
a team's robots (competition, practice) have the same addresses and different keys.
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import UsageError
from ..text_files import keep_out_of_version_control, write_whole
from .discovery import Address, addresses_of
from .errors import HostKeyError, KeyFileError
from .targets import ControllerKind, is_shared_host, team_of_host

KNOWN_HOSTS = Path(".pyfrc", "known_hosts")

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,39}")
#: A host for which a key can be pinned: not a pattern, a negation or a hash.
_HOST = re.compile(r"[\w.:%-]+|\[[\w.:%-]+\]:[0-9]{1,5}")


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


@dataclass(frozen=True)
class KnownKey:
    """A pinned key.

    :param hosts: the hosts for which it is pinned, in OpenSSH's format
    :param name:  the robot's name; empty if it has none
    """

    hosts: tuple[str, ...]
    key: HostKey
    name: str = ""

    @property
    def teams(self) -> set[int]:
        """Return the teams whose addresses are among its hosts."""
        return {team for host in self.hosts if (team := team_of_host(host)) is not None}

    def is_for(self, host: str) -> bool:
        """Return whether it is pinned for this host. Upper and lower case are the same."""
        return host.lower() in map(str.lower, self.hosts)

    @property
    def is_of_cable_only(self) -> bool:
        """Return whether it is pinned only for an address that all robots have, so that its team is unknown."""
        return len(self.hosts) == 1 and is_shared_host(self.hosts[0])

    def __str__(self) -> str:
        return f"{self.key.fingerprint} ({self.name})" if self.name else self.key.fingerprint


@dataclass(frozen=True)
class Recognized:
    """The result of a successful key check.

    :param new_for: for whom the key was pinned now, such as ``team 1234``; None if it was known
    :param name:    the robot's name; empty if it has none
    """

    new_for: str | None
    name: str


class HostKeys:
    """The pinned keys of a project, or of a user outside of projects.

    :param directory: the project's directory
    :param of_user:   whether these are a user's keys
    :raises HostKeyError: if the file is a link or has an invalid line
    """

    def __init__(self, directory: Path, *, of_user: bool = False) -> None:
        self.file = directory / KNOWN_HOSTS
        self.of_user = of_user
        self.entries()

    @classmethod
    def of_this_user(cls) -> HostKeys:
        """Return the user's keys, which are used outside of projects and belong to robots of several teams."""
        return cls(Path.home(), of_user=True)

    def of_robot(
        self, address: Address, controller: ControllerKind, team: int | None = None, project_team: int | None = None
    ) -> RobotKeys:
        """Return the known keys of a robot.

        :param address: its address
        :param controller: its controller
        :param team: its team; default: the team of the address, if any
        :param project_team: the project's team, for a robot that the user named by its address
        """
        if team is None and address.port == 22:
            team = team_of_host(address.host)
        if team is None and is_shared_host(_host(address)):
            team = project_team
        return RobotKeys(self, address, controller, team, project_team)

    def entries(self) -> list[KnownKey]:
        """Return all pinned keys that are now in the file."""
        return [known for _, known in self._lines() if known is not None]

    def write(self, entries: Iterable[KnownKey], forget: Iterable[KnownKey] = ()) -> None:
        """Add keys, and remove the keys to forget. All other lines stay unchanged."""
        gone = set(forget)
        kept = [line for line, known in self._lines() if known not in gone]
        with self._accessing("write"):
            write_whole(self.file, (f"{line}\n" for line in [*kept, *map(_line_of, entries)]))
            keep_out_of_version_control(self.file.parent)

    @contextmanager
    def _accessing(self, how: str) -> Iterator[None]:
        """Convert an `OSError` to an error about the file. The caller treats other `OSError` as a lost connection.

        :param how: ``read`` or ``write``
        """
        try:
            yield
        except OSError as error:
            where = Path(error.filename) if error.filename else self.file
            of_what = "your home directory" if self.of_user else "the project's directory"
            raise KeyFileError(
                f"cannot {how} the file with the keys of robots: {(error.strerror or str(error)).lower()}",
                where=where,
                remedy=f"Nothing was changed on the robot. Make sure that you can {how} {of_what} and the directory "
                ".pyfrc in it, and run the command again.",
            ) from error

    def _refuse_links(self) -> None:
        """Refuse links, which could make pyfrc read keys from another file or overwrite it."""
        for path in (self.file.parent, self.file, self.file.with_name(".gitignore")):
            if path.is_symlink() or _is_junction(path):
                raise HostKeyError(
                    "this is a link, and keys of robots are not read through links",
                    where=path,
                    remedy="Remove the link, and run the command again: the robot's key is then pinned again.",
                )

    def _lines(self) -> list[tuple[str, KnownKey | None]]:
        with self._accessing("read"):
            self._refuse_links()
            if self.file.is_dir():
                raise HostKeyError(
                    "this is a directory instead of the file with the keys of robots",
                    where=self.file,
                    remedy="Remove it, and run the command again.",
                )
            if not self.file.is_file():
                return []
            # Editors on Windows may write a byte-order mark, which would become part of the first host.
            text = self.file.read_text("utf-8-sig", errors="replace")
        return [(line, _known_in(line, self.file, number)) for number, line in enumerate(text.splitlines(), 1)]


class RobotKeys:
    """The known keys of a robot: those of its team, or those of its address."""

    def __init__(
        self, keys: HostKeys, address: Address, controller: ControllerKind, team: int | None, project_team: int | None
    ) -> None:
        self._keys = keys
        self._controller = controller
        self._host = _host(address)
        self._team = team
        self._expected_team = project_team if team is None else team
        self._at_cable = is_shared_host(self._host)

    def known(self) -> list[KnownKey]:
        """Return the pinned keys."""
        return [known for known in self._keys.entries() if self._counts(known)]

    def check(self, key: HostKey, accepted: str | None = None, name: str | None = None, pin: bool = True) -> Recognized:
        """Check the robot's key. The first key of a robot is accepted and pinned.

        :param accepted: the fingerprint of a new key that the user accepts
        :param name: a name for the robot; the key of another robot with this name is removed
        :param pin: whether to write new keys and names to the file
        :raises HostKeyError: if other keys are pinned
        :raises UsageError: if the name is invalid
        """
        if name is not None and not _NAME.fullmatch(name):
            raise UsageError(
                f"--robot-name {name!r}: a name has letters, digits, '-', '_' and '.', 40 at most",
                remedy="As in: --robot-name practice",
            )
        known = self.known()
        match = next((each for each in known if each.key == key), None)
        expected = self._is_any_robots() or not known
        if match is None and accepted != key.fingerprint and (accepted or not expected or self._is_other_teams(key)):
            raise self._refusal(key, known)
        entry = match or KnownKey(self._hosts(), key)
        if name is not None and name != entry.name:
            entry = replace(entry, name=name)
        if entry != match and pin:
            forgotten = [each for each in known if entry.name and each.name == entry.name and each.key != key]
            self._keys.write([entry], forgotten if match is None else [*forgotten, match])
        return Recognized(None if match else self._what(), entry.name)

    def _counts(self, known: KnownKey) -> bool:
        if self._team is None:
            return self._is_any_robots() or known.is_for(self._host)
        if known.teams:
            return self._team in known.teams
        # At the cable, a robot may have been seen before the team was known.
        return known.is_of_cable_only and (not self._keys.of_user or self._is_any_robots())

    def _is_any_robots(self) -> bool:
        """Return whether robots of all teams are expected: at an address that all have, outside of projects."""
        return self._keys.of_user and self._at_cable and not self._team_is_pinned()

    def _is_other_teams(self, key: HostKey) -> bool:
        teams = {team for each in self._keys.entries() if each.key == key for team in each.teams}
        return self._expected_team is not None and bool(teams) and self._expected_team not in teams

    def _team_is_pinned(self) -> bool:
        return self._team is not None and any(self._team in each.teams for each in self._keys.entries())

    def _hosts(self) -> tuple[str, ...]:
        if self._team is None or self._is_any_robots():
            return (self._host,)
        hosts = (address.host for address, _ in addresses_of(self._team, self._controller))
        # Robots of several teams may be connected to the user's USB cable.
        return tuple(host for host in hosts if not (self._keys.of_user and is_shared_host(host)))

    def _what(self) -> str:
        if self._is_any_robots():
            return f"the {dict(self._controller.addresses(1)).get(self._host, 'address')}"
        return self._host if self._team is None else f"team {self._team}"

    def _refusal(self, key: HostKey, known: list[KnownKey]) -> HostKeyError:
        pinned = ", ".join(map(str, known)) or "none"
        elsewhere = [f"; this key is pinned for {each.hosts[0]}" for each in self._keys.entries() if each.key == key]
        return HostKeyError(
            f"the robot's key has changed, or this is another robot: its key is {key.fingerprint} ({key.kind}); "
            f"pinned for {self._what()}: {pinned}{''.join(elsewhere)}",
            where=self._host,
            remedy="The key changes when the robot is imaged, and a second robot has another key (--robot-name NAME "
            "gives it a name). Otherwise, another computer imitates your robot. If the robot is yours, run the command "
            f"again with: --accept-host-key {key.fingerprint}",
        )


def _is_junction(path: Path) -> bool:
    """Return whether it is a junction, which is a directory link on Windows."""
    tag = getattr(os.lstat(path), "st_reparse_tag", 0) if path.exists() else 0
    return tag == 0xA0000003


def _host(address: Address) -> str:
    return address.host if address.port == 22 else f"[{address.host}]:{address.port}"


def _line_of(known: KnownKey) -> str:
    blob = base64.b64encode(known.key.blob).decode()
    return " ".join(filter(None, (",".join(known.hosts), known.key.kind, blob, known.name)))


def _known_in(line: str, file: Path, number: int) -> KnownKey | None:
    if not line.strip() or line.startswith("#"):
        return None
    try:
        hosts, kind, blob, *comment = line.split()
        if not all(map(_HOST.fullmatch, hosts.split(","))):
            raise ValueError("a pattern, a hash or a marker, which must not be ignored")
        key = HostKey(kind, base64.b64decode(blob, validate=True))
    except (ValueError, binascii.Error):
        raise HostKeyError(
            "this line is not a host key",
            where=f"{file.as_posix()}:{number}",
            remedy="Remove the line, or the file: the robot's key is then pinned again.",
        ) from None
    name = comment[0] if comment and _NAME.fullmatch(comment[0]) else ""
    return KnownKey(tuple(hosts.split(",")), key, name)
