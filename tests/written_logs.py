"""Data logs that tests write, byte by byte: also such as WPILib's own writer does not write."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

SECOND = 1_000_000
#: When the robot's clock begins these logs, in microseconds.
BOOT = 12 * SECOND


class Written:
    """A data log, as bytes."""

    def __init__(self) -> None:
        self.data = b"WPILOG\x00\x01\x00\x00\x00\x00"
        self._entries = 0

    def record(self, entry: int, payload: bytes, moment: int) -> None:
        head = bytes([3 | 3 << 2 | 7 << 4])
        self.data += head + struct.pack("<IIQ", entry, len(payload), moment) + payload

    def start(self, name: str, type_name: str, moment: int = 0) -> int:
        self._entries += 1
        texts = b"".join(struct.pack("<I", len(text)) + text.encode() for text in (name, type_name, ""))
        self.record(0, b"\x00" + struct.pack("<I", self._entries) + texts, moment)
        return self._entries

    def values(self, name: str, type_name: str, code: str, *changes: tuple[float, Any]) -> None:
        entry = self.start(name, type_name)
        for time, value in changes:
            payload = value if isinstance(value, bytes) else struct.pack(f"<{code}", value)
            self.record(entry, payload, BOOT + round(time * SECOND))

    def save(self, file: Path) -> Path:
        file.write_bytes(self.data)
        return file


def a_match() -> Written:
    """Return a log of 20 s with autonomous from 2 s and teleop from 10 s on."""
    log = Written()
    log.values("DS:enabled", "boolean", "?", (0, False), (2, True), (8, False), (10, True), (18, False))
    log.values("DS:autonomous", "boolean", "?", (0, False), (1, True), (9, False))
    log.values("NT:/SmartDashboard/speed", "double", "d", *((step / 10, step / 7) for step in range(200)))
    log.values("messages", "string", "", (3, b"hello"), (4, b"ValueError: it broke"))
    return log
