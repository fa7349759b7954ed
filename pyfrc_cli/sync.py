"""The command `pyfrc sync`."""

from __future__ import annotations

import sys
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .project_options import chosen_project, project_option
from .verbosity import hint, verbosity

if TYPE_CHECKING:
    from pyfrc_core.sync.lock import LockedFile
    from pyfrc_core.sync.synchronize import Synced


@click.command("sync")
@project_option
@click.option("--check", is_flag=True, help="Change nothing: only report what is missing or different.")
@click.option("--upgrade", is_flag=True, help="Find new versions, and write pyfrc-lock.toml anew.")
@click.option("--install/--no-install", help="Install the same versions on this computer, too.  [default: no-install]")
@click.option(
    "--find-links",
    metavar="PLACE",
    multiple=True,
    help="Look for packages there, too: a directory or a web page, as for pip; may be repeated.",
)
@click.option(
    "--use-certifi",
    is_flag=True,
    help="If downloads fail because of certificates: trust those of the package certifi, instead of this computer's.",
)
def command(
    directory: Path | None,
    check: bool,
    upgrade: bool,
    install: bool,
    find_links: tuple[str, ...],
    use_certifi: bool,
) -> None:
    """Download what the robot needs, while there is internet: its Python, and the packages of [tool.robotpy].

    The files are in the season's cache, ~/wpilib/YEAR/robotpy, and their versions and hashes in pyfrc-lock.toml, beside
    pyproject.toml. If that file exists, exactly what it names is downloaded; commit it to Git. The next deploy
    brings the files to the robot.

    \b
    Exit codes: 0 everything is here, 1 something is missing or, with --check, different; 2 wrong usage or settings.
    """
    if check and (upgrade or install or find_links):
        raise click.UsageError("--check changes nothing: it takes none of the other options.")
    from pyfrc_core.season import CURRENT, installed_wpilib
    from pyfrc_core.sync.synchronize import SyncOptions, differences, synchronize

    project = chosen_project(directory)
    if check:
        found = list(differences(project, CURRENT, installed_wpilib()))
        for each in found:
            click.echo(each)
        hint("\nTo get it: pyfrc sync" if found else "nothing is missing")
        sys.exit(1 if found else 0)
    options = SyncOptions(upgrade, find_links, use_certifi)
    with _Progress() as progress:
        synced = synchronize(project, CURRENT, installed_wpilib(), options, progress)
    _report(synced)
    if install:
        from pyfrc_core.sync.install import install_here

        install_here(synced.lock, CURRENT, find_links, verbosity().quiet)
    else:
        _compare_with_here(synced)


def _report(synced: Synced) -> None:
    from pyfrc_core.season import CURRENT
    from pyfrc_core.sync import LOCK_FILE, cache_of
    from pyfrc_core.sync.lock import changes
    from pyfrc_core.wording import counted, size_text

    lock, previous = synced.lock, synced.previous
    for index in dict.fromkeys(each.index for each in lock.packages):
        names = [each.name for each in lock.packages if each.index == index]
        what = ", ".join(names) if len(names) <= 3 else counted(len(names), "package")
        hint(f"index     {index or 'none, but a directory'}: {what}")
    if previous is None:
        hint(f"lock      {LOCK_FILE} is new: {counted(len(lock.packages), 'package')}. Commit it.")
    elif lock == previous:
        hint(f"lock      {LOCK_FILE}: unchanged")
    else:
        hint(f"lock      {LOCK_FILE} has changed. Commit it.")
        for change in changes(previous, lock):
            hint(f"  {change}")
    size = size_text(sum(each.size for each in lock.files))
    hint(f"For the {lock.controller}: {counted(len(lock.files), 'file')}, {size}, in {cache_of(CURRENT).root}")


def _compare_with_here(synced: Synced) -> None:
    from pyfrc_core.season import CURRENT
    from pyfrc_core.sync.install import different_here, missing_here

    for says, found in (
        ("has", list(different_here(synced.lock))),
        ("does not have", list(missing_here(synced.lock, CURRENT))),
    ):
        if found:
            more = f" and {len(found) - 3} more" if len(found) > 3 else ""
            hint(f"This computer {says} {', '.join(found[:3])}{more}. For the same here: pyfrc sync --install")


class _Progress:
    """A line for each file; on a terminal, also what is being done."""

    def __init__(self) -> None:
        self._stack = ExitStack()
        self._began = time.monotonic()
        self._notes: list[str] = []

    def __enter__(self) -> _Progress:
        self._quiet = verbosity().quiet
        self._bars = None
        if sys.stdout.isatty() and not self._quiet:
            from rich.progress import BarColumn, DownloadColumn, Progress, TextColumn, TransferSpeedColumn

            columns = (TextColumn("{task.description}"), BarColumn(), DownloadColumn(), TransferSpeedColumn())
            self._bars = self._stack.enter_context(Progress(*columns, transient=True))
            self._task = self._bars.add_task("", total=None, visible=False)
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()
        for text in self._notes:
            hint(f"note      {text}")

    def waiting(self) -> None:
        hint("Another pyfrc sync is running: waiting until it has ended.")

    def finding(self, package: str) -> None:
        if self._bars is not None:
            self._bars.update(self._task, description=f"find      {package}", total=None, completed=0, visible=True)

    def note(self, text: str) -> None:
        self._notes.append(text)

    def received(self, what: str, there: int, total: int | None) -> None:
        if self._bars is not None:
            self._bars.update(self._task, description=f"get       {what}", total=total, completed=there, visible=True)

    def got(self, locked: LockedFile, how: str, url: str | None = None) -> None:
        from pyfrc_core.wording import size_text

        line = f"get       {locked!s:<40} {size_text(locked.size):>9}  {how}"
        if verbosity().verbose and url is not None:
            line += f" from {url}"
        if self._bars is not None:
            self._bars.console.print(line, markup=False, highlight=False)
        else:
            hint(line)
