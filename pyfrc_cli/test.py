"""The command `pyfrc test`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Literal

import click

from pyfrc_core.processes.loading import loading

from .file_options import WrittenDirectory, WrittenFile
from .project_options import chosen_project, project_options
from .shared_options import TRACE, builtin_option, fail_under_option, isolation_option
from .verbosity import verbosity


def _jobs(ctx: click.Context, param: click.Parameter, value: str | None) -> int | Literal["auto"] | None:
    """Parse a number of processes, or ``auto``."""
    if value is None or value == "auto":
        return value  # type: ignore[return-value]
    if not value.isdecimal() or int(value) < 1:
        raise click.BadParameter(f"{value!r} is neither a number of processes, 1 or more, nor 'auto'.", ctx, param)
    return int(value)


@click.command("test")
@project_options
@builtin_option
@click.option(
    "-j",
    "--jobs",
    callback=_jobs,
    metavar="N",
    help="How many tests run at the same time. Default: auto, one for each processor core (one more with phoenix6).",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    metavar="N",
    help="Random seed: the same number gives the same random numbers. Default: 0.",
)
@isolation_option("test with the robot", "none", note=" none: pyfrc's own, for all of them, for a debugger.")
@click.option("--no-isolation", is_flag=True, help="The same as --isolation none.")
@click.option("--coverage", is_flag=True, help="Measure which lines of the project the tests run, and report them.")
@click.option(
    "--coverage-html",
    metavar="DIR",
    type=WrittenDirectory(),
    help="Also write the report as web pages.",
)
@click.option(
    "--coverage-xml",
    metavar="FILE",
    type=WrittenFile(),
    help="Also write the report as XML, for programs that show coverage, such as GitLab or Jenkins.",
)
@fail_under_option
@click.option(
    "--trace",
    metavar="DIR",
    type=WrittenDirectory(),
    help=f"Write a trace of the robot in each test: {TRACE}",
)
@click.option(
    "--record",
    metavar="DIR",
    type=WrittenDirectory(),
    help="Record the robot's inputs in each test, for pyfrc replay.",
)
@click.option(
    "--changed", is_flag=True, help="Run only the tests that can depend on what has changed since they passed."
)
@click.argument("pytest_args", nargs=-1, type=click.UNPROCESSED)
def command(
    directory: Path | None,
    main: Path | None,
    robot_class: str | None,
    builtin: bool,
    jobs: int | Literal["auto"] | None,
    seed: int | None,
    isolation: Literal["auto", "fork", "reuse", "none"] | None,
    no_isolation: bool,
    coverage: bool,
    coverage_html: Path | None,
    coverage_xml: Path | None,
    fail_under: float | None,
    trace: Path | None,
    record: Path | None,
    changed: bool,
    pytest_args: tuple[str, ...],
) -> None:
    """Run the robot project's tests, found in its directory tests/ or in ../tests.

    Anything after -- is passed on to pytest, for example: pyfrc test -- -x -k drive, which runs the tests with drive in
    their names, and stops at the first failure. So are -v and -q.

    \b
    Exit codes: 0 all passed, 1 a test failed or the robot's code did,
    2 wrong usage, 4 pytest's usage error, 5 no test was selected.
    """
    if no_isolation and isolation not in (None, "none"):
        raise click.UsageError(f"--no-isolation and --isolation {isolation} are mutually exclusive.")
    if changed and (coverage or coverage_html or coverage_xml or fail_under is not None):
        raise click.UsageError("--changed and --coverage are mutually exclusive: tests that are not run cover nothing.")
    project = chosen_project(directory, main, robot_class)
    chosen = verbosity()
    pytest_verbosity = ["-q"] * chosen.quiet + ["-v"] * chosen.verbose
    from pyfrc_core.measure.coverage import CoverageOptions, measuring

    coverage_options = CoverageOptions(
        # The options for reports imply --coverage.
        enabled=coverage or bool(coverage_html or coverage_xml) or fail_under is not None,
        html=coverage_html,
        xml=coverage_xml,
        fail_under=fail_under,
        quiet=chosen.quiet,
    )
    with measuring(project, coverage_options) as measured:
        from pyfrc_core.test_support.options import TestOptions

        options = TestOptions.combined(
            project.settings.test,
            seed=seed,
            jobs=jobs,
            isolation="none" if no_isolation else isolation,
            trace_directory=trace,
            record_directory=record,
            only_changed=changed,
        )
        from pyfrc_core.test_support.isolation.interpreters import opened_interpreters

        with opened_interpreters(project, options) as interpreters:
            # Imported here, so that lines of the robot's modules are counted while they are imported.
            with loading(verbosity().quiet):
                from pyfrc_core.test_support.run_tests import run_tests

            arguments = [*pytest_verbosity, *pytest_args]
            status = run_tests(project, options, builtin=builtin, pytest_args=arguments, interpreters=interpreters)
    sys.exit(status or measured.status)
