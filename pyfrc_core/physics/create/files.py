"""Writes ``physics.py`` and ``sim/config.json`` for the robot at hand, and tells what was there already."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from ...config.sim_file import SIM_CONFIG, load_sim_config
from ...config.sim_schema import sim_config_schema
from ...errors import PyfrcError, SettingsError, UsageError
from ...project import Project
from ...runtime.apart import run_apart
from ...text_files import write_whole
from .config_file import SCHEMA_NAME
from .proposal import propose


@dataclass
class Created:
    """What `create_physics` has done; files are absolute.

    :param left_alone: the files that were there, each with what is wrong with it or an empty text
    :param recognised: lines on the drivetrain, encoders and gyros found; none when no robot was looked at
    :param notes: sentences on what was taken for granted, and what is left to do
    :param problem: why the robot could not be driven, naming the user's line
    """

    written: list[Path] = field(default_factory=list)
    left_alone: dict[Path, str] = field(default_factory=dict)
    recognised: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    problem: str | None = None


def create_physics(project: Project) -> Created:
    """Write ``physics.py`` and ``sim/config.json`` unless they are there; the robot's program is started for it.

    :raises RobotCodeError: when the robot's code fails before it can be driven, or ends the process it runs in;
        nothing is written then
    :raises UsageError: when something else is where a file or the directory ``sim`` has to be
    :raises PyfrcError: when a file cannot be written, saying which were
    """
    physics, config = project.physics_file, project.root / SIM_CONFIG
    schema = config.with_name(SCHEMA_NAME)
    done = Created()
    if os.path.lexists(physics):
        done.left_alone[physics] = _what_is_wrong_with_physics(physics)
    if os.path.lexists(config):
        done.left_alone[config] = _what_is_wrong_with_config(project.root)
    if len(done.left_alone) == 2:
        return done
    _check_places(physics, config)
    proposal = run_apart(propose, project, "while pyfrc was looking at what it has")
    texts = {physics: proposal.physics, config: proposal.config}
    if config not in done.left_alone:
        texts[schema] = sim_config_schema() + "\n"
        if os.path.lexists(schema):
            done.left_alone[schema] = ""
    for file, text in texts.items():
        if file not in done.left_alone:
            _write(file, text, done)
    done.recognised = proposal.recognised
    done.notes = [*proposal.assumptions, *(proposal.advice if physics in done.written else ())]
    done.problem = proposal.problem
    return done


def _check_places(physics: Path, config: Path) -> None:
    """See that nothing is in the way, before the robot is started."""
    others = sorted(each.name for each in physics.parent.iterdir() if each.name.casefold() == physics.name)
    # Where upper and lower case are the same, the file is there under the other name.
    if others and physics.name not in others:
        raise UsageError(f"there is a {others[0]}: rename it to {physics.name}")
    package = physics.with_suffix("")
    if not others and any(package.glob("*.py")):
        raise UsageError(
            f"there is a package {package.name}/, but pyfrc runs a file {physics.name}",
            remedy=f"Move what is in {package.name}/__init__.py to {physics.name}, and give the package another name: "
            "Python cannot import two things called the same.",
        )
    directory = config.parent
    if os.path.lexists(directory) and not directory.is_dir():
        raise UsageError(f"{directory.name} is a file, where the directory of {SIM_CONFIG.as_posix()} has to be")


def _what_is_wrong_with_physics(file: Path) -> str:
    try:
        compile(file.read_bytes(), file.name, "exec", dont_inherit=True)
    except SyntaxError as error:
        return f"{file.name}:{error.lineno}: SyntaxError: {error.msg}" if error.lineno else f"SyntaxError: {error.msg}"
    except (OSError, ValueError) as error:
        return str(error)
    return ""


def _what_is_wrong_with_config(root: Path) -> str:
    try:
        load_sim_config(root)
    except (SettingsError, OSError) as error:
        return str(error)
    return ""


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
