"""The user's own SSH keys, which are offered to a robot only if the user requests this.

An unknown computer at a robot's address could identify the user by these keys, and an SSH agent's keys give access to
more than robots.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import RefusedError

if TYPE_CHECKING:
    import paramiko

#: SSH servers usually disconnect after more keys.
_MAX_KEYS = 5


@dataclass(frozen=True)
class Credentials:
    """The keys to offer.

    :param identity: a file with a private key without a passphrase
    :param ssh_agent: whether to offer the keys of the SSH agent
    """

    identity: Path | None = None
    ssh_agent: bool = False

    def load(self) -> Iterator[paramiko.PKey]:
        """Yield the keys to offer, the identity first.

        :raises RefusedError: if the file has no readable key
        """
        if self.identity is not None:
            yield _key_in(self.identity)
        if self.ssh_agent:
            import paramiko

            agent = paramiko.Agent()
            try:
                yield from agent.get_keys()[:_MAX_KEYS]
            finally:
                agent.close()

    def offered(self, count: int) -> str:
        """Return a description of the offered keys, for an error message."""
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
    except (paramiko.PasswordRequiredException, TypeError):  # cryptography raises TypeError for this
        raise RefusedError(
            "this key has a passphrase",
            where=file,
            remedy="Add it to your SSH agent: ssh-add FILE, and use --ssh-agent.",
        ) from None
    except OSError as error:
        raise RefusedError(f"this key cannot be read: {error.strerror or error}", where=file) from None
    except Exception as error:  # invalid content causes many kinds of errors
        raise RefusedError(
            f"this is not a private key: {error}", where=file, remedy="Use the file without .pub at its end."
        ) from None
