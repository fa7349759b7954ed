"""Structs, as robots publish and log them, unfold into named parts by their schemas; others are shown as they are."""

from __future__ import annotations

import struct

from loops import for_each

from pyfrc_core.sim.engine.structs import Structs

SCHEMAS = {
    "Translation2d": "double x;double y",
    "Rotation2d": "double value",
    "Pose2d": "Translation2d translation;Rotation2d rotation",
    "Mixed": "char name[6]; bool on; int16 counts[3]; enum {low=0, high=1} uint8 level; Rotation2d angles[2];",
    "Bits": "int8 a:4; uint8 b:3; bool c:1; uint16 d:9; bool e:1; uint16 f:7; int8 g",
    "Itself": "Itself again",
    "Both": "Other other",
    "Other": "Both both[9]",
    "Huge": "double many[999999]",
    "Wide": "Rotation2d many[999999]",
    "Damaged": "double x;;dou ble y:",
    "Strange": "quaternion q",
    "Empty": "",
    "NoBits": "double x:4",
}


def parts(type_name: str, data: bytes) -> dict[str, object]:
    return Structs(lambda kind: SCHEMAS.get(kind, "")).parts("/at", type_name, data)


def test_a_struct_unfolds_into_its_parts() -> None:
    data = struct.pack("<3d", 1, 2, 0.5)
    assert parts("struct:Pose2d", data) == {"/at/translation/x": 1, "/at/translation/y": 2, "/at/rotation/value": 0.5}
    assert parts("struct:Pose2d[]", 2 * data).keys() == {
        f"/at/{index}/{part}" for index in (0, 1) for part in ("translation/x", "translation/y", "rotation/value")
    }
    assert parts("struct:Pose2d[]", b"") == {"/at": []}


def test_every_kind_of_field_is_read() -> None:
    data = struct.pack("<6s?3hB2d", b"left\0\0", True, 1, -2, 3, 1, 0.25, -0.25)
    assert parts("struct:Mixed", data) == {
        "/at/name": "left", "/at/on": True, "/at/counts": [1, -2, 3], "/at/level": 1,
        "/at/angles/0/value": 0.25, "/at/angles/1/value": -0.25,
    }  # fmt: skip
    # Bit fields share bytes, from the lowest bit on, if their types are as long; d does not fit behind a, b, c.
    data = struct.pack("<BHHb", 0b1_101_1110, 0b1_100000001, 0b1000001, -7)
    assert parts("struct:Bits", data) == {
        "/at/a": -2, "/at/b": 5, "/at/c": True, "/at/d": 257, "/at/e": True, "/at/f": 65, "/at/g": -7,
    }  # fmt: skip


@for_each(
    "type_name, size",
    [
        *(("struct:Pose2d", 23), ("struct:Pose2d", 48), ("struct:Pose2d[]", 25), ("struct:Rotation2d[]", 8 * 9999)),
        *(
            (f"struct:{name}", 8)
            for name in ("Unknown", "Itself", "Both", "Huge", "Wide", "Damaged", "Strange", "Empty", "NoBits")
        ),
    ],
)
def test_what_does_not_fit_is_shown_as_it_is(type_name: str, size: int) -> None:
    assert parts(type_name, bytes(size)) == {
        "/at": {"$": "struct", "type": type_name.removeprefix("struct:"), "size": size}
    }


def test_other_data_has_a_size_only() -> None:
    assert parts("proto:Pose2d", b"abc") == {"/at": {"$": "bytes", "size": 3}}


def test_a_schema_may_come_after_the_first_value() -> None:
    schemas: dict[str, str] = {}
    structs = Structs(lambda kind: schemas.get(kind, ""))
    data = struct.pack("<d", 1)
    assert structs.parts("/at", "struct:Rotation2d", data).keys() == {"/at"}
    schemas |= SCHEMAS
    assert structs.parts("/at", "struct:Rotation2d", data) == {"/at/value": 1}
