"""Checks that the robot's Python has the modules and packages that a program needs.

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
from .agent.imports import is_there
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

    :param where:   file and line of the import or the requirement
    :param certain: whether the program fails at its start; otherwise it fails if it reaches that line
    """

    where: str
    text: str
    remedy: str
    certain: bool = True

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
        return sorted(path for path in self._found().certain if path.endswith(".py"))

    def modules(self) -> list[str]:
        """Return the modules to look for in the robot's Python."""
        imported = {module for each in self._found().outside for module in (each.wanted.module, *each.wanted.instead)}
        return sorted({_RUNNER, *(asked for module in imported for asked in _asked_for(module))})

    def problems(self, facts: RobotFacts, packages: RobotPackages) -> list[PackageProblem]:
        """Return the imports that fail on the robot, sorted by certainty and file.

        :param facts: the robot's facts, with its missing modules
        """
        missing = facts.missing_modules
        found = [*self._outside(facts, packages), *self._lost(facts)]
        if _RUNNER in missing:
            remedy = f"Install it: {_install('robotpy-cli', facts)}."
            found.append(
                PackageProblem(self._main, "the robot has no package robotpy-cli, which starts programs", remedy)
            )
        return sorted(set(found), key=lambda each: (not each.certain, each.where))

    def _outside(self, facts: RobotFacts, packages: RobotPackages) -> Iterator[PackageProblem]:
        """Yield one problem for all imports that fail for the same reason, such as those of one package."""
        failing: dict[tuple[str, str, str, bool], set[tuple[str, int, str]]] = {}
        for found in self._found().outside:
            module = self._missing(found.wanted.module, facts)
            if module is None or (
                found.wanted.instead and not any(self._missing(each, facts) for each in found.wanted.instead)
            ):
                continue
            if self._found().changes_path and self._found().named_alike(module):
                continue  # probably in a directory that the program adds to sys.path
            top = module.partition(".")[0]
            reason = (top, *self._explanation(module, facts, packages), found.wanted.certain)
            failing.setdefault(reason, set()).add((found.file, found.wanted.line, module))
        for (_, text, remedy, certain), imports in failing.items():
            file, line, module = min(imports)
            more = f", and {counted(len(imports) - 1, 'more import')}" if len(imports) > 1 else ""
            yield PackageProblem(f"{file}:{line}", f"import {module}{more}: {text}", remedy, certain)

    def _missing(self, module: str, facts: RobotFacts) -> str | None:
        """Return the part of a dotted module name that neither the program nor the robot has, or None."""
        imports = self._found()
        top = module.partition(".")[0]
        if imports.file_of(top) is not None or imports.is_own_directory(top):
            return None
        if any(path[len(top) :] in facts.extension_suffixes for path in imports.extensions_of(top)):
            return None
        return next((each for each in _asked_for(module) if each in facts.missing_modules), None)

    def _lost(self, facts: RobotFacts) -> Iterator[PackageProblem]:
        imports = self._found()
        for found in imports.lost:
            module = found.wanted.module
            top = module.partition(".")[0]
            if top and imports.file_of(top) is None and top not in facts.missing_modules:
                continue  # the robot has a package of this name, which takes precedence over the program's directory
            if not top:
                text = f"from {module} import: there is no package above {found.file}"
                remedy = "Leave out the dots."
            else:
                text, remedy = self._not_ours(module, facts)
                text = f"import {module}: {text}"
            yield PackageProblem(found.where, text, remedy, found.wanted.certain)

    def _explanation(self, module: str, facts: RobotFacts, packages: RobotPackages) -> tuple[str, str]:
        """Return why the robot does not have a module, and what to do."""
        from packaging.utils import canonicalize_name

        top = module.partition(".")[0]
        others = self._found().extensions_of(top)
        if others:
            text = f"{others[0]} is not for the robot's Python ({facts.extension_suffixes[0]})"
            return text, f"Take the library built for the {facts.controller}."
        if top in sys.stdlib_module_names:
            text = f"Python {facts.python} on the robot has no such module"
            return text, "That Python's library does not have it: use another module."
        distribution = next(iter(packages_by_module().get(top, ())), PACKAGES.get(top))
        if distribution is None:
            return self._not_ours(module, facts)
        if canonicalize_name(distribution) in facts.packages:
            there = f"{distribution} {facts.packages[canonicalize_name(distribution)]}"
            remedy = f"Install this computer's version: {_install(distribution, facts)}."
            return f"{there} on the robot has no such module", remedy
        return f"the robot has no package {distribution}", _how_to_get(distribution, packages, facts)

    def _not_ours(self, module: str, facts: RobotFacts) -> tuple[str, str]:
        """Return the same for a module that is neither in the program nor in a known package."""
        from difflib import get_close_matches

        base = self._root.joinpath(*module.split("."))
        if base.with_name(f"{base.name}.py").is_file() or base.is_dir():
            exclude = "Check exclude = [...] under [tool.pyfrc.deploy] in pyproject.toml."
            return "the project has it, but it is not uploaded", exclude
        text = "neither the project nor the robot has such a module"
        if alike := get_close_matches(module, self._own_modules(module.rpartition(".")[0]), 1):
            return text, f"Did you mean {alike[0]}?"
        requires = "" if _is_virtual(facts) else "add it to requires under [tool.robotpy] in pyproject.toml; "
        return text, f"Check the name. If it is a package: {requires}{_install('PACKAGE', facts)}."

    def _own_modules(self, parent: str) -> list[str]:
        names = (path.removesuffix(".py").removesuffix("/__init__").replace("/", ".") for path in self._files)
        return [name for name in names if name.rpartition(".")[0] == parent]


@cache
def _asked_for(module: str) -> Sequence[str]:
    """Return the names to look for. A submodule is included only if it exists here: some are created at import."""
    top = module.partition(".")[0]
    if not top:
        return ()
    return (top, module) if module != top and is_there(module) else (top,)


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
    certain = [*(each for each in found if each.certain), *unfit]
    for each in found if dry_run or not refuse else (each for each in found if not each.certain):
        if not each.certain:
            talk.progress.warning(f"{each}; the program fails if it reaches this line. {each.remedy}")
        else:
            talk.progress.warning(f"{each}; the program would end immediately. {each.remedy}")
    if dry_run:
        for each in unfit:
            talk.progress.warning(f"{each}. {each.remedy}")
    elif certain and refuse:
        failure = "; ".join(str(each) for each in certain[:_MAX_NAMED])
        if len(certain) > _MAX_NAMED:
            failure += f"; and {len(certain) - _MAX_NAMED} more"
        ask_to_continue(failure, talk.ask, f"{certain[0].remedy} {NO_CHECK}")


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
        if version is None or not _fits(version, needed):
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


def _fits(version: str, needed: Requirement) -> bool:
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
