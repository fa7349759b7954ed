"""What `pyfrc sync` makes of pip's report, of addresses and of failures of the network."""

from __future__ import annotations

import errno
import gzip
import hashlib
import ssl
import threading
import urllib.error
from collections.abc import Callable
from dataclasses import replace
from email.message import Message
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each
from packaging.markers import Marker, default_environment
from packaging.requirements import Requirement

from pyfrc_core._version import __version__
from pyfrc_core.errors import PyfrcError, UsageError
from pyfrc_core.season import CURRENT, Season
from pyfrc_core.sync import Lock, LockedFile, download, install, synchronize
from pyfrc_core.sync.addresses import PYTHON_VARIABLE
from pyfrc_core.sync.cache import Cache
from pyfrc_core.sync.lock import is_file_name
from pyfrc_core.sync.pip_errors import NothingFitsError
from pyfrc_core.sync.resolve import _found, find_packages
from pyfrc_core.sync.synchronize import SyncOptions, _Work
from pyfrc_core.sync.wanted import Wanted, load_wanted, robot_environment

HASH = "a" * 64
PYTHON_FILE = LockedFile("python", "3.14", "python.tar.gz", 1, HASH, "https://a.invalid/p")


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


@for_each(
    "error, reason",
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


def test_which_certificates_are_trusted(monkeypatch: pytest.MonkeyPatch) -> None:
    for named, found in (("", None), ("/a.pem", "/a.pem")):
        monkeypatch.setenv("PIP_CERT", named)
        assert download._certificates(use_certifi=False) == found
    monkeypatch.setattr(download, "import_module", lambda name: SimpleNamespace(where=lambda: f"{name}.pem"))
    assert download._certificates(use_certifi=True) == "certifi.pem"

    def missing(name: str) -> None:
        raise ImportError

    monkeypatch.setattr(download, "import_module", missing)
    with pytest.raises(PyfrcError, match="--use-certifi needs the package certifi\n  Install it: "):
        download._certificates(use_certifi=True)


@for_each(
    "content, complete",
    [
        (gzip.compress(b"x" * 99), True),
        (gzip.compress(b"x" * 99)[:-4], False),
        (b"<html>", False),
        (b"", False),
    ],
)
def test_which_archives_are_complete(content: bytes, complete: bool, tmp_path: Path) -> None:
    file = tmp_path / "python.tar.gz.part"
    file.write_bytes(content)
    assert download._is_complete_archive(file) is complete


def test_a_full_disk_is_one_sentence_and_other_errors_stay() -> None:
    full = download.cannot_write(OSError(errno.ENOSPC, "No space left on device"), Path("six.whl"))
    assert getattr(full, "message", "") == "the disk is full: six.whl"
    other = PermissionError(errno.EACCES, "Permission denied")
    assert download.cannot_write(other, Path("six.whl")) is other


@for_each("name", ["six-1.17.0-py3-none-any.whl", "_a", "cpython+2.tar.gz", "1!2.whl"])
def test_names_of_files_that_a_lock_can_have(name: str) -> None:
    assert is_file_name(name) is True
    for other in ("", ".hidden", "-r", "a/b", "..", "a b", "a\n", "ä.whl", "C:x", "a\\b", "a~1"):
        assert is_file_name(other) is False, f"{other} would lead elsewhere"


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


def test_a_download_shows_how_much_has_come(work: _Work, seen: Seen, monkeypatch: pytest.MonkeyPatch) -> None:
    def get(wanted: download.Download, advanced: Callable[[int, int | None], None]) -> bool:
        advanced(1, 3)
        wanted.to.parent.mkdir(parents=True)
        wanted.to.write_bytes(b"six")
        return True

    monkeypatch.setattr(work._downloader, "get", get)
    six = LockedFile("six", "1", "six.whl", 3, hashlib.sha256(b"six").hexdigest(), "https://a.invalid/six.whl")
    assert work._get(six) == six
    assert seen.lines == ["six 1: 1 of 3", "downloaded six.whl"]


def test_files_that_the_disk_has_no_room_for_are_refused(work: _Work, monkeypatch: pytest.MonkeyPatch) -> None:
    python = LockedFile("python", "3.14", "python.tar.gz", 1000, HASH, "https://a.invalid/p")
    lock = synchronize.Lock(CURRENT.year, CURRENT.controller.name, (), python, ())
    free = SimpleNamespace(free=1000)
    monkeypatch.setattr(synchronize.shutil, "disk_usage", lambda place: free)
    assert work._missing(lock) == [python]
    free.free = 999
    with pytest.raises(PyfrcError, match="the disk is too full: "):
        work._missing(lock)


# -- finding packages --------------------------------------------------------------------------------------------------

META = CURRENT.downloads.packages
SIX, SEVEN = (LockedFile("six", v, f"six-{v}.whl", 0, "", f"https://a.invalid/six-{v}.whl") for v in ("1", "2"))


@pytest.mark.parametrize(
    ("settings", "locked", "version"),
    [
        ("", (META,), "2026.9"),
        ("components = ['commands2', 'apriltag']\n", (f"{META}[apriltag,commands2]",), "2026.9"),
        ("robotpy_version = '2026.1'\nrequires = ['six>1', 'pyfrc']\n", (f"{META}==2026.1", "six>1"), None),
        ("robotpy_version = 'ignored'\nrequires = ['six']\n", ("six",), None),
        (
            "robotpy_version = 'ignored'\nrequires = ['x @ https://a.invalid/x-1-py3-none-any.whl#sha256=0']\n",
            (str(Requirement("x @ https://a.invalid/x-1-py3-none-any.whl#sha256=0")),),
            None,
        ),
    ],
)
def test_what_a_project_asks_for(settings: str, locked: tuple[str, ...], version: str | None, tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text(f"[tool.robotpy]\n{settings}")
    assert load_wanted(tmp_path / "pyproject.toml", CURRENT, "2026.9") == Wanted(locked, version)


def test_locked_versions_are_kept_as_long_as_they_fit(work: _Work, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[list[str], list[str]]] = []

    def find(requirements: list[str], season: Season, *, constraints: list[str], **more: Any) -> list[LockedFile]:
        asked.append((requirements, constraints))
        if "six==1" in constraints and requirements != ["six"]:
            raise NothingFitsError("six==1 does not fit")
        return [SIX]

    monkeypatch.setattr(synchronize, "find_packages", find)
    assert work._find(Wanted(("six",), "2026.9"), {"six": SIX}) == [SIX]
    assert work._find(Wanted(("six>1",), "2026.9"), {"six": SIX}) == [SIX]
    assert work._find(Wanted(("six",), None), {}) == [SIX]
    newest = [f"{META}==2026.9"]
    assert asked == [(["six"], ["six==1"]), (["six>1"], ["six==1"]), (["six>1"], newest), (["six"], [])]


def test_a_new_lock_has_what_was_found(work: _Work, monkeypatch: pytest.MonkeyPatch) -> None:
    python = PYTHON_FILE
    monkeypatch.setattr(work, "_find", lambda wanted, old: [SIX if old else SEVEN])
    monkeypatch.setattr(work, "_python", lambda locked: locked or replace(python, version="3.15"))
    monkeypatch.setattr(work, "_get", lambda locked, url: replace(locked, size=3, sha256=HASH))
    before = Lock(CURRENT.year, CURRENT.controller.name, ("six",), python, (replace(SIX, size=3, sha256=HASH),))
    wanted = Wanted(("six", "seven"))
    assert work.make_lock(wanted, before, keep=True) == replace(before, requirements=wanted.locked)
    new = replace(before, requirements=wanted.locked, python=replace(python, version="3.15"))
    assert work.make_lock(wanted, before, keep=False) == replace(new, packages=(replace(SEVEN, size=3, sha256=HASH),))
    assert work.make_lock(wanted, None, keep=True).python.version == "3.15"


def test_what_the_cache_has_under_another_lock_is_not_got_again(work: _Work, monkeypatch: pytest.MonkeyPatch) -> None:
    got: list[str] = []
    monkeypatch.setattr(work, "_get", lambda locked, url: got.append(url) or locked)
    found = replace(SIX, sha256=hashlib.sha256(b"six").hexdigest(), index="https://b.invalid")
    there = work._cache.path_of(found)
    there.parent.mkdir(parents=True)
    there.write_bytes(b"six")
    assert work._package(found, None) == replace(found, size=3)
    assert work._package(found, replace(found, size=3, index=None)) == replace(found, size=3)
    assert got == []
    there.write_bytes(b"another")
    assert work._package(found, None) == found
    assert got == [found.url]


def test_only_one_process_at_a_time_changes_the_cache(tmp_path: Path) -> None:
    cache, waited = Cache(tmp_path / "cache", CURRENT), threading.Event()

    def change() -> None:
        with cache.changed_alone(waited.set):
            (tmp_path / "done").touch()

    with cache.changed_alone(lambda: pytest.fail("it is alone")):
        other = threading.Thread(target=change)
        other.start()
        assert waited.wait(60)
        assert not (tmp_path / "done").exists()
    other.join(60)
    assert (tmp_path / "done").exists()


def test_what_this_computer_has_and_lacks(monkeypatch: pytest.MonkeyPatch) -> None:
    here = {"six": "2", "click": "8"}
    monkeypatch.setattr(install, "_version_here", here.get)
    packages = (SIX, replace(SIX, name="click", version="8"), replace(SIX, name="only-on-robots"))
    lock = Lock(CURRENT.year, "", ("six", "No_Such>1", f"{META}[all]", "x; python_version<'3'"), PYTHON_FILE, packages)
    assert list(install.different_here(lock)) == ["six 2 (the robot: 1)"]
    assert list(install.missing_here(lock, CURRENT)) == ["no-such"]
    wpilib = replace(lock, packages=(replace(SIX, name=META, version="2027.0a1"),))
    assert install._with_version(f"{META}[all]", wpilib, CURRENT) == f"{META}[all]==2027.0a1"
    for unchanged in (f"{META}==2026.1", f"{META}-cli", "six"):
        assert install._with_version(unchanged, wpilib, CURRENT) == unchanged
    assert install._with_version(META, lock, CURRENT) == META


def test_what_is_installed_here_has_the_locked_versions(monkeypatch: pytest.MonkeyPatch) -> None:
    lock = Lock(CURRENT.year, "", ("six>=1",), PYTHON_FILE, (SIX,))
    commands: list[list[str]] = []

    def run(command: list[str], stdin: int) -> SimpleNamespace:
        commands.append(command)
        limits = Path(command[command.index("--constraint") + 1]).read_text("utf-8")
        assert limits == f"six==1\npyfrc=={__version__}\n"
        return SimpleNamespace(returncode=len(commands) - 1)

    monkeypatch.setattr(install.subprocess, "run", run)
    install.install_here(replace(lock, requirements=()), CURRENT, [])
    install.install_here(lock, CURRENT, ["wheels"], quiet=True)
    (command,) = commands
    assert command[1:6] == ["-m", "pip", "install", "--disable-pip-version-check", "--quiet"]
    assert command[6:8] == ["--find-links", "wheels"]
    assert command[-1] == "six>=1"
    with pytest.raises(PyfrcError, match="pip could not install the robot's versions on this computer"):
        install.install_here(lock, CURRENT, [])


def test_a_copy_appears_only_when_it_is_complete(work: _Work, tmp_path: Path) -> None:
    (tmp_path / "six.whl").write_bytes(b"six")
    six = LockedFile("six", "1", "six.whl", 3, hashlib.sha256(b"six").hexdigest())
    work._copy(six, tmp_path)
    with pytest.raises(PyfrcError, match="changes while it is read"):
        work._copy(replace(six, size=4), tmp_path)
    assert [each.name for each in (tmp_path / "cache/pip_cache").iterdir()] == ["six.whl"]


def test_versions_of_this_computer_and_a_python_like_the_robots(monkeypatch: pytest.MonkeyPatch) -> None:
    assert install._version_here("pytest") == pytest.__version__
    assert install._version_here("no-such-package") is None
    robot = default_environment() | robot_environment(CURRENT)
    assert Marker("platform_python_implementation == 'CPython' and implementation_name == 'cpython'").evaluate(robot)
    assert Marker("sys_platform == 'linux' and platform_system == 'Linux' and os_name == 'posix'").evaluate(robot)
    assert robot["python_version"] == ".".join(CURRENT.downloads.python.split(".")[:2])


def test_a_refused_download_says_what_to_correct() -> None:
    def refused(code: int, named_by: str | None = None) -> tuple[str, str]:
        wanted = download.Download("six 1", "https://a.invalid/six.whl", Path("six.whl"), named_by=named_by)
        error = download._refused(wanted, urllib.error.HTTPError(wanted.url, code, "Gone", Message(), None))
        return error.message, error.remedy

    assert refused(404)[0] == "six 1 is no longer at https://a.invalid/six.whl"
    assert refused(404)[1].startswith("Run pyfrc sync --upgrade")
    message, remedy = refused(404, PYTHON_VARIABLE)
    assert message == "six 1 is not at https://a.invalid/six.whl"
    assert remedy == f"The variable {PYTHON_VARIABLE} names this address: correct it, or unset it."
    assert refused(503, PYTHON_VARIABLE)[0] == "six 1 cannot be downloaded from a.invalid: HTTP 503 Gone"
