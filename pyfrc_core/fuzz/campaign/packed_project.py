"""The files of a robot project that a match needs, to run it on another computer."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath

from ...log_formats import FOREIGN_LOGS, LOGS
from ...passes.memory import project_files
from ...project import Project

#: `.rrd`: recordings of Rerun.
_LOGS = (*LOGS, *FOREIGN_LOGS, ".rrd")


@dataclass(frozen=True)
class PackedProject:
    """A project with the content of its files.

    :param project: with the paths of the computer on which it was packed
    :param files: each file's content, by its path relative to the project's root
    """

    project: Project
    files: dict[str, bytes]

    def unpack(self, directory: Path) -> Project:
        """Write the files below an empty directory, and return the project there."""
        # Tests and settings may be beside the project's root, or above it.
        above = max((PurePosixPath(name).parts.count("..") for name in self.files), default=0)
        root = directory.resolve().joinpath(*["above"] * above, self.project.root.name or "robot")
        root.mkdir(parents=True)
        for name, content in self.files.items():
            file = Path(os.path.normpath(root / name))
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
        settings = self.project.settings_file
        if settings is not None:
            settings = Path(os.path.normpath(root / os.path.relpath(settings, self.project.root)))
        return replace(self.project, main_file=root / self.project.main_file.name, settings_file=settings)


def pack(project: Project) -> PackedProject:
    """Read the files of a project that its matches may need: logs, hidden files and environments are left out."""
    files = {}
    for file in {*project_files(project), project.main_file}:
        name = Path(os.path.relpath(file, project.root)).as_posix()
        is_hidden = any(part.startswith(".") for part in name.split("/") if part != "..")
        if not is_hidden and file.suffix.lower() not in _LOGS and file.is_file() and os.access(file, os.R_OK):
            files[name] = file.read_bytes()
    return PackedProject(replace(project), dict(sorted(files.items())))
