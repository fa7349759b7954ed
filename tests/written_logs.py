"""Data logs that tests write, byte by byte: also such as WPILib's own writer does not write."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

SECOND = 1_000_000
#: When the robot's clock begins these logs, in microseconds.
BOOT = 12 * SECOND


class Written:
    """A data log, as bytes.

    :param header: what its program writes about itself
    :param metadata: of each entry
    """

    def __init__(self, header: str = "", metadata: str = "") -> None:
        self.data = bytearray(b"WPILOG\x00\x01") + struct.pack("<I", len(header)) + header.encode()
        self._metadata = metadata
        self._entries = 0

    def record(self, entry: int, payload: bytes, moment: int) -> None:
        head = bytes([3 | 3 << 2 | 7 << 4])
        self.data += head + struct.pack("<IIQ", entry, len(payload), moment) + payload

    def start(self, name: str, type_name: str, moment: int = 0) -> int:
        self._entries += 1
        texts = b"".join(struct.pack("<I", len(text)) + text.encode() for text in (name, type_name, self._metadata))
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


def a_kit_log(prefix: str = "", begin: float = 0.0) -> Written:
    """Return a log of 5 s, as PyKit 1.0.5 writes it: only what has changed since the turn of the loop before.

    :param prefix: how names begin: ``NT:/AdvantageKit`` where WPILib has logged what PyKit publishes
    :param begin: the robot's clock at the beginning, in seconds: that of a simulation begins at 0
    """
    log = Written("", "") if prefix else Written("PyKit", '{"source": "PyKit"}')

    def values(name: str, type_name: str, code: str, *changes: tuple[float, Any]) -> None:
        shifted = ((time + begin - BOOT / SECOND, value) for time, value in changes)
        log.values(prefix + name, type_name, code, *shifted)

    values("/Timestamp", "int64", "q", *((turn / 50, turn * 20_000) for turn in range(1, 250)))
    values("/RealMetadata/Git Hash", "string", "", (0.02, b"abc123"))
    values("/NetworkInputs/SmartDashboard/Auto", "string", "", (0.02, b"Slow"), (0.3, b"Fast"))
    values("/NetworkInputs/Tuning/gain", "double", "d", (0.02, 1.0), (3.4, 0.5))
    values("/NetworkInputs/Tuning/offset", "double", "d", (0.02, 0.25))
    values("/DriverStation/AllianceStation", "int64", "q", (0.02, 1), (0.2, 5))
    values("/DriverStation/EventName", "string", "", (0.02, b"OHCL"))
    values("/DriverStation/GameSpecificMessage", "string", "", (0.02, b""), (0.2, b"R"))
    values("/DriverStation/MatchNumber", "int64", "q", (0.02, 12))
    values("/DriverStation/MatchType", "int64", "q", (0.02, 2))
    values("/DriverStation/MatchTime", "double", "d", (0.02, -1.0), (1.0, 20.0), (2.0, 19.0))
    enabled = [(0.02, False), (1.0, True), (2.0, False), (2.5, True), (4.5, False)]
    values("/DriverStation/Enabled", "boolean", "?", *enabled)
    values("/DriverStation/Autonomous", "boolean", "?", (0.02, False), (0.5, True), (2.0, False))
    values("/DriverStation/Test", "boolean", "?", (0.02, False))
    values("/DriverStation/EmergencyStop", "boolean", "?", (0.02, False))
    values("/DriverStation/FMSAttached", "boolean", "?", (0.02, False), (0.2, True))
    values("/DriverStation/DSAttached", "boolean", "?", (0.02, True))
    for stick in range(6):
        table = f"/DriverStation/Joystick{stick}"
        buttons = [(2.6, 0b10), (3.0, 0)] if stick == 0 else []
        values(f"{table}/ButtonCount", "int64", "q", (0.02, 12 if stick < 2 else 0))
        values(f"{table}/ButtonValues", "int64", "q", (0.02, 0), *buttons)
        axes = [(0.02, (0.0, 0.0)), *([(3.2, (0.0, -0.5))] if stick == 0 else [])] if stick < 2 else [(0.02, ())]
        packed = [(time, struct.pack(f"<{len(each)}d", *each)) for time, each in axes]
        values(f"{table}/AxisValues", "double[]", "", *packed)
        values(f"{table}/POVs", "int64[]", "", (0.02, struct.pack("<q", -1) if stick < 2 else b""))
    values("/SystemStats/BrownedOut", "int64", "q", (0.02, 0), (4.0, 1), (4.2, 0))
    values("/Arm/positionRad", "double", "d", (0.02, 0.0), (2.62, 0.125))
    values("/Drive/Gyro/yaw", "double", "d", (0.02, 0.0))
    values("/RealOutputs/Logger/EntryUpdateMS", "double", "d", (0.02, 0.25), (0.04, 0.5))
    values("/RealOutputs/Console", "string", "", (1.0, b"auto begins with Fast"))
    for name, schema in (
        ("Rotation2d", b"double value"),
        ("Translation2d", b"double x;double y"),
        ("Pose2d", b"Translation2d translation;Rotation2d rotation"),
    ):
        values(f"/.schema/struct:{name}", "structschema", "", (0.02, schema))
    places = [(0.02, 1.0), (1.0, 1.8), (2.0, 1.0), (3.2, 1.5), (3.4, 1.25), (4.5, 1.0)]
    packed = [(time, struct.pack("<3d", x, 2.0, 0.0)) for time, x in places]
    values("/RealOutputs/Odometry/Robot", "struct:Pose2d", "", *packed)
    values("/RealOutputs/Arm/Setpoint", "double", "d", (0.02, 0.0), (2.6, 0.3), (3.0, 0.0))
    return log
