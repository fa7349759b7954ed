"""`pyfrc doctor`."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict, replace
from pathlib import Path
from textwrap import indent

import click

from .project_options import project_options
from .robot_options import robot_option
from .shared_options import team_option
from .verbosity import hint, verbosity

#: In the order in which they are shown.
_COLOURS = {"problem": "red", "hint": "cyan", "ok": "green"}


@click.command("doctor")
@project_options
@robot_option
@team_option
@click.option("--no-robot", is_flag=True, help="Do not check the robot.")
@click.option("--json", "as_json", is_flag=True, help="For tools: print all results as one JSON object.")
def command(
    directory: Path | None,
    main: Path | None,
    robot_class: str | None,
    robot: str | None,
    team: int | None,
    no_robot: bool,
    as_json: bool,
) -> None:
    """Check this computer, your project and the robot for problems, and show how to solve them.

    A problem prevents something from working, and is shown first. A hint is optional, or not important yet. The last
    result is the next step from a new robot to a driving one. Nothing is changed, on this computer or on the robot.

    \b
    Exit codes: 0 no problems, 1 problems found, 2 wrong usage.
    """
    if sum((robot is not None, team is not None, no_robot)) > 1:
        raise click.UsageError("--robot, --team and --no-robot are mutually exclusive.")
    # With `python -m pyfrc`, the current directory is first on the path, where the project may hide libraries.
    sys.path[:] = [place for place in sys.path if place and Path(place) != Path.cwd()]
    from pyfrc_core.deploy.progress import with_robot_option
    from pyfrc_core.doctor import NEXT_STEP, DoctorOptions, examine
    from pyfrc_core.wording import counted

    findings = [
        replace(each, remedy=each.remedy and with_robot_option(each.remedy, robot, team))
        for each in examine(DoctorOptions(directory, main, robot_class, not no_robot, robot, team))
    ]
    for finding in sorted(findings, key=lambda each: (each.topic == NEXT_STEP, tuple(_COLOURS).index(each.status))):
        if not as_json and (finding.status == "problem" or not verbosity().quiet):
            click.secho(f"{finding.status:<8}", fg=_COLOURS[finding.status], nl=False)
            click.echo(f"{finding.topic}: {finding.text}")
            if finding.remedy:
                click.echo(indent(finding.remedy.replace("\n  ", "\n"), " " * 10))
    problems = sum(finding.status == "problem" for finding in findings)
    if as_json:
        click.echo(json.dumps({"problems": problems, "findings": [asdict(each) for each in findings]}, indent=2))
    else:
        hint(f"\n{counted(problems, 'problem')}" if problems else "\nno problems")
    sys.exit(1 if problems else 0)
