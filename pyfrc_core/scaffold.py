"""New robot projects, made from the templates."""

from __future__ import annotations

import shutil
from pathlib import Path

from .errors import UsageError

#: A template's files whose names would be in the way in this repository: name there to name in the project.
_RENAMED = {"gitignore": ".gitignore"}

_LEFT_OUT = {"__pycache__", ".pytest_cache"}


def templates_directory(installed: Path) -> Path:
    """The templates: in the installed package, or in the checkout when pyfrc runs from one.

    :param installed: the package that carries them when it is installed
    """
    inside, beside = installed / "templates", installed.parent / "templates"
    return inside if inside.is_dir() else beside


def create_project(directory: Path, installed: Path, template: str = "tank") -> list[Path]:
    """Copy a template; answers the files written, relative to `directory`.

    :raises UsageError: when one of its files is there already; nothing is written then
    """
    source = templates_directory(installed) / template
    files = {
        file: Path(*(_RENAMED.get(part, part) for part in file.relative_to(source).parts))
        for file in sorted(source.rglob("*"))
        if file.is_file() and not _LEFT_OUT.intersection(file.parts)
    }
    if directory.exists() and not directory.is_dir():
        raise UsageError(f"{directory} is a file, not a directory")
    taken = [str(target) for target in files.values() if (directory / target).exists()]
    if taken:
        raise UsageError(
            f"nothing was written: {', '.join(taken)} exist{'s' if len(taken) == 1 else ''} already",
            where=directory,
            remedy="Name a new directory, as in: pyfrc init my-robot",
        )
    for file, target in files.items():
        (directory / target).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, directory / target)
    return list(files.values())
