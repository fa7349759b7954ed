"""`pyfrc doctor`."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict, replace
from pathlib import Path

import click

from .project_options import project_options
from .robot_options import refuse_option_as_value
from .verbosity import hint, verbosity

_COLOURS = {"ok": "green", "hint": "cyan", "problem": "red"}


@click.command("doctor", context_settings={"help_option_names": ["-h", "--help"]})
@project_options
@click.option(
    "--robot",
    metavar="HOST[:PORT]",
    callback=refuse_option_as_value,
    help="The robot's address, instead of your team's addresses.",
)
@click.option("--team", type=click.IntRange(min=1), metavar="N", help="Your team's number.")
@click.option("--no-robot", is_flag=True, help="Do not look for the robot.")
@click.option("--json", "as_json", is_flag=True, help="For tools: all findings as one JSON object.")
def command(
    directory: Path | None,
    main: Path | None,
    robot_class: str | None,
    robot: str | None,
    team: int | None,
    no_robot: bool,
    as_json: bool,
) -> None:
    """Find out what is missing on this computer or in your project, or does not fit together, and what to do about it.

    A problem keeps something from working. A hint is of what could be there, or does not matter yet. Nothing is
    changed, here or on the robot.

    \b
    Exit codes: 0 there is no problem, 1 there is one, 2 wrong usage.
    """
    if sum((robot is not None, team is not None, no_robot)) > 1:
        raise click.UsageError("Only one of --robot, --team and --no-robot can be.")
    # With `python -m pyfrc`, Python looks for modules here first: those of the project are not to be in our way.
    sys.path[:] = [place for place in sys.path if place and Path(place) != Path.cwd()]
    from pyfrc_core.deploy.robot_commands import naming_robot
    from pyfrc_core.doctor import Examination, examine
    from pyfrc_core.wording import counted

    findings = []
    for finding in examine(Examination(directory, main, robot_class, not no_robot, robot, team)):
        finding = replace(finding, remedy=finding.remedy and naming_robot(finding.remedy, robot, team))
        findings.append(finding)
        if not as_json and (finding.status == "problem" or not verbosity().quiet):
            click.secho(f"{finding.status:<8}", fg=_COLOURS[finding.status], nl=False)
            click.echo(f"{finding.topic}: {finding.text}")
            if finding.remedy:
                click.echo(f"{'':<8}  {finding.remedy}")
    problems = sum(finding.status == "problem" for finding in findings)
    if as_json:
        click.echo(json.dumps({"problems": problems, "findings": [asdict(each) for each in findings]}, indent=2))
    else:
        hint(f"\n{counted(problems, 'problem')}" if problems else "\nno problems")
    sys.exit(1 if problems else 0)
