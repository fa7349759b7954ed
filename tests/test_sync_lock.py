"""The lock of `pyfrc sync`, and the cache that it names files of."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

import pytest

from pyfrc_core.errors import SettingsError
from pyfrc_core.season import CURRENT, SEASONS
from pyfrc_core.sync import LOCK_FILE, Lock, LockedFile, cache_of, cached_file, load_lock
from pyfrc_core.sync.cache import NotSyncedError
from pyfrc_core.sync.lock import save_lock

CONTENT = b"a wheel"
PYTHON = LockedFile("python", "3.14.3", "cpython-3.14.3+20260310.tar.gz", 30_000_000, "0" * 64, "https://a.invalid/p")
WHEEL = LockedFile("six", "1.17.0", "six-1.17.0-py3-none-any.whl", len(CONTENT), hashlib.sha256(CONTENT).hexdigest())
LOCK = Lock(CURRENT.year, CURRENT.controller.name, ("six>=1", 'x; python_version == "3.14"'), PYTHON, (WHEEL,))


@pytest.fixture
def lock_file(tmp_path: Path) -> Path:
    file = tmp_path / LOCK_FILE
    save_lock(file, LOCK)
    return file


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    return tmp_path / "home"


def test_it_reads_what_it_has_written(lock_file: Path):
    assert load_lock(lock_file, CURRENT) == LOCK
    assert LOCK.files == (PYTHON, WHEEL)
    assert load_lock(lock_file.with_name("another"), CURRENT) is None


@pytest.mark.parametrize(
    ("pattern", "instead", "message"),
    [
        ("version = 1", "version = 2", r"pyfrc-lock\.toml:2: a newer pyfrc wrote it \(format 2\)\n  Update pyfrc\."),
        (r"season = \d+", "", "season must be a year"),
        ("controller = .*", "", "controller is missing"),
        (r"(?s)\[python\].*?\n\n", "", r"\[python\] is missing"),
        ('name = "six"', "", "name is missing"),
        ('name = "six"', 'name = "python"', r"pyfrc-lock\.toml:\d+: this lock is damaged: python is there twice"),
        ("six-1.17", "../../six-1.17", r"six: file cannot be '\.\./\.\./six-1\.17\.0-py3-none-any\.whl'"),
        ("sha256 = .*", 'sha256 = "abc"', "sha256 cannot be 'abc'"),
        ("size = 7", "size = -7", "six: size must be a number of bytes"),
        ("https://a.invalid", "file:///etc", "python: url must be an address with http: or https:"),
        (r"\]\n\n", "", r"pyfrc-lock\.toml:\d+: this lock is damaged: not valid TOML"),
    ],
)
def test_a_damaged_lock_is_refused_with_its_line(lock_file: Path, pattern: str, instead: str, message: str):
    text = lock_file.read_text("utf-8")
    lock_file.write_text(re.sub(pattern, instead, text, count=1), "utf-8")
    assert lock_file.read_text("utf-8") != text
    with pytest.raises(SettingsError, match=message) as refused:
        load_lock(lock_file, CURRENT)
    assert "--upgrade" in str(refused.value) or "Update pyfrc" in str(refused.value)


def test_a_lock_of_another_season_is_refused(lock_file: Path):
    other = next(season for season in SEASONS.values() if season.year != CURRENT.year)
    message = f"for the {CURRENT.controller.name} of {CURRENT.year}, and the project for the {other.controller.name}"
    with pytest.raises(SettingsError, match=message):
        load_lock(lock_file, other)


def test_a_cached_file_has_the_locked_content(home: Path):
    cache = home / "wpilib" / str(CURRENT.year) / "robotpy"
    assert cache_of(CURRENT).root == cache
    with pytest.raises(NotSyncedError, match=r"six 1\.17\.0 for the robot is not on this computer yet"):
        cached_file(WHEEL, CURRENT)
    file = cache / "pip_cache" / WHEEL.file
    file.parent.mkdir(parents=True)
    file.write_bytes(CONTENT)
    assert cached_file(WHEEL, CURRENT) == file
    file.write_bytes(b"another")
    with pytest.raises(NotSyncedError, match="has another content than the lock says"):
        cached_file(WHEEL, CURRENT)


def test_python_is_cached_where_the_seasons_tool_looks_for_it(home: Path):
    directory = {2026: "opkg_cache", 2027: "pkg_cache"}[CURRENT.year]
    assert cache_of(CURRENT).path_of(PYTHON).parent == home / "wpilib" / str(CURRENT.year) / "robotpy" / directory
