"""The types of parameters that name files, and the check that no command overwrites what it reads.

Every parameter that names a file or directory has one of these types, so the check knows all of them, those of a
wrapped command too.
"""

from __future__ import annotations

import glob
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

if TYPE_CHECKING:
    from pyfrc_core.project import Project

#: Files of a project, beside its Python files, that nothing but an editor changes.
_SETTINGS = {"pyproject.toml", "requirements.txt", "sim/config.json", "sim/dashboards.json"}


class ReadPath(click.Path):
    """A file or directory that the command reads."""

    def __init__(self) -> None:
        super().__init__(path_type=Path)


class WrittenFile(click.Path):
    """A file that the command writes.

    :param is_recording: whether there are a trace and further recordings beside it
    """

    def __init__(self, is_recording: bool = False) -> None:
        super().__init__(path_type=Path)
        self.is_recording = is_recording


class WrittenDirectory(click.Path):
    """A directory into which the command writes."""

    def __init__(self, file_okay: bool = True) -> None:
        super().__init__(path_type=Path, file_okay=file_okay)


class _PathGiven(NamedTuple):
    option: str
    type: object
    path: Path


def check_outputs(context: click.Context, project: Project | None) -> None:
    """Check that the outputs of a command can be written, and that none of them is something that it reads.

    :param context: that of the command; the parameters of the commands around it count, too
    :param project: whose code must not be overwritten
    :raises UsageError: naming the option
    """
    from pyfrc_core.text_files import cannot_write, check_writable

    given = list(_given(context))
    outputs = [each for each in given if isinstance(each.type, WrittenFile | WrittenDirectory)]
    if not outputs:
        return
    read = [file for each in given if isinstance(each.type, ReadPath) for file in _read_with(each.path)]
    code = [] if project is None else list(_code_of(project))
    written: dict[Path, str] = {}
    for option, kind, path in outputs:
        if isinstance(kind, WrittenDirectory):
            check_writable(option, path, is_directory=True)
            if any(_is_same(path, file.parent) for file in code):
                raise cannot_write(option, path, "your robot's code is in it")
            continue
        directory = path.absolute().parent
        if not (directory.exists() or _is_near(directory, project)):
            raise cannot_write(option, path, f"there is no directory {directory}")
        for file in _written_with(path, kind):
            check_writable(option, file)
            if any(_is_same(file, each) for each in read):
                raise cannot_write(option, file, "this command reads it")
            if file.exists() and any(_is_same(file, each) for each in code):
                raise cannot_write(option, file, "it is a file of your robot project")
            other = next((name for each, name in written.items() if _is_same(file, each)), option)
            if other != option:
                raise cannot_write(option, file, f"{other} writes it, too")
            written[file] = option


def _given(context: click.Context | None) -> Iterator[_PathGiven]:
    """Yield the paths on the command line."""
    while context is not None:
        for parameter in context.command.params:
            value = context.params.get(parameter.name or "")
            name = max(parameter.opts, key=len)
            for path in value if isinstance(value, tuple) else (value,):
                if isinstance(path, Path):
                    yield _PathGiven(name, parameter.type, path)
        context = context.parent


def _read_with(file: Path) -> list[Path]:
    """Return a file and what is read with it: a script has a trace, a log of the driver station its events."""
    from pyfrc_core.runtime.scripts.script import script_beside, trace_beside

    if not file.name:  # a directory, such as .
        return [file]
    if (script := script_beside(file)) is not None:
        return [file, script]
    return [file, trace_beside(file)] if file.suffix == ".jsonl" else [file, file.with_suffix(".dsevents")]


def _written_with(file: Path, kind: object) -> list[Path]:
    """Return a file and what is written with it: a recording has a trace, and there may be earlier ones, numbered."""
    from pyfrc_core.runtime.scripts.script import script_beside, trace_beside

    if not (isinstance(kind, WrittenFile) and kind.is_recording):
        return [file]
    numbered = file.parent.glob(f"{glob.escape(file.stem)}-[0-9]*{file.suffix}")
    scripts = [file, *(each for each in sorted(numbered) if script_beside(each) is None)]
    return [*scripts, *map(trace_beside, scripts)]


def _code_of(project: Project) -> Iterator[Path]:
    """Yield what robot, tests and pyfrc read of a project: its Python files, settings, and files for the robot."""
    from pyfrc_core.passes.memory import project_files

    yield project.main_file
    for file in project_files(project):
        below = file.relative_to(project.root).as_posix() if file.is_relative_to(project.root) else file.name
        if file.suffix == ".py" or below in _SETTINGS or below.startswith("deploy/"):
            yield file


def _is_near(directory: Path, project: Project | None) -> bool:
    """Return whether a directory is or would be in the current one or in the project, where outputs make their own."""
    places = (Path.cwd(), *(() if project is None else (project.root,)))
    return any(directory.resolve().is_relative_to(place.resolve()) for place in places)


def _is_same(one: Path, other: Path) -> bool:
    """Return whether two paths are of one file, by links too, or would be, if they do not exist yet."""
    try:
        return one.samefile(other)
    except OSError:
        return one.resolve() == other.resolve()
