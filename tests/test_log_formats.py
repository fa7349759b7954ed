"""Data logs in other forms: the same values as in a ``.wpilog``, and a sentence for what is cut or damaged."""

from __future__ import annotations

import lzma
import math
import struct
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from written_logs import a_kit_log, a_match

from pyfrc_core.errors import PyfrcError
from pyfrc_core.log_records import Record, read_data_log
from pyfrc_core.runtime.scripts.inputs_file import is_data_log, load_inputs
from pyfrc_core.sim.logs import open_log

HEIGHT = 26.0


class WrittenRlog:
    """A log of AdvantageKit, as bytes."""

    def __init__(self, revision: int) -> None:
        self.data, self._revision, self._keys = bytes([revision]), revision, 0

    def time(self, seconds: float) -> None:
        self.data += b"\0" + struct.pack(">d", seconds)

    def key(self, name: str, type_name: str) -> int:
        texts = [name, type_name][: self._revision]
        self.data += b"\1" + struct.pack(">H", self._keys) + b"".join(self.text(each.encode()) for each in texts)
        self._keys += 1
        return self._keys - 1

    def value(self, key: int, head: bytes, payload: bytes) -> None:
        """Write a value after its type in revision 1, or its length in revision 2."""
        self.data += b"\2" + struct.pack(">H", key) + head + payload

    @staticmethod
    def text(text: bytes) -> bytes:
        return struct.pack(">H", len(text)) + text


def of_revision_2(log: Any, file: Path) -> Path:
    """Write a data log as AdvantageKit would: big-endian, but for structs."""
    rlog, keys = WrittenRlog(2), {}
    source = read_data_log(log.save(file.with_suffix(".wpilog")))
    for record in source.records(lambda entry: True):
        rlog.time(record.at_us / 1_000_000)
        if record.name == "/Timestamp":
            continue
        if record.name not in keys:
            keys[record.name] = rlog.key(record.name, record.type_name)
        payload = big_endian(record)
        rlog.value(keys[record.name], struct.pack(">H", len(payload)), payload)
    file.write_bytes(rlog.data)
    return file


def big_endian(record: Record) -> bytes:
    codes = {"boolean": "?", "int64": "q", "float": "f", "double": "d"}
    if isinstance(record.value, bytes):
        return record.value
    if record.type_name == "string":
        return record.value.encode()
    if record.type_name == "string[]":
        texts = [each.encode() for each in record.value]
        return struct.pack(">I", len(texts)) + b"".join(struct.pack(">I", len(each)) + each for each in texts)
    values = record.value if record.type_name.endswith("[]") else (record.value,)
    return struct.pack(f">{len(values)}{codes[record.type_name.removesuffix('[]')]}", *values)


def values_in(file: Path) -> list[Record]:
    return list(read_data_log(file).records(lambda entry: entry.name != "/Timestamp"))


def test_the_same_values_are_in_each_form(tmp_path: Path) -> None:
    for log in (a_match(), a_kit_log()):
        plain = log.save(tmp_path / "plain.wpilog")
        packed = tmp_path / "match.wpilogxz"
        packed.write_bytes(lzma.compress(log.data[:100]) + lzma.compress(log.data[100:]))  # of two streams
        rlog = of_revision_2(log, tmp_path / "match.rlog")
        assert values_in(packed) == values_in(rlog) == values_in(plain) != []
        shown = open_log(plain, HEIGHT)
        for file in (packed, rlog):
            opened = open_log(file, HEIGHT)
            assert (opened.problem, opened.run.end) == ("", shown.run.end)
            now, wanted = (dict(each.run.histories["network"].now) for each in (opened, shown))
            assert wanted.items() <= now.items()
            assert now.keys() - wanted.keys() <= {"nt:/Timestamp", "type:/Timestamp"}, "as AdvantageKit's .wpilog has"


def test_text_lists_and_what_does_not_fit_its_type(tmp_path: Path) -> None:
    rlog = WrittenRlog(2)
    rlog.time(1.0)
    texts, wrong = rlog.key("/texts", "string[]"), rlog.key("/wrong", "double")
    for payload in (struct.pack(">IIsI", 2, 1, b"a", 0), struct.pack(">I", 9), b""):
        rlog.value(texts, struct.pack(">H", len(payload)), payload)
    rlog.value(wrong, struct.pack(">H", 3), b"abc")
    file = tmp_path / "a.rlog"
    file.write_bytes(rlog.data)
    assert [record.value for record in values_in(file)] == [("a", "")]


def test_each_type_of_revision_1(tmp_path: Path) -> None:
    rlog = WrittenRlog(1)
    rlog.time(0.5)
    given_values: list[tuple[int, bytes, str, Any]] = [
        (1, b"\1", "boolean", True),
        (2, struct.pack(">H??", 2, True, False), "boolean[]", (True, False)),
        (3, struct.pack(">i", -7), "int64", -7),
        (4, struct.pack(">Hii", 2, 1, -2), "int64[]", (1, -2)),
        (5, struct.pack(">d", 0.25), "double", 0.25),
        (6, struct.pack(">Hdd", 2, 0.5, -1.5), "double[]", (0.5, -1.5)),
        (7, rlog.text("Größe".encode()), "string", "Größe"),
        (8, struct.pack(">H", 2) + rlog.text(b"a") + rlog.text(b""), "string[]", ("a", "")),
        (9, b"\7", "raw", b"\7"),
        (10, struct.pack(">HBB", 2, 1, 2), "raw", b"\1\2"),
    ]
    key = rlog.key("/value", "")
    for number, payload, _, _ in given_values:
        rlog.value(key, bytes([number]), payload)
    rlog.value(key, b"\0", b"")  # it has gone
    file = tmp_path / "a.rlog"
    file.write_bytes(rlog.data)
    assert [(r.at_us, r.name, r.type_name, r.value) for r in values_in(file)] == [
        (500_000, "/value", type_name, value) for _, _, type_name, value in given_values
    ]
    wrong = {
        b"\2\0\0\x0b": "damaged at byte {}: a type is wrong",
        b"\2\0\0\5\0": "cut at byte {}",
        b"\3": "damaged at byte {}",
        **{b"\0" + struct.pack(">d", each): "damaged at byte {}: a time is wrong" for each in (math.nan, -1.0, 1e300)},
    }
    for after, problem in wrong.items():
        file.write_bytes(rlog.data + after)
        assert problem.format(f"{len(rlog.data):,}") in read_data_log(file).problem


@pytest.mark.parametrize("form", ["wpilogxz", "rlog"])
def test_wherever_a_log_is_cut_its_beginning_is_shown_or_a_sentence_says_why_not(tmp_path: Path, form: str) -> None:
    file = of_revision_2(a_match(), tmp_path / "match.rlog")
    whole = file.read_bytes() if form == "rlog" else lzma.compress(a_match().data)
    file = tmp_path / f"match.{form}"
    seen = set()
    for end in range(0, len(whole), 1 + len(whole) // 60):
        file.write_bytes(whole[:end])
        try:
            seen.add(open_log(file, HEIGHT).problem.partition("cut")[1] or "whole")
        except PyfrcError:
            seen.add("refused")
    assert {"cut", "refused"} <= seen <= {"cut", "refused", "whole"}


HEADS = st.sampled_from([b"", b"\1", b"\2", b"\2\1\0\0\0\1a\0\6double", b"\1\1\0\0\0\1a", b"\xfd7zXZ\0", b"WPILOG\0\1"])


@settings(max_examples=150)
@given(HEADS, st.binary(max_size=300), st.sampled_from(["rlog", "wpilogxz", "wpilog"]), st.data())
def test_noise_is_no_traceback(
    tmp_path_factory: pytest.TempPathFactory, head: bytes, noise: bytes, form: str, data: st.DataObject
) -> None:
    file = tmp_path_factory.getbasetemp() / f"noise.{form}"
    packed = bytearray(lzma.compress(a_match().data[:400]))
    packed[data.draw(st.integers(0, len(packed) - 1))] ^= data.draw(st.integers(1, 255))
    for content in (head + noise, bytes(packed)):
        file.write_bytes(content)
        with suppress(PyfrcError):
            assert "\n" not in open_log(file, HEIGHT).problem


def test_the_inputs_of_a_run_are_the_same_in_each_form(tmp_path: Path) -> None:
    rlog = of_revision_2(a_kit_log(), tmp_path / "match.rlog")
    plain, packed = rlog.with_suffix(".wpilog"), rlog.with_suffix(".wpilogxz")
    packed.write_bytes(lzma.compress(plain.read_bytes()))
    wanted = load_inputs(plain)
    for file in (packed, rlog):
        assert is_data_log(file)
        found = load_inputs(file)
        assert (found.steps, found.end_us, found.problem) == (wanted.steps, wanted.end_us, "")
