"""What wheels install, and which are refused: `pyfrc sync` and the robot ask the same function."""

from __future__ import annotations

import io
import stat
from zipfile import ZIP_BZIP2, ZipFile, ZipInfo

import pytest
from loops import for_each

from pyfrc_core.wheel_files import WheelError, files_of, owners

PACKAGES = "lib/python3.14/site-packages"


def paths(*names: str | ZipInfo, wheel: str = "x-1-py3-none-any.whl") -> list[str]:
    content = io.BytesIO()
    with ZipFile(content, "w") as archive:
        for name in names:
            archive.writestr(name if isinstance(name, ZipInfo) else ZipInfo(name), "")
    with ZipFile(content) as archive:
        return [each.path for each in files_of(archive, wheel, PACKAGES)]


def test_where_files_belong() -> None:
    assert paths("x/__init__.py", "x-1.data/purelib/p.py", "x-1.data/platlib/q.so", "x-1.data/scripts/tool") == [
        f"{PACKAGES}/x/__init__.py",
        f"{PACKAGES}/p.py",
        f"{PACKAGES}/q.so",
        "bin/tool",
    ]
    assert paths("x-1.data/data/share/x/a.txt", "x-1.data/headers/x.h") == ["share/x/a.txt", "include/site/x.h"]
    assert paths("pip/__init__.py", wheel="pip-26.0-py3-none-any.whl") == [f"{PACKAGES}/pip/__init__.py"]
    assert paths("x-1.data/data/bin/pythonic", "x-1.data/data/lib/libx.so") == ["bin/pythonic", "lib/libx.so"]


@for_each(
    "path",
    [
        *("bin/python3", "bin/python", "bin/python3.14", "bin/PYTHON3", "bin/activate", "bin/Activate.ps1"),
        *("pyvenv.cfg", "PyVenv.cfg", "environment.json", ".gitignore", "lib64", "lib64/x.py", "pyvenv.cfg/x"),
        *("bin", "lib", "include", "lib/python3.14", PACKAGES),
    ],
)
def test_what_python_has_made_is_not_for_wheels(path: str) -> None:
    with pytest.raises(WheelError, match=r"^x-1-py3-none-any\.whl has a file in the place of Python's own: "):
        paths(f"x-1.data/data/{path}")


@for_each(
    "names, why",
    [
        (["../x.py"], "leads out of it"),
        (["/etc/passwd"], "leads out of it"),
        (["a//b.py"], "leads out of it"),
        (["a\\b.py"], "leads out of it"),
        (["x-1.data/nowhere/x"], "an unknown place"),
        (["x-1.data/x"], "an unknown place"),
        (["a" * 256], "whose name is too long"),
        (["\u00e9" * 128], "whose name is too long"),
        (["tests/a.py", "Tests/a.py"], "files whose names are the same in lower case: 'tests/a.py', 'Tests/a.py'"),
        (["\u00e9.py", "e\u0301.py"], "files whose names are the same in lower case"),
        (["a.py", "x-1.data/purelib/a.py"], "the same file twice"),
    ],
)
def test_names_that_no_robot_can_have(names: list[str], why: str) -> None:
    with pytest.raises(WheelError, match=why):
        paths(*names)


@for_each("kind", [stat.S_IFLNK, stat.S_IFIFO, stat.S_IFCHR])
def test_links_and_devices_are_the_wheels_fault(kind: int) -> None:
    link = ZipInfo("x/link")
    link.external_attr = (kind | 0o777) << 16
    with pytest.raises(WheelError, match=r"x-1-py3-none-any\.whl has a link, which wheels cannot have: 'x/link'"):
        paths(link)


def test_what_a_robots_python_may_not_unpack() -> None:
    packed = ZipInfo("x.py")
    packed.compress_type = ZIP_BZIP2
    with pytest.raises(WheelError, match=r"a file that robots cannot unpack: 'x\.py'"):
        paths(packed)


def test_a_wheel_that_is_larger_than_a_robots_disk() -> None:
    content = io.BytesIO()
    with ZipFile(content, "w") as archive:
        archive.writestr(ZipInfo("x.py"), "")
        archive.filelist[0].file_size = (1 << 30) + 1
    with ZipFile(content) as archive, pytest.raises(WheelError, match=r"too large .* 1,073,741,825 bytes"):
        files_of(archive, "x-1.whl", PACKAGES)


def test_of_several_wheels_with_the_same_file_the_last_counts() -> None:
    assert owners([("a", ["x", "y"]), ("b", ["y", "z"]), ("c", ["z"])]) == {"x": "a", "y": "b", "z": "c"}


@for_each("wheels", [[("a", ["x"]), ("b", ["x/y/z"])], [("b", ["x/y/z"]), ("a", ["x"])]])
def test_a_file_of_one_wheel_cannot_be_a_directory_of_another(wheels: list[tuple[str, list[str]]]) -> None:
    with pytest.raises(WheelError, match="a has a file where b has a directory: 'x'"):
        owners(wheels)
