"""Checks of the robot project: its program, settings, physics, tests and required packages."""

from __future__ import annotations

from codecs import BOM_UTF8
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from .._version import __version__
from ..compat.unrepeatable import real_time_libraries
from ..config.packages import quoted_requirement
from ..config.robotpy import load_robot_packages, unknown_components
from ..deploy.robot_packages import fits
from ..errors import ProjectError, PyfrcError, SettingsError
from ..passes.memory import left_over
from ..processes.call import run_in_subprocess
from ..processes.crash_report import CrashLog
from ..project import Project
from ..project.hidden_libraries import find_hidden_libraries
from ..runtime.checks.sources import CodeWarning
from ..season import SeasonSetting, refuse_other_season
from .check_result import CheckResult, hint, ok, problem
from .installed import Installed, Package

Answer = TypeVar("Answer")


def check_project(
    project: Project, installed: Installed, settings: Sequence[SeasonSetting] = ()
) -> Iterator[CheckResult]:
    """Check the project, without importing it in this process.

    :param settings: its settings that fit one season
    """
    yield from _hidden_libraries(project)
    wpilib = installed.get("wpilib")
    refused = False
    try:
        refuse_other_season(wpilib.version if wpilib else None, settings)
    except ProjectError as other:
        refused = True  # its program is not imported: it would fail by this
        if other.where is not None:  # otherwise it is about WPILib alone, which another check reports
            yield problem_from_error("project", other, "")
    yield from _asked_for(project, installed, None if refused else wpilib)
    program = [] if refused else [*_robot_class(project)]
    yield from program
    for unreadable in project.unreadable_sources():
        yield hint("project", f"{unreadable.where}: {unreadable.message}", unreadable.remedy or "")
    yield from _sim_config(project)
    yield from _dashboards(project)
    yield from _physics(project, imports=not refused and all(each.status != "problem" for each in program))
    tests = project.find_tests()
    if tests is not None:
        yield ok("tests", str(tests))
        if left := left_over(project):
            text = f"in the last run, each test took a new interpreter, because one had left {left}"
            yield hint("tests", text, "The tests only take longer. pyfrc test -v says the same.")
    else:
        yield hint("tests", "the project has none", "pyfrc add-tests; or run the ready-made ones: pyfrc test --builtin")


def problem_from_error(topic: str, error: PyfrcError | OSError, otherwise: str) -> CheckResult:
    """Return an error as a problem.

    :param otherwise: the remedy if the error has none
    """
    if not isinstance(error, PyfrcError):
        return problem(topic, str(error), otherwise)
    text = f"{error.where}: {error.message}" if error.where else error.message
    return problem(topic, text, error.remedy or otherwise)


def _hidden_libraries(project: Project) -> Iterator[CheckResult]:
    """Find files of the project that hide a library with the same name."""
    for hidden in find_hidden_libraries(project.root, project.main_file):
        yield problem("project", hidden.text, hidden.remedy)


def _asked_for(project: Project, installed: Installed, wpilib: Package | None) -> Iterator[CheckResult]:
    """Compare ``[tool.robotpy]`` with the packages on this computer.

    :param wpilib: the installed one, if it is of the project's season
    """
    if not project.pyproject.is_file():
        return
    name = project.pyproject.name
    try:
        wanted = load_robot_packages(project.pyproject)
    except SettingsError as malformed:
        yield problem_from_error("project", malformed, "Correct it there.")
        return
    if project.pyproject.read_bytes().startswith(BOM_UTF8):
        text = f"{name} begins with a byte-order mark, which robotpy and plain pytest do not read"
        yield hint("project", text, "Save it as UTF-8 without a byte-order mark (VS Code: UTF-8, not UTF-8 with BOM).")
    if wanted.version is not None and wpilib is not None and wanted.version != wpilib.version:
        yield hint(
            "project",
            f"{wanted.lines['robotpy_version']}: robotpy_version is {wanted.version}, "
            f"but wpilib {wpilib.version} is installed here",
            f'pip install "wpilib=={wanted.version}", or change robotpy_version to have the robot get '
            f"{wpilib.version}.",
        )
    if "robotpy_extras" in wanted.lines:
        where = wanted.lines["robotpy_extras"]
        text = f"{where}: robotpy_extras was renamed in 2026, and robotpy deploy refuses the old name"
        yield hint("project", text, "Rename it to components.")
    for text, remedy in unknown_components(wanted):
        yield problem("project", f"{wanted.lines['components']}: {text}", remedy)
    for needed in wanted.requires:
        if needed.marker is not None and not needed.marker.evaluate({"extra": ""}):
            continue
        there = installed.get(needed.name)
        if there is None or not fits(there.version, needed):
            instead = f"{there.version} is installed" if there else "it is not installed"
            text = f"{wanted.lines['requires']}: requires {needed}, but {instead} here"
            if needed.name == "pyfrc":  # a robot does not need it, and this doctor is not to replace itself
                remedy = f'Write "pyfrc=={__version__}" there, or remove the line: a robot does not need pyfrc.'
                yield hint("project", text, remedy)
                continue
            yield problem("project", text, f"pip install {quoted_requirement(needed)}")


def _robot_class(project: Project) -> Iterator[CheckResult]:
    looked = _imported(_look_at_class, project, "program", project.main_file.name, "it")
    if isinstance(looked, CheckResult):
        yield looked
        return
    name, misspelled, real_time = looked
    yield ok("program", f"class {name} in {project.main_file}")
    for method in misspelled:
        yield problem("program", str(method), method.remedy)
    for library in real_time:
        text = f"{library} simulates its devices in real time: runs of this robot do not repeat exactly"
        yield hint("program", text, "In tests, compare what depends on these devices with a tolerance.")


def _imported(
    look: Callable[[Project, CrashLog], Answer], project: Project, topic: str, file: str, what: str
) -> Answer | CheckResult:
    """Return what a function finds in another process, where it imports a file of the project; or the problem."""
    try:
        return run_in_subprocess(look, project, f"while {what} was imported")
    except (PyfrcError, OSError) as error:
        return problem_from_error(topic, error, "Correct that line; pyfrc test shows more details.")
    except Exception as error:  # the other process could not report the error
        return problem(topic, f"{file} cannot be imported: {error}", "Run pyfrc test for details.")


def _look_at_class(project: Project, log: CrashLog) -> tuple[str, list[CodeWarning], tuple[str, ...]]:
    # Here: they import WPILib, which may be broken or missing.
    from ..runtime.checks.code_checks import find_code_warnings
    from ..runtime.loading import load_robot

    name = load_robot(project).__name__
    return name, find_code_warnings(project), real_time_libraries()


def _physics(project: Project, imports: bool) -> Iterator[CheckResult]:
    """Check the physics.

    :param imports: whether the robot program, which it may import, can be imported
    """
    name = project.physics_file.name
    if project.misplaced_physics is not None:
        return  # among the mistakes of the program
    if not project.physics_file.is_file():
        yield hint("physics", f"no {name}: nothing moves in simulation", "pyfrc create-physics")
        return
    wrong = _imported(_load_physics, project, "physics", name, "the physics") if imports else None
    yield wrong or ok("physics", name)


def _load_physics(project: Project, log: CrashLog) -> None:
    from ..physics.engine import load_physics
    from ..runtime.loading import load_robot

    load_robot(project)
    load_physics(project)


def _dashboards(project: Project) -> Iterator[CheckResult]:
    from ..config.dashboards import DASHBOARDS, load_dashboards

    try:
        found = load_dashboards(project.root)
    except PyfrcError as error:
        yield problem_from_error(DASHBOARDS.as_posix(), error, "The page of pyfrc sim shows no dashboards before that.")
        return
    if found:
        yield ok(DASHBOARDS.as_posix(), f"dashboards: {', '.join(found)}")


def _sim_config(project: Project) -> Iterator[CheckResult]:
    from ..config.sim_file import SIM_CONFIG, load_sim_config

    topic = SIM_CONFIG.as_posix()
    try:
        loaded = load_sim_config(project.root)
    except (PyfrcError, OSError) as error:
        yield problem_from_error(topic, error, "pyfrc config check")
        return
    doubtful = [*loaded.warnings, *loaded.lint()]
    if doubtful:
        more = f", and {len(doubtful) - 1} more" if len(doubtful) > 1 else ""
        yield hint(topic, f"{doubtful[0]}{more}", "To see them all: pyfrc config check")
    elif loaded.text is None:
        yield hint(topic, "there is none: all settings have their defaults", "pyfrc create-physics")
    else:
        yield ok(topic, "no mistakes")
