"""Checks that the robot's Python has the modules and packages that a program needs when it starts.

The laptop reads the program's source, which would take a robot seconds. The robot only reports which modules its Python
cannot find. This needs no additional round trip, since the first message contains the modules.

Importing `packaging` takes longer than the checks, so it is imported only where it is needed: if a package is missing,
or ``[tool.robotpy]`` has requirements.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from ..config.packages import PACKAGES, component_of, quoted_requirement
from ..config.robotpy import COMPONENTS, RobotPackages, unknown_components
from ..season import CURRENT
from ..sync.wanted import robot_environment
from ..wording import counted
from .facts import VIRTUAL_IMAGE
from .program_imports import ProgramImports
from .progress import UserInterface, ask_to_continue
from .robot_checks import INSTALL_FOR_VIRTUAL_ROBOT, INSTALL_PACKAGES, NO_CHECK
from .targets import controller_named

if TYPE_CHECKING:
    from packaging.requirements import Requirement

    from .facts import RobotFacts
    from .manifest import Manifest

_MAX_NAMED = 5
#: A module that the robot's start command needs.
_RUNNER = "robotpy"


@dataclass(frozen=True)
class PackageProblem:
    """A missing or wrong package on the robot.

    :param where: file and line of the import or the requirement
    """

    where: str
    text: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.where}: {self.text}"


class ImportSearch:
    """The program's imports, read from its source in the background.

    :param root: the program's directory
    :param main: its main file's name
    """

    def __init__(self, manifest: Manifest, root: Path, main: str) -> None:
        self._files = {entry.path: entry.file for entry in manifest.entries}
        self._root = root
        self._main = main
        self._error: Exception | None = None
        self._imports: ProgramImports
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            self._imports = ProgramImports(self._files, self._main)
        except Exception as error:
            self._error = error

    def _found(self) -> ProgramImports:
        self._thread.join()
        if self._error is not None:
            raise self._error
        return self._imports

    def program(self) -> list[str]:
        """Return the files that are imported when the program starts."""
        return sorted(path for path in self._found().read if path.endswith(".py"))

    def modules(self) -> list[str]:
        """Return the modules to look for in the robot's Python."""
        return sorted({_RUNNER, *(each.module.partition(".")[0] for each in self._found().outside)})

    def problems(self, facts: RobotFacts, packages: RobotPackages) -> list[PackageProblem]:
        """Return the imports that fail on the robot, sorted by file: one problem for all of a package.

        :param facts: the robot's facts, with its missing modules
        """
        failing: dict[tuple[str, str, str], set[tuple[str, int]]] = {}
        for found in self._found().outside:
            module = found.module.partition(".")[0]
            if module in facts.missing_modules:
                reason = module, *self._explanation(module, facts, packages)
                failing.setdefault(reason, set()).add((found.file, found.line))
        problems = []
        for (module, text, remedy), imports in failing.items():
            file, line = min(imports)
            more = f", and {counted(len(imports) - 1, 'more import')}" if len(imports) > 1 else ""
            problems.append(PackageProblem(f"{file}:{line}", f"import {module}{more}: {text}", remedy))
        if _RUNNER in facts.missing_modules:
            remedy = f"Install it: {_install('robotpy-cli', facts)}."
            text = "the robot has no package robotpy-cli, which starts programs"
            problems.append(PackageProblem(self._main, text, remedy))
        return sorted(problems, key=lambda each: each.where)

    def _explanation(self, module: str, facts: RobotFacts, packages: RobotPackages) -> tuple[str, str]:
        """Return why the robot does not have a module, and what to do."""
        from packaging.utils import canonicalize_name

        if module in sys.stdlib_module_names:
            text = f"Python {facts.python} on the robot has no such module"
            return text, "That Python's library does not have it: use another module."
        distribution = next(iter(packages_by_module().get(module, ())), PACKAGES.get(module))
        if distribution is None:
            return self._not_ours(module, facts)
        if canonicalize_name(distribution) in facts.packages:
            there = f"{distribution} {facts.packages[canonicalize_name(distribution)]}"
            remedy = f"Install this computer's version: {_install(distribution, facts)}."
            return f"{there} on the robot has no such module", remedy
        return f"the robot has no package {distribution}", _how_to_get(distribution, packages, facts)

    def _not_ours(self, module: str, facts: RobotFacts) -> tuple[str, str]:
        """Return the same for a module that is neither in the program nor in a known package."""
        base = self._root / module
        if base.with_name(f"{module}.py").is_file() or base.is_dir():
            exclude = "Check exclude = [...] under [tool.pyfrc.deploy] in pyproject.toml."
            return "the project has it, but it is not uploaded", exclude
        requires = "" if _is_virtual(facts) else "add it to requires under [tool.robotpy] in pyproject.toml; "
        text = "neither the project nor the robot has such a module"
        return text, f"Check the name. If it is a package: {requires}{_install('PACKAGE', facts)}."


@cache
def packages_by_module() -> Mapping[str, Sequence[str]]:
    """Return the installed packages by module. Finding them takes a third of a second, so this is done once."""
    from importlib.metadata import distributions, packages_distributions

    if sys.version_info >= (3, 11):
        return packages_distributions()
    # Before, it knew only the modules that packages list in a file which WPILib's do not have.
    found: dict[str, list[str]] = {}
    for each in distributions():
        files = [file for file in each.files or () if file.suffix in (".py", ".so", ".pyd")]
        for name in {file.parts[0].partition(".")[0] for file in files}:
            found.setdefault(name, []).append(each.metadata["Name"])
    return found


def _is_virtual(facts: RobotFacts) -> bool:
    return facts.image == VIRTUAL_IMAGE


def _install(package: str, facts: RobotFacts) -> str:
    """Return how to install a package on the robot."""
    return f"{INSTALL_FOR_VIRTUAL_ROBOT} {package}" if _is_virtual(facts) else INSTALL_PACKAGES


def _how_to_get(distribution: str, packages: RobotPackages, facts: RobotFacts) -> str:
    from packaging.utils import canonicalize_name

    if _is_virtual(facts):
        return f"Install it {_install(distribution, facts)}."
    name = canonicalize_name(distribution)
    component = component_of(name)
    if any(canonicalize_name(each.name) == name for each in packages.requires) or any(
        name in COMPONENTS.get(each, ()) for each in packages.components
    ):
        return f"Install it: {INSTALL_PACKAGES}."
    entry = f'"{distribution}" to requires' if component is None else f'"{component}" to components'
    return f"Add {entry} under [tool.robotpy] in pyproject.toml; {INSTALL_PACKAGES}."


def check_packages(
    search: ImportSearch,
    packages: RobotPackages,
    facts: RobotFacts,
    talk: UserInterface,
    *,
    refuse: bool = True,
    dry_run: bool = False,
) -> None:
    """Check that the robot has everything that the program needs, before anything is changed.

    :param refuse:  ask the user or refuse; otherwise only print warnings
    :param dry_run: print warnings, since nothing will be deployed
    :raises RefusedError: if something is missing, and the user does not want to deploy anyway
    """
    found = search.problems(facts, packages)
    unfit = [*_misspelled_components(packages), *unfit_packages(packages, facts)] if refuse else []
    problems = [*found, *unfit]
    if dry_run or not refuse:
        for each in found:
            talk.progress.warning(f"{each}; the program would end immediately. {each.remedy}")
        for each in unfit:
            talk.progress.warning(f"{each}. {each.remedy}")
    elif problems:
        failure = "; ".join(str(each) for each in problems[:_MAX_NAMED])
        if len(problems) > _MAX_NAMED:
            failure += f"; and {len(problems) - _MAX_NAMED} more"
        ask_to_continue(failure, talk.ask, f"{problems[0].remedy} {NO_CHECK}")


def _misspelled_components(packages: RobotPackages) -> Iterator[PackageProblem]:
    for text, remedy in unknown_components(packages):
        yield PackageProblem(packages.lines["components"], text, remedy)


def unfit_packages(packages: RobotPackages, facts: RobotFacts) -> Iterator[PackageProblem]:
    """Yield the differences between the robot's packages and ``[tool.robotpy]``."""
    there = facts.wpilib

    def remedy(package: str) -> str:
        return f"Change it in pyproject.toml, or install the package: {_install(package, facts)}."

    if packages.version is not None and there is not None and not _same(packages.version, there):
        text = f"robotpy_version is {packages.version}, but the robot has wpilib {there}"
        yield PackageProblem(packages.lines["robotpy_version"], text, remedy(f"wpilib=={packages.version}"))
    for component in packages.components:
        for distribution in COMPONENTS.get(component, ()):
            version = facts.packages.get(distribution)
            if version is None:
                text = f"components has {component}, but the robot has no package {distribution}"
                yield PackageProblem(packages.lines["components"], text, remedy(distribution))
            elif there is not None and not _same(version, there):
                text = f"the robot has {distribution} {version}, but wpilib {there}"
                same = f"Install the same version: {_install(f'{distribution}=={there}', facts)}."
                yield PackageProblem(packages.lines["components"], text, same)
    if not packages.requires:
        return
    from packaging.utils import canonicalize_name

    for needed in packages.requires:
        if not _needed_there(needed, facts):
            continue
        version = facts.packages.get(canonicalize_name(needed.name))
        if version is None or not fits(version, needed):
            instead = f"{needed.name} {version}" if version else f"no package {needed.name}"
            text = f"requires has {str(needed)!r}, but the robot has {instead}"
            yield PackageProblem(packages.lines["requires"], text, remedy(quoted_requirement(needed)))


def _needed_there(needed: Requirement, facts: RobotFacts) -> bool:
    """Return whether a requirement's marker applies to the robot, under each of its machine names."""
    if needed.marker is None:
        return True
    controller = controller_named(facts.controller)
    machines = {facts.machine}
    if facts.machine.startswith(controller.machine):
        machines.add(CURRENT.downloads.marker_machine)
    robot = {
        **robot_environment(CURRENT),
        "extra": "",
        "python_full_version": facts.python,
        "python_version": ".".join(facts.python.split(".")[:2]),
    }
    return all(needed.marker.evaluate({**robot, "platform_machine": machine}) for machine in machines)


def fits(version: str, needed: Requirement) -> bool:
    """Return whether a version meets a requirement."""
    from packaging.version import InvalidVersion, Version

    try:
        return needed.specifier.contains(Version(version), prereleases=True)
    except InvalidVersion:
        return True  # unknown


def _same(one: str, other: str) -> bool:
    if one == other:
        return True
    from packaging.version import InvalidVersion, Version

    try:
        return Version(one) == Version(other)
    except InvalidVersion:
        return False
