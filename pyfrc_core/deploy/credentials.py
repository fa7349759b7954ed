"""The user's own SSH keys: offered to a robot only when the user asks for it.

A stranger's computer at a robot's address learns from an offer who the user is; and the keys of an agent open more than
robots.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import RefusedError

if TYPE_CHECKING:
    import paramiko

#: An SSH server gives up after about so many keys.
_MOST_KEYS = 5


@dataclass(frozen=True)
class Credentials:
    """Which keys may be offered.

    :param identity: a file with a private key that has no passphrase
    :param ssh_agent: those of the SSH agent
    """

    identity: Path | None = None
    ssh_agent: bool = False

    def load(self) -> Iterator[paramiko.PKey]:
        """Load the keys to offer, the identity first.

        :raises RefusedError: when the file holds no key that can be read
        """
        if self.identity is not None:
            yield _key_in(self.identity)
        if self.ssh_agent:
            import paramiko

            agent = paramiko.Agent()
            try:
                yield from agent.get_keys()[:_MOST_KEYS]
            finally:
                agent.close()

    def offered(self, count: int) -> str:
        """Say what was offered."""
        if count == 0:
            return "there is none in your SSH agent" if self.ssh_agent else "none was offered"
        sources = [str(self.identity)] if self.identity is not None else []
        if of_agent := count - len(sources):
            sources.append(f"{of_agent} of your SSH agent's keys")
        return " and ".join(sources)


NONE_OFFERED = Credentials()


def _key_in(file: Path) -> paramiko.PKey:
    import paramiko

    try:
        return paramiko.PKey.from_path(file)
    except (paramiko.PasswordRequiredException, TypeError):  # the latter is cryptography's for the same
        raise RefusedError(
            "this key has a passphrase",
            where=file,
            remedy="Add it to your SSH agent: ssh-add FILE, and use --ssh-agent.",
        ) from None
    except OSError as error:
        raise RefusedError(f"this key cannot be read: {error.strerror or error}", where=file) from None
    except Exception as error:  # what a file may hold that is no key fails in many ways
        raise RefusedError(
            f"this is no private key: {error}", where=file, remedy="Name the file without .pub at its end."
        ) from None
