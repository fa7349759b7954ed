"""The command `pyfrc migrate`."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .project_options import project_option
from .verbosity import hint, verbosity

if TYPE_CHECKING:
    from pyfrc_core.migrate.migration import Migration
    from pyfrc_core.migrate.report import Remark


@click.command("migrate")
@project_option
@click.option("--check", is_flag=True, help="Write nothing: report what would change, and what you must do.")
@click.option("--uncommitted", is_flag=True, help="Go on although Git has changes that are in no commit.")
@click.option("--json", "as_json", is_flag=True, help="For tools: print the report as one JSON object.")
def command(directory: Path | None, check: bool, uncommitted: bool, as_json: bool) -> None:
    """Rewrite a robot project of 2026 for WPILib 2027.

    In all its Python files, pyproject.toml, requirements.txt and GitHub's workflows, it changes names, imports, and
    calls that mean something else now. Names of your own stay. What has to be done by hand is reported with its line
    and what to do. A second run changes nothing.

    \b
    Exit codes: 0 nothing is left to do by hand (with --check: and nothing would change), 1 something is,
    2 wrong usage, or Git has changes that are in no commit.
    """
    from pyfrc_core.migrate import need_libcst

    need_libcst()
    from pyfrc_core.migrate.migration import migrate, refuse_uncommitted
    from pyfrc_core.project import find_project

    project = find_project(directory)
    root = project.pyproject.parent if project.pyproject.is_file() else project.root
    if not (check or uncommitted):
        refuse_uncommitted(root)
    progress = _show_progress if _on_terminal(as_json) else _no_progress
    done = migrate(root, code=project.root, progress=progress)
    if not check:
        done.write()
    if as_json:
        click.echo(json.dumps(_as_json(done), indent=2))
    else:
        _print(done, written=not check)
    sys.exit(1 if done.report.by_hand() or (check and done.after) else 0)


def _print(done: Migration, written: bool) -> None:
    from pyfrc_core.wording import counted

    count, lines = len(done.after), done.report.counts()
    by_hand, to_check = done.report.by_hand(), done.report.to_check()
    hint(f"{'Rewrote' if written else 'Would rewrite'} {counted(count, 'file')} (Python files: {done.files}).")
    if to_check:
        hint(f"\nTo look at ({len(to_check)}; rewritten, or with another meaning in 2027):", bold=True)
        for remark in to_check:
            hint(_text(remark))
    if by_hand:
        click.secho(f"\nTo do by hand ({len(by_hand)}; the lines are those before the rewriting):", bold=True)
        for remark in by_hand:
            click.echo(_text(remark))
    elif count:
        hint("\nNothing is left to do by hand. Run the tests with 2027: pyfrc test")
    if count or by_hand:
        hint(
            f"\nLines changed: {lines['changed']}, of which {lines['sure']} have no remark. "
            f"Lines to do by hand: {lines['by_hand']}."
        )


def _text(remark: Remark) -> str:
    """Return a remark with its places: one on the same line, more than one below."""
    first, *others = str(remark).splitlines()
    lines = [f"  {first}", *(f"      {each}" for each in others)]
    if len(remark.places) > 1:
        lines.append(f"      {len(remark.places)} lines: {', '.join(map(str, remark.places))}")
    return "\n".join(lines)


def _as_json(done: Migration) -> dict[str, object]:
    return {
        "files": sorted(done.after),
        "by_hand": [asdict(each) for each in done.report.by_hand()],
        "to_check": [asdict(each) for each in done.report.to_check()],
        "lines": done.report.counts(),
    }


def _on_terminal(as_json: bool) -> bool:
    return sys.stderr.isatty() and not as_json and not verbosity().quiet


def _no_progress(doing: str, done: int, of: int) -> None:
    """Show nothing."""


def _show_progress(doing: str, done: int, of: int) -> None:
    click.echo(f"\r\033[K{doing} {done}/{of}" if done < of else "\r\033[K", nl=False, err=True)
