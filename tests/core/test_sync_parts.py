"""What `pyfrc sync` makes of pip's report, of addresses and of failures of the network."""

from __future__ import annotations

import errno
import ssl
import urllib.error
from pathlib import Path
from typing import Any

import pytest

from pyfrc_core.errors import PyfrcError, UsageError
from pyfrc_core.season import CURRENT
from pyfrc_core.sync import LockedFile, download, synchronize
from pyfrc_core.sync.addresses import PYTHON_VARIABLE
from pyfrc_core.sync.cache import Cache
from pyfrc_core.sync.lock import is_file_name
from pyfrc_core.sync.resolve import _found, find_packages
from pyfrc_core.sync.synchronize import SyncOptions, _Work

HASH = "a" * 64


def installed(name: str, version: str, url: str, **archive: Any) -> dict[str, Any]:
    about = {"url": url, "archive_info": archive} if archive else {"url": url}
    return {"download_info": about, "metadata": {"name": name, "version": version}}


def test_pips_report_becomes_files_of_the_lock_sorted_and_without_passwords() -> None:
    index = "https://user:word@a.invalid/simple"
    report = {
        "install": [
            installed(
                "Six_Seven", "1", "https://user:word@a.invalid/x/six%2B7-1.whl#sha256=b", hashes={"sha256": HASH}
            ),
            installed("old", "2", "https://b.invalid/old-2.whl", hash=f"sha256={HASH}"),
            installed("md5", "3", "https://b.invalid/md5-3.whl", hash="md5=123", hashes={"md5": "123"}),
            installed("Here", "4", "file:///home/x/here-4.whl"),
        ]
    }
    assert _found(report, [index]) == [
        LockedFile("here", "4", "here-4.whl", 0, "", "file:///home/x/here-4.whl", None),
        LockedFile("md5", "3", "md5-3.whl", 0, "", "https://b.invalid/md5-3.whl", "https://b.invalid"),
        LockedFile("old", "2", "old-2.whl", 0, HASH, "https://b.invalid/old-2.whl", "https://b.invalid"),
        LockedFile("six-seven", "1", "six+7-1.whl", 0, HASH, "https://a.invalid/x/six%2B7-1.whl", "https://a.invalid"),
    ]
    assert find_packages([], CURRENT) == []  # pip is not asked


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (urllib.error.URLError(TimeoutError()), "it did not respond in time"),
        (TimeoutError(), "it did not respond in time"),
        (urllib.error.URLError(OSError(errno.EHOSTUNREACH, "No route to host")), "No route to host"),
        (ConnectionResetError(errno.ECONNRESET, "Connection reset by peer"), "Connection reset by peer"),
        (OSError("odd"), "odd"),
        (ConnectionError(), "ConnectionError"),
    ],
)
def test_the_reason_of_a_failed_download(error: BaseException, reason: str) -> None:
    assert download._reason(error) == reason
    failed = download._unreachable(download.Download("six 1", "https://a.invalid/six.whl", Path("six.whl")), reason)
    assert failed.message == f"six 1 cannot be downloaded from a.invalid: {reason}"
    assert failed.remedy.startswith("Connect this computer")


def test_a_certificate_that_is_not_trusted_has_another_remedy() -> None:
    error = ssl.SSLCertVerificationError()
    error.verify_message = "self-signed certificate"
    reason = download._reason(urllib.error.URLError(error))
    assert reason == "its certificate could not be verified (self-signed certificate)"
    failed = download._unreachable(download.Download("six 1", "https://a.invalid/six.whl", Path("six.whl")), reason)
    assert failed.remedy.startswith("Try: pyfrc sync --use-certifi.")


def test_a_full_disk_is_one_sentence_and_other_errors_stay() -> None:
    full = download.cannot_write(OSError(errno.ENOSPC, "No space left on device"), Path("six.whl"))
    assert getattr(full, "message", "") == "the disk is full: six.whl"
    other = PermissionError(errno.EACCES, "Permission denied")
    assert download.cannot_write(other, Path("six.whl")) is other


@pytest.mark.parametrize("name", ["six-1.17.0-py3-none-any.whl", "_a", "cpython+2.tar.gz", "1!2.whl"])
def test_names_of_files_that_a_lock_can_have(name: str) -> None:
    assert is_file_name(name) is True


@pytest.mark.parametrize("name", ["", ".hidden", "-r", "a/b", "..", "a b", "a\n", "ä.whl", "C:x", "a\\b", "a~1"])
def test_names_of_files_that_would_lead_elsewhere(name: str) -> None:
    assert is_file_name(name) is False


# -- getting files -----------------------------------------------------------------------------------------------------


class Seen:
    """What the progress shows."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def waiting(self) -> None:
        self.lines.append("waiting")

    def finding(self, package: str) -> None:
        self.lines.append(f"finding {package}")

    def note(self, text: str) -> None:
        self.lines.append(text)

    def received(self, what: str, there: int, total: int | None) -> None:
        self.lines.append(f"{what}: {there} of {total}")

    def got(self, locked: LockedFile, how: str, url: str | None = None) -> None:
        self.lines.append(f"{how} {locked.file}")


@pytest.fixture
def seen() -> Seen:
    return Seen()


@pytest.fixture
def work(tmp_path: Path, seen: Seen, monkeypatch: pytest.MonkeyPatch) -> _Work:
    monkeypatch.delenv(PYTHON_VARIABLE, raising=False)
    return _Work(CURRENT, Cache(tmp_path / "cache", CURRENT), SyncOptions(), seen)


def test_a_python_of_a_directory_is_copied_and_has_no_address_in_the_lock(
    work: _Work, seen: Seen, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import gzip

    archive = tmp_path / "python.tar.gz"
    archive.write_bytes(gzip.compress(b"a Python"))
    monkeypatch.setenv(PYTHON_VARIABLE, archive.as_uri())
    locked = work._python(None)
    assert (locked.name, locked.file, locked.size, locked.url) == (
        "python",
        "python.tar.gz",
        archive.stat().st_size,
        None,
    )
    assert seen.lines[0] == "copied python.tar.gz"
    assert seen.lines[1].startswith(f"Python {CURRENT.downloads.python} has no published hash; from file:")
    seen.lines.clear()
    assert work._python(locked) == locked
    assert seen.lines == []  # it is in the cache
    monkeypatch.setenv(PYTHON_VARIABLE, "https://a.invalid/my python.tar.gz")
    with pytest.raises(UsageError, match="whose last part cannot be the name of a file"):
        work._python(None)


def test_a_file_without_an_address_comes_from_the_directory_that_has_it(tmp_path: Path, seen: Seen) -> None:
    import hashlib

    links = tmp_path / "links"
    links.mkdir()
    (links / "six.whl").write_bytes(b"six")
    six = LockedFile("six", "1", "six.whl", 3, hashlib.sha256(b"six").hexdigest())
    with pytest.raises(PyfrcError, match="six 1 has no address in the lock: it came from a directory"):
        _Work(CURRENT, Cache(tmp_path / "cache", CURRENT), SyncOptions(), seen)._get(six)
    work = _Work(CURRENT, Cache(tmp_path / "cache", CURRENT), SyncOptions(find_links=[str(links)]), seen)
    assert work._get(six) == six
    assert Cache(tmp_path / "cache", CURRENT).has(six)
    assert seen.lines == ["copied six.whl"]


def test_files_that_the_disk_has_no_room_for_are_refused(work: _Work, monkeypatch: pytest.MonkeyPatch) -> None:
    from types import SimpleNamespace

    python = LockedFile("python", "3.14", "python.tar.gz", 1000, HASH, "https://a.invalid/p")
    lock = synchronize.Lock(CURRENT.year, CURRENT.controller.name, (), python, ())
    free = SimpleNamespace(free=1000)
    monkeypatch.setattr(synchronize.shutil, "disk_usage", lambda place: free)
    assert work._missing(lock) == [python]
    free.free = 999
    with pytest.raises(PyfrcError, match="the disk is too full: "):
        work._missing(lock)
