"""Why no robot is found: a connection is tried to each address once, while the client of NetworkTables goes on."""

from __future__ import annotations

import socket
import threading
from collections import defaultdict
from collections.abc import Sequence
from functools import partial

Server = tuple[str, int]
#: How long to wait for names and connections, in seconds.
_SECONDS = 4.0


def reasons(servers: Sequence[Server]) -> str:
    """Return what each address does instead of serving NetworkTables, as one sentence."""
    found = dict.fromkeys(servers, f"no response within {_SECONDS:g} s")
    threads = [threading.Thread(target=partial(_try, server, found), daemon=True) for server in servers]
    for thread in threads:
        thread.start()
    for thread in threads:  # all began at the same time; those whose names take longer are left alone
        thread.join(_SECONDS + 1)
    together = defaultdict(list)
    for (host, port), why in dict(found).items():
        together[why].append(f"{host}:{port}")
    return "; ".join(f"{', '.join(shown)}: {why}" for why, shown in together.items())


def _try(server: Server, found: dict[Server, str]) -> None:
    try:
        with socket.create_connection(server, _SECONDS):
            found[server] = "a program responds, but not with NetworkTables"
    except (socket.gaierror, UnicodeError):
        found[server] = "the name is not known here"
    except TimeoutError:
        pass
    except ConnectionRefusedError:
        found[server] = "a computer is there, but no robot program runs on it"
    except OSError as error:
        found[server] = (error.strerror or str(error)).lower()
