"""The host keys of robots: pinned when first seen, compared ever after.

A key is pinned for the robot's team: for all addresses that a robot of the team may have, together. Any other key is
refused at each of them, until the user accepts it. A robot at an address of its own (``--robot HOST:PORT``) is pinned
for that address alone.

Kept in ``.pyfrc/known_hosts``, in OpenSSH's format, for one person and one checkout: not committed. Outside of any
project, it is ``~/.pyfrc/known_hosts``. Written and read here rather than with `paramiko.HostKeys`, which keeps one
key of a kind for an address: a team's robots (this year's, the one for practice) have the same addresses and different
keys.
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
from ..text_files import write_whole
from .discovery import USB_CABLE, Address, addresses_of, team_of
from .errors import HostKeyError, KeyFileError

KNOWN_HOSTS = Path(".pyfrc", "known_hosts")

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,39}")
#: A host for which a key can be pinned here: no pattern, no negation, no hash.
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

    :param hosts: for which it is pinned, as OpenSSH writes them
    :param name:  that the user has given to the robot; empty: none
    """

    hosts: tuple[str, ...]
    key: HostKey
    name: str = ""

    @property
    def teams(self) -> set[int]:
        """The teams whose addresses are among its hosts."""
        return {team for host in self.hosts if (team := team_of(Address(host))) is not None}

    def is_for(self, host: str) -> bool:
        """Return whether it is pinned for this host. Capital letters make no difference, as everywhere in names."""
        return host.lower() in map(str.lower, self.hosts)

    @property
    def is_of_cable_only(self) -> bool:
        """Whether nothing is known of its robot but that it was at the other end of a USB cable."""
        return self.hosts == (USB_CABLE,)

    def __str__(self) -> str:
        return f"{self.key.fingerprint} ({self.name})" if self.name else self.key.fingerprint


@dataclass(frozen=True)
class Recognized:
    """What is known of a key that was accepted.

    :param new_for: for what it was pinned just now, such as ``team 1234``; none: it was known
    :param name:    the robot's; empty: none
    """

    new_for: str | None
    name: str


class HostKeys:
    """The pinned keys of a project, or of a user outside of projects.

    :param directory: the project's
    :raises HostKeyError: when the file cannot be trusted or read: it is a link, or a line of it holds no key
    """

    def __init__(self, directory: Path, *, of_user: bool = False) -> None:
        self.file = directory / KNOWN_HOSTS
        self.of_user = of_user
        self.entries()

    @classmethod
    def of_this_user(cls) -> HostKeys:
        """The keys that this user has met outside of projects: of robots of many teams."""
        return cls(Path.home(), of_user=True)

    def of_robot(self, address: Address, team: int | None = None, project_team: int | None = None) -> RobotKeys:
        """The keys that a robot may have.

        :param address: where it is
        :param team: whose robot is looked for there; none: the address says it, or it is a robot by itself
        :param project_team: the project's team, for a robot that was named by its address
        """
        team = team_of(address) if team is None else team
        if team is None and _host(address) == USB_CABLE:
            team = project_team
        return RobotKeys(self, address, team, project_team)

    def entries(self) -> list[KnownKey]:
        """All pinned keys, as the file has them now."""
        return [known for _, known in self._lines() if known is not None]

    def write(self, entries: Iterable[KnownKey], forget: Iterable[KnownKey] = ()) -> None:
        """Add these keys, instead of those to forget; all other lines stay as they are."""
        gone = set(forget)
        kept = [line for line, known in self._lines() if known not in gone]
        with self._accessing("write"):
            write_whole(self.file, (f"{line}\n" for line in [*kept, *map(_line_of, entries)]))
            ignore = self.file.with_name(".gitignore")
            if not ignore.exists():
                write_whole(ignore, ["*\n"])

    @contextmanager
    def _accessing(self, how: str) -> Iterator[None]:
        """Raise an error about the file, since its caller takes other errors of the system for the link's.

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
                remedy=f"Nothing was changed on the robot. Make sure that you may {how} {of_what} and .pyfrc in it "
                "(a directory), and run the command again.",
            ) from error

    def _refuse_links(self) -> None:
        """Who can make a link in a project must not choose which file is read as keys, or is overwritten."""
        for path in (self.file.parent, self.file, self.file.with_name(".gitignore")):
            if path.is_symlink() or _is_junction(path):
                raise HostKeyError(
                    "this is a link, and the keys of robots are not kept behind links",
                    where=path,
                    remedy="Remove the link, and run the command again: the robot's key is then pinned again.",
                )

    def _lines(self) -> list[tuple[str, KnownKey | None]]:
        with self._accessing("read"):
            self._refuse_links()
            if self.file.is_dir():
                raise HostKeyError(
                    "this is a directory, and should be the file with the keys of robots",
                    where=self.file,
                    remedy="Remove it, and run the command again.",
                )
            if not self.file.is_file():
                return []
            # Editors on Windows put a byte-order mark before the first line, which would make its host another one.
            text = self.file.read_text("utf-8-sig", errors="replace")
        return [(line, _known_in(line, self.file, number)) for number, line in enumerate(text.splitlines(), 1)]


class RobotKeys:
    """The keys that a robot may have: its team's, or those of its address."""

    def __init__(self, keys: HostKeys, address: Address, team: int | None, project_team: int | None = None) -> None:
        self._keys = keys
        self._host = _host(address)
        self._team = team
        self._expected_team = project_team if team is None else team
        self._at_cable = self._host == USB_CABLE

    def known(self) -> list[KnownKey]:
        """The keys pinned for it."""
        return [known for known in self._keys.entries() if self._counts(known)]

    def check(self, key: HostKey, accepted: str | None = None, name: str | None = None, pin: bool = True) -> Recognized:
        """Compare a key with those that are pinned; the first one is pinned now.

        :param accepted: the fingerprint of another key that the user accepts
        :param name: to be given to the robot; another robot with this name is forgotten
        :param pin: whether to keep what is new; otherwise, nothing is written
        :raises HostKeyError: when other keys are pinned, and it is none of them
        :raises UsageError: when the name is none
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
        # By older versions, keys were pinned for single addresses.
        if known.is_of_cable_only:
            return not self._keys.of_user or self._is_any_robots()
        return known.is_for(self._host)

    def _is_any_robots(self) -> bool:
        """Whether robots of all teams are expected here: at the user's own USB cable, outside of projects."""
        return self._keys.of_user and self._at_cable and not self._team_is_pinned()

    def _is_other_teams(self, key: HostKey) -> bool:
        teams = {team for each in self._keys.entries() if each.key == key for team in each.teams}
        return self._expected_team is not None and bool(teams) and self._expected_team not in teams

    def _team_is_pinned(self) -> bool:
        return self._team is not None and any(self._team in each.teams for each in self._keys.entries())

    def _hosts(self) -> tuple[str, ...]:
        if self._team is None or self._is_any_robots():
            return (self._host,)
        hosts = (address.host for address, _ in addresses_of(self._team))
        # Each team's robot is at the user's USB cable now and then.
        return tuple(host for host in hosts if not (self._keys.of_user and host == USB_CABLE))

    def _what(self) -> str:
        if self._is_any_robots():
            return "the USB cable"
        return self._host if self._team is None else f"team {self._team}"

    def _refusal(self, key: HostKey, known: list[KnownKey]) -> HostKeyError:
        pinned = ", ".join(map(str, known)) or "none"
        elsewhere = [f"; this key is pinned for {each.hosts[0]}" for each in self._keys.entries() if each.key == key]
        return HostKeyError(
            f"the robot's key has changed, or this is another robot: its key is {key.fingerprint} ({key.kind}); "
            f"pinned for {self._what()}: {pinned}{''.join(elsewhere)}",
            where=self._host,
            remedy="That is so when the robot was imaged, or is a second one of yours (which --robot-name NAME gives a "
            "name); otherwise it is another computer that pretends to be your robot. If it is yours, run the command "
            f"again with: --accept-host-key {key.fingerprint}",
        )


def _is_junction(path: Path) -> bool:
    """Whether it is Windows' other kind of link to a directory."""
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
            raise ValueError("a pattern, a hash or a marker: to skip it would make the pinned key void")
        key = HostKey(kind, base64.b64decode(blob, validate=True))
    except (ValueError, binascii.Error):
        raise HostKeyError(
            "this line is no host key",
            where=f"{file.as_posix()}:{number}",
            remedy="Remove the line, or the file: the robot's key is then pinned again.",
        ) from None
    name = comment[0] if comment and _NAME.fullmatch(comment[0]) else ""
    return KnownKey(tuple(hosts.split(",")), key, name)
