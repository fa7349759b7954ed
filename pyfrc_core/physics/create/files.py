"""Write ``physics.py`` and ``sim/config.json`` for a robot, unless they exist."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from ...config.sim import sim_config_schema
from ...config.sim_file import SIM_CONFIG
from ...errors import PyfrcError, UsageError
from ...processes.call import run_in_subprocess
from ...project import Project
from ...text_files import write_whole
from .proposal import SCHEMA_NAME, propose
from .try_tests import Failures, failures_with

#: Where a ``physics.py`` is kept with which tests fail.
PROPOSAL = Path(".pyfrc", "create-physics", "physics.py")


@dataclass
class Created:
    """Result of `create_physics`; files are absolute.

    :param written: the files that were written
    :param unchanged: the files that existed
    :param recognised: lines about the drivetrain, encoders and gyros; empty when the robot was not started
    :param notes: sentences about assumptions and remaining work
    :param problem: why the robot could not be driven, with the user's line
    :param failures: the project's tests that fail with the proposed ``physics.py``, which is not written if there are
        new ones; None if no tests were run
    :param proposal: where the text is kept then
    """

    written: list[Path] = field(default_factory=list)
    unchanged: list[Path] = field(default_factory=list)
    recognised: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    problem: str | None = None
    failures: Failures | None = None
    proposal: Path | None = None


def create_physics(project: Project) -> Created:
    """Write ``physics.py`` and ``sim/config.json`` unless they exist; for that, start the robot program.

    ``physics.py`` is put in place only if no test of the project fails because of it.

    :raises RobotCodeError: when the robot's code fails before it can be driven, or ends its process; then nothing is
        written
    :raises UsageError: when a file or the directory ``sim`` cannot be created, since the name is in use
    :raises PyfrcError: when a file cannot be written, with the files that were written before
    """
    physics, config = project.physics_file, project.root / SIM_CONFIG
    schema = config.with_name(SCHEMA_NAME)
    done = Created()
    done.unchanged += [file for file in (physics, config) if os.path.lexists(file)]
    if len(done.unchanged) == 2:
        return done
    _check_places(project, config)
    proposal = run_in_subprocess(propose, project, "while pyfrc was searching for its devices")
    if config not in done.unchanged:
        _write(config, proposal.config, done)
        if os.path.lexists(schema):
            done.unchanged.append(schema)
        else:
            _write(schema, sim_config_schema() + "\n", done)
    if physics not in done.unchanged:
        done.failures = failures_with(project, proposal.physics)
        if done.failures and done.failures.new:
            done.proposal = project.root / PROPOSAL
        _write(done.proposal or physics, proposal.physics, done)
    done.recognised = proposal.recognised
    done.notes = [*proposal.assumptions, *(proposal.advice if physics in done.written else ())]
    done.problem = proposal.problem
    return done


def _check_places(project: Project, config: Path) -> None:
    """Check that all names are free, before the robot is started."""
    physics = project.physics_file
    if (elsewhere := project.misplaced_physics) is not None:
        raise UsageError(
            f"there is a {project.shown(elsewhere)}, which pyfrc does not read",
            remedy=f"Move it beside {project.main_file.name}; or rename it, to have another one written.",
        )
    others = sorted(each.name for each in physics.parent.iterdir() if each.name.casefold() == physics.name)
    # On file systems that ignore case, the existing file has the other name.
    if others and physics.name not in others:
        raise UsageError(f"there is a {others[0]}: rename it to {physics.name}")
    package = physics.with_suffix("")
    if not others and any(package.glob("*.py")):
        raise UsageError(
            f"there is a package {package.name}/, but pyfrc runs a file {physics.name}",
            remedy=f"Move the contents of {package.name}/__init__.py to {physics.name}, and rename the package: "
            "Python cannot import two modules with the same name.",
        )
    directory = config.parent
    if os.path.lexists(directory) and not directory.is_dir():
        raise UsageError(f"{directory.name} is a file, but the directory of {SIM_CONFIG.as_posix()} needs this name")


def _write(file: Path, text: str, done: Created) -> None:
    try:
        write_whole(file, text)
    except OSError as error:
        before = " and ".join(each.name for each in done.written)
        raise PyfrcError(
            f"{file.name} could not be written: {error}",
            remedy=f"Written before that, and complete: {before}." if before else "Nothing was written.",
        ) from error
    done.written.append(file)
