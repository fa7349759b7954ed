"""The command `pyfrc fuzz`."""

from __future__ import annotations

import os
import sys
import time
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from pyfrc_core._version import requirement
from pyfrc_core.processes.loading import loading
from pyfrc_core.wording import counted

from .file_options import ReadPath, WrittenDirectory
from .project_options import chosen_project, from_here, project_options
from .shared_options import isolation_option
from .verbosity import hint, verbosity

if TYPE_CHECKING:
    from pyfrc_core.fuzz.campaign.executors import WorkExecutor
    from pyfrc_core.fuzz.campaign.results import Campaign, CampaignProgress, FuzzFinding
    from pyfrc_core.fuzz.oracle.failure import FuzzFailure
    from pyfrc_core.project import Project

_DEFAULT_SECONDS = 60.0
#: From this many matches on, a campaign that has found nothing says something.
_FEW = 100

#: Seconds between two progress lines, on a terminal and elsewhere.
_ON_TERMINAL, _ELSEWHERE = 0.2, 10.0


@click.command("fuzz")
@project_options
@click.option(
    "--time",
    "seconds",
    type=click.FloatRange(min=0, min_open=True),
    metavar="SECONDS",
    help=f"End after about this time. Default: {_DEFAULT_SECONDS:g}.",
)
@click.option("--runs", type=click.IntRange(min=1), metavar="N", help="Play this many matches, instead of --time.")
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    metavar="N",
    help="Random seed: with --runs, the same seed repeats the same campaign. Default: 0. Without --seed and --runs, a"
    " campaign goes on where the last one ended.",
)
@click.option(
    "--continue",
    "resume",
    is_flag=True,
    help="Go on where the last campaign with this seed ended; its matches count in --runs.",
)
@click.option(
    "--shard",
    metavar="I/N",
    callback=lambda context, option, value: _parse_shard(value),
    help="Share a campaign among N computers: play only the matches of computer number I. All take the same --seed and "
    "--runs.",
)
@click.option(
    "--merge", is_flag=True, help="Play nothing: copy what computers with --shard have saved, from DIRECTORIES."
)
@click.argument("directories", nargs=-1, type=ReadPath())
@click.option(
    "-j",
    "--jobs",
    type=click.IntRange(min=1),
    metavar="N",
    help="How many matches run at the same time. Default: one for each processor core.",
)
@isolation_option("match")
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Play on other computers, instead of with -j: those of a cluster of Dask, a library for such, with this "
    f'scheduler, such as tcp://10.0.0.5:8786. Needs: pip install "{requirement("cluster")}"',
)
@click.option(
    "--from",
    "recorded",
    metavar="LOG",
    multiple=True,
    type=ReadPath(),
    help="Begin with a recorded match: a data log (.wpilog), or a recording (.jsonl). May be repeated.",
)
@click.option(
    "--pages",
    metavar="DIRECTORY",
    type=WrittenDirectory(),
    help="Write each failure's run as a page, DIRECTORY/NAME.html, for any browser.",
)
def command(
    directory: Path | None,
    main: Path | None,
    robot_class: str | None,
    seconds: float | None,
    runs: int | None,
    seed: int | None,
    resume: bool,
    shard: tuple[int, int],
    merge: bool,
    directories: tuple[Path, ...],
    jobs: int | None,
    isolation: str | None,
    scheduler: str | None,
    recorded: tuple[Path, ...],
    pages: Path | None,
) -> None:
    """Play many matches with random inputs (a campaign), and save the shortest script of each failure.

    A script is a list of inputs. It is saved as tests/fuzz/NAME.jsonl, for pyfrc replay;
    tests/test_fuzz_regressions.py fails until the robot is repaired.

    \b
    Exit codes: 0 nothing was found; 1 a failure was found, or an earlier one is still there; 2 wrong usage or no such
    project; 130 ended by Ctrl-C.
    """
    if seconds is not None and runs is not None:
        raise click.UsageError("--time and --runs are mutually exclusive.")
    if scheduler is not None and jobs is not None:
        raise click.UsageError("--scheduler and -j are mutually exclusive.")
    if resume and recorded:
        raise click.UsageError("--continue and --from are mutually exclusive.")
    if pages is not None and merge:
        raise click.UsageError("--pages and --merge are mutually exclusive.")
    if merge and not directories:
        raise click.UsageError("--merge and DIRECTORIES belong together.")
    if directories and not merge:
        plural = "s" if len(directories) > 1 else ""
        raise click.UsageError(f"Got unexpected extra argument{plural} ({' '.join(map(str, directories))})")
    for each in directories:
        if not each.is_dir():
            raise click.BadParameter(f"there is no directory {each}", param_hint="DIRECTORIES")
    project = replace(chosen_project(directory, main, robot_class), chosen_isolation=isolation)
    with loading(verbosity().quiet):
        from pyfrc_core.compat.unrepeatable import explain_unrepeatable
        from pyfrc_core.fuzz.campaign.campaign import run_campaign
        from pyfrc_core.fuzz.campaign.results import CampaignOptions, Shard
        from pyfrc_core.processors import usable_processors
        from pyfrc_core.runtime.scripts.inputs_file import load_inputs, remarks
    if merge:
        _merge(project, directories)
        return
    resume = resume or (seed is None and runs is None and not recorded)
    if seconds is None and runs is None:
        seconds = _DEFAULT_SECONDS
    printer = _ProgressPrinter(verbosity().quiet, project)
    scripts = tuple(load_inputs(file) for file in recorded)
    for remark in (each for script in scripts for each in remarks(script)):
        click.echo(remark)
    jobs = jobs or usable_processors()
    options = CampaignOptions(seed or 0, runs, seconds, jobs, scripts, Shard(*shard), resume)
    campaign = run_campaign(_open_executor(project, jobs, scheduler), options, printer)
    printer.end(campaign.progress)
    if seconds is not None and campaign.progress.cost is not None:
        length = project.settings.fuzz.match_seconds
        hint(f"A match of {length:g} s takes about {length * campaign.progress.cost:.1f} s here.")
    if pages is not None:
        _write_pages(project, campaign, pages)
    for text in campaign.hints.texts():
        hint(f"hint: {text}")
    if campaign.unrepeatable:
        hint(explain_unrepeatable(campaign.unrepeatable))
    if campaign.problem:
        click.echo(f"The scripts are in a temporary directory: copy them. {campaign.problem}", err=True)
    if campaign.always_fails:
        starts = f"each of {campaign.always_fails} starts"
        click.echo(f"The robot failed in the same way at {starts}: the campaign ends until this is repaired.")
    if campaign.interrupted:
        click.echo("interrupted")
    if not campaign.findings:
        hint("No failure that repeats was found." if campaign.hints.unsteady else "Nothing was found.")
        if campaign.progress.matches < _FEW and not campaign.interrupted:
            played = counted(campaign.progress.matches, "match proves", "matches prove")
            hint(f"But {played} little: pyfrc fuzz --time 600 plays for ten minutes.")
    sys.exit(1 if campaign.findings else 0)


def _open_executor(project: Project, jobs: int, scheduler: str | None) -> AbstractContextManager[WorkExecutor]:
    if scheduler is None:
        from pyfrc_core.fuzz.campaign.executors import open_match_executor

        return open_match_executor(project, jobs)
    from pyfrc_core.fuzz.campaign.cluster import open_cluster_executor

    return open_cluster_executor(project, scheduler)


def _write_pages(project: Project, campaign: Campaign, pages: Path) -> None:
    from pyfrc_core.sim.page_file import write_finding_page

    for found in campaign.findings:
        page = pages / f"{found.entry.file.stem}.html"
        write_finding_page(project, found, page)
        hint(f"wrote {page}")


def _parse_shard(text: str | None) -> tuple[int, int]:
    """Return the number of a shard, from 1, and the number of shards."""
    if text is None:
        return 1, 1
    number, slash, count = text.partition("/")
    if not (slash and number.isdecimal() and count.isdecimal() and 1 <= int(number) <= int(count)):
        raise click.BadParameter(f"{text!r} is not I/N with I from 1 to N, such as 1/4.")
    return int(number), int(count)


def _merge(project: Project, directories: tuple[Path, ...]) -> None:
    from pyfrc_core.fuzz.campaign.corpus import Corpus

    entries = Corpus(project).merge(directories)
    for entry in entries:
        click.secho(str(entry.script.found.get("failure", "")), fg="red")
        click.echo(f"  pyfrc replay {entry.display_path}")
    if not entries:
        hint("Nothing was found.")
    sys.exit(1 if entries else 0)


class _ProgressPrinter:
    """Prints the progress: on a terminal in one line that is rewritten, elsewhere in a new line now and then."""

    def __init__(self, quiet: bool, project: Project) -> None:
        self._quiet = quiet
        self._project = project
        self._on_terminal = sys.stdout.isatty() and not quiet
        self._printed = time.monotonic()

    def on_progress(self, progress: CampaignProgress) -> None:
        now = time.monotonic()
        if self._quiet or now - self._printed < (_ON_TERMINAL if self._on_terminal else _ELSEWHERE):
            return
        self._printed = now
        if self._on_terminal:
            click.echo(f"\r\033[K{_line(progress)}", nl=False)
        else:
            click.echo(_line(progress))

    def on_seen(self, failure: FuzzFailure) -> None:
        self._clear()
        hint(f"found {failure.text.partition(chr(10))[0]}")

    def on_found(self, found: FuzzFinding) -> None:
        self._clear()
        click.secho(found.failure.text, fg="red")
        if found.known:
            click.echo(f"  still fails: {found.entry.display_path}")
        else:
            for line in found.story[:-1]:
                click.echo(f"  {line}")
            if found.fails_at is not None:
                click.echo(f"  fails at {found.fails_at:.2f} s")
            if found.repeats:
                hint(f"  {counted(found.writes, 'write')}, {counted(found.runs, 'run')} of the robot to find them")
            else:
                click.echo("  This failure did not repeat in a replay. The script of the whole match is saved:")
            click.echo(f"  pyfrc replay {found.entry.display_path}")
        if os.environ.get("GITHUB_ACTIONS") == "true":
            click.echo(_annotation(found, self._project.main_file.parent))

    def end(self, progress: CampaignProgress) -> None:
        self._clear()
        progress.doing = ""
        hint(_line(progress))

    def _clear(self) -> None:
        if self._on_terminal:
            click.echo("\r\033[K", nl=False)


def _annotation(found: FuzzFinding, root: Path) -> str:
    """Return GitHub's workflow command that shows a failure at the user's line."""
    file, colon, line = found.failure.place.rpartition(":")
    where = ""
    if colon:
        path = from_here(root / file, os.environ.get("GITHUB_WORKSPACE") or ".")
        where = f"file={_escaped(path, in_property=True)},line={line},"
    story = "\n".join([*found.story, f"pyfrc replay {found.entry.display_path}"])
    return f"::error {where}title=pyfrc fuzz::{_escaped(story)}"


def _escaped(text: str, in_property: bool = False) -> str:
    text = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    return text.replace(":", "%3A").replace(",", "%2C") if in_property else text


def _line(progress: CampaignProgress) -> str:
    parts = [
        counted(progress.matches, "match", "matches"),
        f"{progress.simulated / 3600:.2f} h of robot time",
        *([] if progress.covered is None else [f"{progress.covered:.0%} of the robot's lines"]),
        counted(progress.crashes, "failure"),
    ]
    return ", ".join([*parts, *([progress.doing] if progress.doing else [])])
