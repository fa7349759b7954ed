"""The lock of `pyfrc sync`, and the cache that it names files of."""

from __future__ import annotations

import hashlib
import re
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import pytest
from loops import for_each
from written_files import zip_of

from pyfrc_core.errors import PyfrcError, SettingsError
from pyfrc_core.file_hash import hash_file
from pyfrc_core.season import CURRENT, SEASONS
from pyfrc_core.sync import LOCK_FILE, Lock, LockedFile, cache_of, cached_file, load_lock
from pyfrc_core.sync.cache import NotSyncedError
from pyfrc_core.sync.lock import save_lock
from pyfrc_core.sync.pip_errors import explain
from pyfrc_core.sync.resolve import source_of
from pyfrc_core.sync.synchronize import _previous, _refuse_other_index
from pyfrc_core.sync.wheels import check_wheels

CONTENT = b"a wheel"
PYTHON = LockedFile("python", "3.14.3", "cpython-3.14.3+20260310.tar.gz", 30_000_000, "0" * 64, "https://a.invalid/p")
WHEEL = LockedFile("six", "1.17.0", "six-1.17.0-py3-none-any.whl", len(CONTENT), hashlib.sha256(CONTENT).hexdigest())
SEVEN = LockedFile("seven", "1", "seven-1.whl", 12, "1" * 64, "https://a.invalid/x/seven-1.whl", "https://a.invalid/x")
LOCK = Lock(CURRENT.year, CURRENT.controller.name, ("six>=1", 'x; python_version == "3.14"'), PYTHON, (SEVEN, WHEEL))


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
    assert LOCK.files == (PYTHON, SEVEN, WHEEL)
    assert load_lock(lock_file.with_name("another"), CURRENT) is None
    odd = replace(LOCK, requirements=('x; a == "ä\x7f\U0001f916\\"',))
    save_lock(lock_file, odd)
    assert load_lock(lock_file, CURRENT) == odd


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
        ('index = "https', 'index = "', "seven: index must be an address with http: or https:"),
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


def test_a_damaged_lock_is_replaced_only_by_an_upgrade(lock_file: Path):
    assert _previous(lock_file, CURRENT, upgrade=False) == _previous(lock_file, CURRENT, upgrade=True) == LOCK
    lock_file.write_text("version = 1\n", encoding="utf-8")
    assert _previous(lock_file, CURRENT, upgrade=True) is None
    with pytest.raises(SettingsError, match="this lock is damaged"):
        _previous(lock_file, CURRENT, upgrade=False)


@for_each(
    "url, indexes, source",
    [
        (
            "https://files.pythonhosted.org/packages/1/six.whl",
            ["https://pypi.org/simple"],
            "https://files.pythonhosted.org",
        ),
        (
            "https://a.invalid/two/six/six.whl",
            ["https://a.invalid/one", "https://a.invalid/two"],
            "https://a.invalid/two",
        ),
        ("https://a.invalid/x/packages/six.whl", ["https://me:secret@a.invalid/x/simple/"], "https://a.invalid/x"),
        ("https://a.invalid/xy/six.whl", ["https://a.invalid/x"], "https://a.invalid"),
        ("file:///wheels/six.whl", ["https://a.invalid"], None),
    ],
)
def test_which_index_a_file_comes_from(url: str, indexes: list[str], source: str | None):
    assert source_of(url, indexes) == source


@for_each(
    "url, index, new, is_other",
    [
        ("https://a.invalid/x/six.whl", "https://a.invalid/x", "https://a.invalid/x", False),
        ("https://a.invalid/x/six.whl", "https://a.invalid/x", "https://a.invalid/y", True),
        ("https://a.invalid/x/six.whl", None, "https://a.invalid/x", False),  # a lock of before 2026.2
        ("https://a.invalid/x/six.whl", None, "https://b.invalid/x", True),
        (None, None, None, False),
        (None, None, "https://a.invalid/x", True),
    ],
)
def test_another_version_from_another_index_is_refused(
    url: str | None, index: str | None, new: str | None, is_other: bool
):
    old = replace(WHEEL, url=url, index=index)
    found = LockedFile("six", "2.0", "six-2.whl", 0, "", f"{new or 'file:///x'}/six-2.whl", new)
    with (
        pytest.raises(PyfrcError, match=r"six 2\.0 would come from .*, and the locked 1\.17\.0 came")
        if is_other
        else (nullcontext())
    ):
        _refuse_other_index(found, old)
    _refuse_other_index(replace(found, version=old.version), old)
    _refuse_other_index(found, None)


def test_a_wrong_hash_in_an_index_is_the_indexs_fault():
    printed = """ERROR: THESE PACKAGES DO NOT MATCH THE HASHES FROM THE REQUIREMENTS FILE. If you have updated
    six from https://a.invalid/simple/six/six-1.17.0-py3-none-any.whl#sha256=00:
        Expected sha256 00
             Got        11
"""
    said = str(explain(printed, CURRENT))
    file = "https://a.invalid/simple/six/six-1.17.0-py3-none-any.whl"
    assert said.startswith(f"six: {file} has another content than its index says")
    assert "requirements" not in said


LOOKED = "Looking in indexes: http://a.invalid/simple, http://b.invalid:8/robot\n"
MISSING = "ERROR: Could not find a version that satisfies the requirement {} (from versions: {})\n"
RETRYING = (
    "WARNING: Retrying (Retry(total=1, connect=None)) after connection broken by "
    "'NewConnectionError('<HTTPConnection>: Failed to establish a new connection: [Errno 111] Connection refused')': "
    "/robot/six/\n"
)


@for_each(
    "printed, said, remedy",
    [
        (
            MISSING.format("six>5", "none"),
            "there is no wheel of six>5 for ROBOT",
            "wheel for the robot from its authors",
        ),
        (
            MISSING.format("six>5 (from seven)", "none"),
            "there is no wheel of six>5 for ROBOT; seven needs it",
            "Check the name",
        ),
        (
            MISSING.format("six>5", "0.1, 0.2, 0.3, 0.4, 0.5, 1.0"),
            "there is no wheel of six>5 for ROBOT; there are wheels of ... 0.2, 0.3, 0.4, 0.5, 1.0",
            "Ask for one of these versions",
        ),
        (
            "The conflict is caused by:\n    The user requested six==1\n    seven 1 depends on six<1\n",
            "the requirements contradict each other: [tool.robotpy] has six==1; seven 1 depends on six<1",
            "Change the versions under [tool.robotpy]",
        ),
        (
            LOOKED + RETRYING + MISSING.format("six", "none"),
            "a package index cannot be reached: Connection refused; pip has looked in http://a.invalid/simple, "
            "http://b.invalid:8/robot",
            "copy the cache and the lock",
        ),
        (
            "Could not fetch URL http://a.invalid/: certificate verify failed",
            "a package index cannot be reached: its certificate could not be verified",
            "A network that inspects connections needs its certificate",
        ),
        ("OSError: [Errno 28] No space left on device", "the disk is full", "Free some space"),
        ("ERROR: it broke\n", "pip could not find the packages: it broke", "pyfrc -v sync prints more."),
        ("", "pip could not find the packages: it printed nothing", "prints more"),
    ],
)
def test_why_pip_finds_nothing(printed: str, said: str, remedy: str):
    error, python = explain(printed, CURRENT), ".".join(map(str, CURRENT.controller.python))
    assert error.message == said.replace("ROBOT", f"the {CURRENT.controller.name} (Python {python})")
    assert remedy in str(error.remedy)


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


def wheels_in_cache(**wheels: dict[str, str]) -> Lock:
    """A lock of these wheels, which the cache has."""
    cache, packages = cache_of(CURRENT), []
    for name, files in wheels.items():
        path = cache.path_of(replace(WHEEL, file=f"{name}-1-py3-none-any.whl"))
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(zip_of(files))
        sha256, size = hash_file(path)
        packages.append(LockedFile(name, "1", path.name, size, sha256))
    return replace(LOCK, packages=tuple(packages))


@pytest.mark.usefixtures("home")
def test_wheels_with_the_same_files_are_named_if_these_differ():
    def notes(**wheels: dict[str, str]) -> list[str]:
        return list(check_wheels(wheels_in_cache(**wheels), CURRENT, cache_of(CURRENT)))

    tests = {"tests/__init__.py": "", "tests/test_a.py": "A = 1"}
    assert notes(a=tests, b={**tests, "b.py": ""}) == []
    b = {**tests, "tests/test_a.py": "A = 2"}
    assert notes(a=tests, b=b) == ["a 1 and b 1 both have tests/test_a.py: the robot gets that of b 1"]
    assert notes(b=b, a=tests) == ["b 1 and a 1 both have tests/test_a.py: the robot gets that of a 1"]
    twice = notes(a={**tests, "tests/__init__.py": "B = 1"}, b=b)
    assert twice == ["a 1 and b 1 both have tests/__init__.py and 1 more: the robot gets that of b 1"]


@pytest.mark.usefixtures("home")
@pytest.mark.parametrize(
    ("wheels", "why"),
    [
        ({"x": {"x-1.data/data/bin/python3": ""}}, r"^x-1-py3-none-any\.whl has a file in the place of Python's own"),
        ({"x": {"y": ""}, "z": {"y/z": ""}}, "x-1-py3-none-any.whl has a file where z-1-py3-none-any.whl has a dir"),
    ],
)
def test_wheels_that_no_robot_can_install_are_refused_by_name(wheels: dict[str, dict[str, str]], why: str):
    with pytest.raises(PyfrcError, match=why):
        list(check_wheels(wheels_in_cache(**wheels), CURRENT, cache_of(CURRENT)))


@pytest.mark.usefixtures("home")
def test_a_file_that_is_not_a_wheel_is_named():
    lock = wheels_in_cache(x={})
    cache_of(CURRENT).path_of(lock.packages[0]).write_bytes(b"PK")
    with pytest.raises(PyfrcError, match=r"^x-1-py3-none-any\.whl is not a wheel: "):
        list(check_wheels(lock, CURRENT, cache_of(CURRENT)))


def test_python_is_cached_where_the_seasons_tool_looks_for_it(home: Path):
    directory = {2026: "opkg_cache", 2027: "pkg_cache"}[CURRENT.year]
    assert cache_of(CURRENT).path_of(PYTHON).parent == home / "wpilib" / str(CURRENT.year) / "robotpy" / directory
