"""Wheels in an environment: unpacked, or linked from another one. pip on the robot does not know the robot's tags."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from zipfile import BadZipFile, ZipFile

from .activity import Activity
from .compiling import CompiledForms
from .disk import BLOCK, link_or_copy
from .robot_paths import Refusal

_SCRIPT = b"#!python"


def unpack_wheel(wheel: Path, name: str, environment: Path, packages: Path, activity: Activity) -> list[str]:
    """Unpack a wheel as the specification of wheels says. Its console scripts are not made.

    Return the paths of its files in the environment.

    :param name:     the wheel's name, for messages
    :param packages: the directory of the environment's packages
    :raises Refusal: if it is damaged, or has a path that leads out of the environment
    """
    unpacked = []
    try:
        with ZipFile(wheel) as archive:
            for member in archive.infolist():
                if not member.is_dir():
                    target = _target(member.filename, name, environment, packages)
                    target.parent.mkdir(parents=True, exist_ok=True)
                    with archive.open(member) as content, target.open("wb") as file:
                        block = content.read(BLOCK)
                        if block.startswith(_SCRIPT) and target.parent == environment / "bin":
                            block = f"#!{environment}/bin/python3".encode() + block[len(_SCRIPT) :]
                        while block:
                            file.write(block)
                            block = content.read(BLOCK)
                            activity.step(0)
                    executable = (member.external_attr >> 16) & 0o111 or target.parent == environment / "bin"
                    target.chmod(0o755 if executable else 0o644)
                    unpacked.append(target.relative_to(environment).as_posix())
    except (BadZipFile, NotImplementedError, EOFError) as error:
        raise Refusal("wheel", f"{name} cannot be unpacked: {error}") from error
    activity.step()
    return unpacked


def link_wheel(files: Iterable[str], source: Path, environment: Path, forms: CompiledForms, activity: Activity) -> None:
    """Link the files of a wheel, with their compiled files, from another environment with the same Python.

    :param files: their paths in it
    :param forms: the compiled files of the other environment
    """
    for file in files:
        target = environment / file
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.parent == environment / "bin":  # it may begin with the environment's path
            there = (source / file).read_bytes()
            target.write_bytes(there.replace(f"#!{source}/".encode(), f"#!{environment}/".encode(), 1))
            target.chmod(0o755)
        else:
            link_or_copy(f"{source}/{file}", str(target))
            forms.link(f"{source}/{file}", str(target))
        activity.step(0)
    activity.step()


def _target(member: str, wheel: str, environment: Path, packages: Path) -> Path:
    """Return where a member of a wheel belongs."""
    parts = member.split("/")
    if "\\" in member or "\0" in member or any(part in ("", ".", "..") for part in parts):
        raise Refusal("wheel", f"{wheel} has a file that leads out of it: {member!r}")
    if not parts[0].endswith(".data"):
        return packages.joinpath(*parts)
    places = {"purelib": packages, "platlib": packages, "scripts": environment / "bin", "data": environment}
    places["headers"] = environment / "include" / "site"
    if len(parts) < 3 or parts[1] not in places:
        raise Refusal("wheel", f"{wheel} has a file for an unknown place: {member!r}")
    return places[parts[1]].joinpath(*parts[2:])
