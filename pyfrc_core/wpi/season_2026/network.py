"""NetworkTables."""

from __future__ import annotations

from ...compat.private_name import PrivateName

NETWORK_LOG = PrivateName(
    "ntcore._logutil:NtLogForwarder.onInstanceStart",
    "NetworkTables calls it when it starts: fuzz.preparation replaces it, since no one reads what matches log",
)
