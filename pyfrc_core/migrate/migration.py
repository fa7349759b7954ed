"""Migrate a project: read its files, rewrite them in memory, and replace them all at the end."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import NamedTemporaryFile

from ..config.robotpy import load_robot_packages
from ..errors import UsageError
from ..project import walk
from ..project.git import git_output
from ..season.names.table import table
from ..season.season_2027 import SEASON_2027
from .deep import with_deep_stack
from .project import Progress, Source, rewrite_all
from .report import Report
from .settings import Settings

_GIT_SECONDS = 60


@dataclass(frozen=True)
class Migration:
    """What a migration changes.

    :param before: the old content of each file that changes, by its name; a new file has none
    :param after: the new content
    :param files: how many files were read
    """

    root: Path
    before: Mapping[str, bytes]
    after: Mapping[str, bytes]
    report: Report
    files: int

    def write(self) -> None:
        """Replace the files, after all of them have been written beside the old ones.

        :raises OSError: when one cannot be written; then no file has changed
        """
        written: list[tuple[Path, Path]] = []
        try:
            for name, content in self.after.items():
                file = self.root / name
                with NamedTemporaryFile("wb", dir=file.parent, prefix=f".{file.name}-", delete=False) as beside:
                    written.append((Path(beside.name), file))
                    beside.write(content)
                if file.exists():
                    shutil.copymode(file, beside.name)
                else:
                    Path(beside.name).chmod(0o644)
            for new, file in written:
                new.replace(file)
        finally:
            for new, _ in written:
                new.unlink(missing_ok=True)


def migrate(
    root: Path,
    *,
    code: Path | None = None,
    progress: Progress = lambda doing, done, of: None,
) -> Migration:
    """Return what a project of 2026 becomes in 2027. Nothing is written.

    :param code: where robot.py is, if it is in a directory of its own
    :param progress: called with what is done, how many files of it, and of how many
    :raises UsageError: when pyproject.toml is wrong
    """
    report = Report()
    names = table()
    version = load_robot_packages(root / "pyproject.toml").version
    first_time = version is None or not version.startswith("2027")
    sources = []
    files, links = python_files(root)
    for file in files:
        name, wrong = file.relative_to(root).as_posix(), walk.why_unreadable(file)
        if wrong is None:
            sources.append(Source(file, name, file.read_bytes()))
        else:
            what = f"{wrong.message[0].upper()}{wrong.message[1:]}. The file stays as it is."
            report.add(name, wrong.line or 0, what, wrong.remedy or "")
    for link in links:
        what = (
            f"This is a link to {link.readlink().as_posix()}, which is not followed, so the code there stays as it is."
        )
        report.add(link.relative_to(root).as_posix(), 0, what, "Replace the link by what it leads to, and migrate.")
    for file in walk.files_below(root, hidden=False):
        if file.suffix == ".ipynb" and file.is_file() and b"wpilib" in file.read_bytes():
            what = "This is a notebook, which is not rewritten."
            report.add(file.relative_to(root).as_posix(), 0, what, "Change its names by hand.")
    home = "" if code is None or code == root else code.relative_to(root).as_posix() + "/"
    rewritten = with_deep_stack(
        lambda: rewrite_all(sources, names, report, home=home, first_time=first_time, progress=progress)
    )
    after = dict(rewritten.files)
    before = {each.name: each.text for each in sources if each.name in after}
    python = [after.get(each.name, each.text) for each in sources]
    settings = Settings(
        SEASON_2027.packages.wpilib,
        names.corrections,
        report,
        drivers=any(b"wpilib_drivers" in text for text in python),
        gamepads=rewritten.gamepads,
    )
    for name, old, new in _settings_files(root, settings, (code or root) if first_time else None):
        if new != old:
            after[name] = new.encode(errors="surrogateescape")
            if old:
                before[name] = old.encode(errors="surrogateescape")
    return Migration(root, before, after, report, len(sources))


def python_files(root: Path) -> tuple[list[Path], list[Path]]:
    """Return the Python files of a project, without those of virtual environments and hidden directories.

    :returns: the files, with what only has the name of one; and the links to code outside the project
    """
    found, links = [], set()
    for file in walk.python_files(root):
        link = next((each for each in (file, *file.parents) if each != root and each.is_symlink()), None)
        if link is None or not link.is_relative_to(root) or not link.exists():
            found.append(file)
        elif not link.resolve().is_relative_to(root.resolve()):
            links.add(link)
    return found, sorted(links)


def refuse_uncommitted(root: Path) -> None:
    """Refuse a Git checkout with changes that are in no commit.

    :raises UsageError: with what to do
    """
    status = git_output(root, "status", "--porcelain", "--", ".", seconds=_GIT_SECONDS)
    changed = [line[3:] for line in (status or "").splitlines()]
    if changed:
        more = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        raise UsageError(
            f"{changed[0]}{more}: changed, and in no commit",
            remedy="Commit first, so that you can look at what migrate changes and go back; or add --uncommitted.",
        )


def _settings_files(root: Path, settings: Settings, code: Path | None) -> Iterator[tuple[str, str, str]]:
    """Return the name, old and new text of each settings file.

    :param code: where robot.py is, while buttons count from 1
    """
    if code is not None:
        config = code / "sim" / "config.json"
        old = _text(config)
        yield config.relative_to(root).as_posix(), old, settings.labels(old)
    old = _text(root / "pyproject.toml")
    yield "pyproject.toml", old, settings.pyproject("pyproject.toml", old)
    for file in sorted(root.glob("*requirements*.txt")):
        old = _text(file)
        yield file.name, old, settings.requirements(file.name, old)
    for file in sorted((root / ".github" / "workflows").glob("*.y*ml")):
        old, name = _text(file), file.relative_to(root).as_posix()
        yield name, old, settings.workflow(name, old)


def _text(file: Path) -> str:
    return file.read_bytes().decode(errors="surrogateescape") if file.is_file() else ""
