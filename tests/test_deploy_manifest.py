"""The files of a project that are uploaded, excluded or refused."""

from __future__ import annotations

import hashlib
import os
import sys
import tracemalloc
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from loops import for_each

from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.manifest import LARGE, build_manifest, is_excluded
from pyfrc_core.passes.memory import read_contents
from pyfrc_core.project import Project

posix = pytest.mark.skipif(sys.platform == "win32", reason="names and links that Windows has not")


def make(root: Path, *names: str, content: bytes = b"x") -> None:
    for name in names:
        file = root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)


def paths(root: Path, *exclude: str) -> list[str]:
    return [entry.path for entry in build_manifest(root, exclude).entries]


def private_files(root: Path, exclude: Sequence[str] = (), meant: Sequence[str] = ()) -> dict[str, str]:
    return dict(build_manifest(root, exclude, meant=meant).private)


def test_large_projects_are_deployed_by_size_and_content(tmp_path: Path) -> None:
    make(tmp_path, "robot.py", content=b"print()\n")
    make(tmp_path, "components/arm.py", content=b"")
    (tmp_path / "robot.py").chmod(0o755)
    manifest = build_manifest(tmp_path)
    arm, robot = manifest.entries
    assert (arm.path, arm.size) == ("components/arm.py", 0)
    assert (robot.path, robot.size, robot.file) == ("robot.py", 8, tmp_path / "robot.py")
    assert robot.sha256 == hashlib.sha256(b"print()\n").hexdigest()
    assert not arm.executable
    assert robot.executable == (os.name == "posix")
    assert manifest.total_bytes == 8


def test_a_file_larger_than_memory_is_hashed_in_pieces(tmp_path: Path) -> None:
    make(tmp_path, "robot.py")
    with (tmp_path / "video.bin").open("wb") as stream:
        stream.truncate(1 << 25)
    project = Project(tmp_path / "robot.py")
    for read in (lambda: build_manifest(tmp_path, large=True), lambda: read_contents(project)):
        read()  # imports and caches do not count
        tracemalloc.start()
        read()
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < 1 << 22
    video = build_manifest(tmp_path, large=True).entries[1]
    assert (video.size, video.sha256) == (1 << 25, hashlib.sha256(bytes(1 << 25)).hexdigest())


def test_what_no_tool_uploads_is_left_out(tmp_path: Path) -> None:
    make(tmp_path, "robot.py", "data/zip.py", "tests/test_it.py")
    left_out = ("a.pyc", "b.whl", "c.ipk", "d.zip", "e.gz", "f.wpilog", ".hidden")
    make(tmp_path, *left_out, *(f"data/{name}" for name in left_out), "deploy.json", "pyfrc-lock.toml")
    make(tmp_path, *(f"{name}/x.py" for name in (".git", "__pycache__", "venv", "ctre_sim", "data/__pycache__")))
    make(tmp_path, "data/venv")  # a file of this name is one of the user's
    assert paths(tmp_path) == ["data/venv", "data/zip.py", "robot.py", "tests/test_it.py"]


@for_each(
    "pattern, left",
    [
        ("*.png", ["a/b/one.py", "a/two.txt", "robot.py"]),
        ("b", ["a/pic.png", "a/two.txt", "pic.png", "robot.py"]),
        ("b/", ["a/pic.png", "a/two.txt", "pic.png", "robot.py"]),
        ("a/*.txt", ["a/b/one.py", "a/b/pic.png", "a/pic.png", "pic.png", "robot.py"]),
        ("/pic.png", ["a/b/one.py", "a/b/pic.png", "a/pic.png", "a/two.txt", "robot.py"]),
        ("a/**/*.png", ["a/b/one.py", "a/two.txt", "pic.png", "robot.py"]),
        ("**/b/one.py", ["a/b/pic.png", "a/pic.png", "a/two.txt", "pic.png", "robot.py"]),
    ],
)
def test_exclude_patterns(pattern: str, left: list[str], tmp_path: Path) -> None:
    make(tmp_path, "robot.py", "pic.png", "a/pic.png", "a/two.txt", "a/b/one.py", "a/b/pic.png")
    assert paths(tmp_path, pattern) == left


_names = st.text(st.characters(codec="utf-8", exclude_characters="/\0*?[]"), min_size=1, max_size=8)


@given(st.lists(_names, min_size=1, max_size=5))
def test_every_path_fits_itself_and_the_pattern_for_everything(parts: list[str]) -> None:
    path = "/".join(parts)
    assert is_excluded(path, [f"/{path}"])
    assert is_excluded(path, ["/**"])
    assert is_excluded(path, [parts[-1]])
    assert not is_excluded(path, [f"/{path}/**/x"])


@posix
def test_odd_names_are_uploaded_as_they_are(tmp_path: Path) -> None:
    names = ["-rf", "a b.py", "käse.py", "new\nline.py", "quote'\".py", "$(reboot).py", "back\\slash.py"]
    make(tmp_path, *names)
    assert paths(tmp_path) == sorted(names)


@posix
def test_names_that_are_not_utf8_are_refused_by_name(tmp_path: Path) -> None:
    try:
        Path(os.fsdecode(os.fsencode(tmp_path) + b"/caf\xe9.py")).write_bytes(b"")
    except OSError:
        pytest.skip("this file system has no such names")
    with pytest.raises(RefusedError, match=r"'caf\\udce9\.py'"):
        build_manifest(tmp_path)


@posix
def test_links_inside_the_project_are_uploaded_as_what_they_lead_to(tmp_path: Path) -> None:
    make(tmp_path, "real/one.py", content=b"one")
    (tmp_path / "file.py").symlink_to("real/one.py")
    (tmp_path / "directory").symlink_to("real")
    manifest = build_manifest(tmp_path)
    assert {entry.path: entry.size for entry in manifest.entries} == {
        "directory/one.py": 3,
        "file.py": 3,
        "real/one.py": 3,
    }


@posix
@pytest.mark.parametrize("leads_to", ["/etc/passwd", "/etc", "../outside.py", "nowhere.py", "round.link", "."])
def test_links_that_cannot_be_uploaded_are_refused_by_name(leads_to: str, tmp_path: Path) -> None:
    project = tmp_path / "project"
    make(tmp_path, "outside.py", "project/robot.py", "project/package/x.py")
    link = "package/round.link"
    (project / link).symlink_to(leads_to)
    with pytest.raises(RefusedError) as caught:
        build_manifest(project)
    assert str(caught.value).startswith(f"{link}: this link leads ")
    assert "exclude" in str(caught.value)
    assert paths(project, "*.link") == ["package/x.py", "robot.py"]


@posix
def test_what_is_no_file_is_refused_by_name(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(RefusedError, match=r"^pipe: .*a pipe"):
        build_manifest(tmp_path)


def test_what_cannot_be_read_is_refused_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Patched, since the user who runs these tests may have permission to read every file."""
    make(tmp_path, "robot.py", "secret.txt")
    opened = os.open

    def guarded(path: str, *args: Any, **options: Any) -> int:
        if Path(path).name == "secret.txt":
            raise PermissionError(13, "Permission denied", str(path))
        return opened(path, *args, **options)

    monkeypatch.setattr(os, "open", guarded)
    with pytest.raises(RefusedError, match=r"secret.txt: this cannot be read: Permission denied\n.*exclude"):
        build_manifest(tmp_path)


def test_large_files_are_uploaded_only_when_they_are_meant(tmp_path: Path) -> None:
    make(tmp_path, "just.bin", content=bytes(LARGE))
    assert paths(tmp_path) == ["just.bin"]
    make(tmp_path, *(f"{number:02}.bin" for number in range(12)), content=bytes(LARGE + 1))
    with pytest.raises(RefusedError, match=r"00\.bin \(250,001 bytes\), .* and 2 more\n.*--large.*exclude"):
        build_manifest(tmp_path)
    assert len(build_manifest(tmp_path, large=True).entries) == 13
    assert paths(tmp_path, "[01]*.bin") == ["just.bin"]


# -- environments and private files ---------------------------------------------------------------------------------


def test_environments_are_not_uploaded_whatever_they_are_called(tmp_path: Path) -> None:
    make(tmp_path, "robot.py", "frc2026/pyvenv.cfg", "frc2026/lib/wpilib.py", "conda/conda-meta/history", "conda/a.py")
    make(tmp_path, "lib/arm.py", "lib/nested/pyvenv.cfg", "lib/nested/b.py")
    assert paths(tmp_path) == ["lib/arm.py", "robot.py"]
    assert [each for each in read_contents(Project(tmp_path / "robot.py")).sources if "lib/arm" not in each] == [
        "robot.py"
    ]


def test_a_project_that_is_an_environment_itself_is_refused(tmp_path: Path) -> None:
    make(tmp_path, "robot.py", "pyvenv.cfg", "lib/wpilib.py")
    with pytest.raises(RefusedError, match=r"is itself a virtual environment.*\n.*python -m venv .venv"):
        build_manifest(tmp_path)
    assert paths(tmp_path, "pyvenv.cfg", "lib") == ["robot.py"]


@posix
def test_links_to_what_is_not_uploaded_are_private(tmp_path: Path) -> None:
    make(tmp_path, "robot.py", ".env", ".config/deep/key.txt", "notes/plan.txt", "notes.txt")
    (tmp_path / "settings.txt").symlink_to(".env")
    (tmp_path / "config").symlink_to(".config")
    (tmp_path / "plan.txt").symlink_to("notes/plan.txt")
    (tmp_path / "other.txt").symlink_to("notes.txt")
    assert private_files(tmp_path, ["notes"]) == {
        "settings.txt": "leads to .env, which is not uploaded itself",
        "config/deep/key.txt": "leads to .config/deep/key.txt, which is not uploaded itself",
        "plan.txt": "leads to notes/plan.txt, which is not uploaded itself",
    }
    assert private_files(tmp_path, ["notes", "settings.txt", "plan.txt"], ["config/**"]) == {}


def test_keys_are_private_by_their_names(tmp_path: Path) -> None:
    keys = ["id_rsa", "keys/id_ed25519", "deploy.pem", "server.KEY", "a.p12", "passwords.kdbx", "config/prod.env"]
    make(tmp_path, *keys, "robot.py", "id_rsa.pub", "known_hosts", "environment.py", "keys.json", ".env", ".netrc")
    assert private_files(tmp_path) == dict.fromkeys(sorted(keys), "files of this name hold keys or passwords")
    assert private_files(tmp_path, (), ["id_*", "*.*"]) == {}
