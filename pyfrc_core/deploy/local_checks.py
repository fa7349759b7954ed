"""The program to deploy, checked on this computer: its files, its tests, and whether it can be imported."""

from __future__ import annotations

import getpass
import socket
import tempfile
import threading
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import IO

from ..config.robotpy import RobotPackages, load_robot_packages
from ..errors import PyfrcError, RobotCodeError, text_of
from ..explain import Explanation, explain
from ..processes import spawn
from ..processes.call import run_in_subprocess
from ..processes.crash_report import CrashLog
from ..project import MAIN_FILE, Project
from ..project.git import git_output
from ..project.walk import SourceError, read_source
from ..wording import counted, size_text
from .errors import RefusedError
from .manifest import Entry, Manifest, ascii_path, build_manifest, listed, listed_paths
from .progress import DeployProgress, UserInterface, ask_to_continue
from .robot_packages import ImportSearch
from .team import RobotChoice


@dataclass(frozen=True)
class DeployOptions:
    """The options of a deploy.

    :param choice: the robot to deploy to
    :param builtin: run the ready-made tests, too, unless the project imports them
    :param skip_tests: run no tests
    :param large: also upload files over 250,000 bytes
    :param check_versions: refuse robots with another wpilib, without required packages, or with an old image
    :param nonstandard: allow a main file with another name than robot.py
    :param debug: start the program with debugging enabled
    :param dry_run: only show what would be done
    :param auto_rollback: roll back if the new program ends during the watch
    :param reinstall: compare what is installed with its hashes, send again what differs, and make a new release
    """

    choice: RobotChoice = field(default_factory=RobotChoice)
    builtin: bool = False
    skip_tests: bool = False
    large: bool = False
    check_versions: bool = True
    nonstandard: bool = False
    debug: bool = False
    dry_run: bool = False
    auto_rollback: bool = False
    reinstall: bool = False


@dataclass(frozen=True)
class CheckedProgram:
    """A program to deploy.

    :param manifest: its files
    :param main: the name of its main file
    :param deploy_json: the content of ``deploy.json`` on the robot
    :param packages: what it requires on the robot
    :param imports: what it imports
    :param importing: the check that it can be imported; None if its tests run
    """

    manifest: Manifest
    main: str
    deploy_json: Mapping[str, str]
    packages: RobotPackages
    imports: ImportSearch
    importing: ImportCheck | None


def prepare(project: Project, options: DeployOptions, talk: UserInterface) -> CheckedProgram:
    """Check the project, and return the program to deploy.

    :raises RefusedError: if it must not be deployed
    """
    progress, settings = talk.progress, project.settings.deploy
    _refuse_other_main_files(project, options.nonstandard)

    def read() -> Manifest:
        return build_manifest(project.root, settings.exclude, options.large, settings.private)

    manifest, importing = read(), None
    if manifest.private:
        _ask_about_private_files(manifest.private, options, talk)
    if not options.dry_run:
        if options.skip_tests or (project.find_tests() is None and not options.builtin):
            if not options.skip_tests:
                progress.note("this project has no tests; the ready-made ones run with --builtin")
            importing = ImportCheck(project)
        elif (since := _passed_already(project, options.builtin)) is not None:
            with progress.phase("tests") as phase:
                phase.detail = f"passed at {since}; the project's files, Python and packages have not changed since"
        else:
            passed, before = _run_tests(project, options.builtin, talk), manifest
            manifest = read()
            if passed:
                _refuse_untested(before, manifest, talk)
    with progress.phase("files") as phase:
        phase.detail = f"{counted(len(manifest.entries), 'file')}, {size_text(manifest.total_bytes)}"
    main, record, packages = project.main_file.name, _deploy_json(project.root), load_robot_packages(project.pyproject)
    imports = ImportSearch(manifest, project.root, main)
    if options.dry_run:
        _compile(project, manifest, imports.program(), progress)
    return CheckedProgram(manifest, main, record, packages, imports, importing)


def _compile(project: Project, manifest: Manifest, program: list[str], progress: DeployProgress) -> None:
    """Compile the sources to deploy, and print which other checks a deploy makes.

    :param program: the paths of those that the program imports when it starts; of others, errors are warnings
    :raises RefusedError: if one of these cannot be compiled
    """
    for entry in manifest.entries:
        wrong = _why_uncompilable(project, entry) if entry.path.endswith(".py") else None
        if wrong is not None and entry.path in program:
            raise wrong
        if wrong is not None:
            progress.warning(f"{wrong}\n  No import of this file was found that runs when the program starts.")
    progress.note("not checked in a dry run: the tests, and whether the program can be imported")


def _why_uncompilable(project: Project, entry: Entry) -> RefusedError | None:
    """Return the error of a source that Python cannot compile; None if it can."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            compile(read_source(entry.file), str(entry.file), "exec", dont_inherit=True)
    except SourceError as error:
        wrong = error.within(project.files)
        return RefusedError(wrong.message, where=wrong.where, remedy=wrong.remedy)
    except SyntaxError as error:
        explained = explain(error, project.files) or Explanation()
        where = explained.place or f"{entry.path}:{error.lineno}"
        return RefusedError(explained.text or text_of(error), where=where, remedy=explained.remedy or None)
    return None


def _refuse_other_main_files(project: Project, nonstandard: bool) -> None:
    """Check the name of the main file.

    :param nonstandard: allow another name than robot.py
    :raises RefusedError: if it has another name that neither the options nor the settings allow
    """
    allowed = nonstandard or project.settings_file is not None
    if project.main_file.name != MAIN_FILE and not allowed:
        raise RefusedError(
            f"the main file must be called {MAIN_FILE}, so that other tools find it",
            where=project.main_file.name,
            remedy=f"Rename it to {MAIN_FILE}, deploy it as it is with --nonstandard, "
            f'or set main = "{project.main_file.name}" under [tool.pyfrc] in pyproject.toml.',
        )


def _run_tests(project: Project, builtin: bool, talk: UserInterface) -> bool:
    """Run the project's tests with `pyfrc test`, and return whether all passed.

    :raises RefusedError: if they failed, unless the user deploys nevertheless
    """
    if project.settings_file is not None:
        which = ["--project", str(project.settings_file.parent)]
    else:
        which = ["--main", str(project.main_file)]
    which += [f"--robot-class={project.class_name}"] if project.class_name else []
    command = ["-m", "pyfrc", "test", *which, *(["--builtin"] if builtin else [])]
    with talk.progress.phase("tests", own_output=True) as phase:
        passed = _run(command, talk.progress.child_output, talk.progress.quiet)
        phase.detail = "passed" if passed else "failed"
    if not project.main_file.is_file():
        raise RefusedError("not deployed: it was removed while the tests ran", where=project.main_file)
    if not passed:
        ask_to_continue("the tests failed", talk.ask, "Correct the failures, or deploy without tests: --skip-tests")
    return passed


def _run(command: list[str], output: IO[str], quiet: bool) -> bool:
    """Run Python, and return whether it succeeded.

    :param output: a stream with a file descriptor, for its output
    :param quiet: print the output only if it fails
    """
    output.flush()
    if not quiet:
        return spawn.run_python(command, output) == 0
    with tempfile.TemporaryFile() as printed:
        passed = spawn.run_python([*command, "--quiet"], printed, spawn.WRITES_UTF_8) == 0
        if not passed:
            printed.seek(0)
            output.write(printed.read().decode(errors="replace"))
        return passed


def _ask_about_private_files(private: Mapping[str, str], options: DeployOptions, talk: UserInterface) -> None:
    what = "files would be uploaded that seem to be private: "
    what += listed([f"{ascii_path(path)} ({why})" for path, why in private.items()])
    if options.dry_run:
        talk.progress.warning(what)
        return
    remedy = "Under [tool.pyfrc.deploy] in pyproject.toml, leave them out with exclude = [...], or upload them with "
    ask_to_continue(what, talk.ask, f"{remedy}private = [...].")


def _passed_already(project: Project, builtin: bool) -> str | None:
    """Return when the project's tests passed, if nothing that they read has changed since, such as ``16:40``."""
    from ..passes.memory import Passes

    since = Passes(project, builtin=builtin).green_since()
    if since is None:
        return None
    return f"{since:%H:%M}" if since.date() == datetime.now().astimezone().date() else f"{since:%Y-%m-%d %H:%M}"


def _refuse_untested(tested: Manifest, manifest: Manifest, talk: UserInterface) -> None:
    """Check that the files to deploy are those that the tests have run with.

    A changed source is refused: it was saved while the tests ran. So is a new one, which robots may import from a
    directory by its name, and a removed one. Tests seldom write sources, and mostly the same each time, so that the
    next deploy works. They do write other files, such as logs, which may differ each time and would prevent every
    deploy: when such a file has changed, the deploy goes on with a warning, and a new one is the tests'.

    :param tested: the files at the beginning of the tests
    :param manifest: the files to deploy
    :raises RefusedError: with the changed sources
    """
    before, now = ({each.path: each.sha256 for each in files.entries} for files in (tested, manifest))
    changed = sorted(path for path in before.keys() | now.keys() if before.get(path) != now.get(path))
    sources = [path for path in changed if path.endswith(".py")]
    if sources:
        raise RefusedError(
            f"not deployed: files have changed since the tests began, and were not tested: {listed_paths(sources)}",
            remedy="Run the command again. If the tests write these files, exclude them with exclude = [...] under "
            "[tool.pyfrc.deploy] in pyproject.toml.",
        )
    if others := [path for path in changed if path in before]:
        talk.progress.warning(f"files have changed since the tests began: {listed_paths(others)}")


class ImportCheck:
    """Imports the project in a separate process, in the background."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self._error: PyfrcError | None = None
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def refuse_failure(self, talk: UserInterface) -> None:
        """Wait for the import.

        :raises RefusedError: if it failed, unless the user deploys nevertheless
        """
        self._thread.join()
        if self._error is not None:
            failure = f"the robot program cannot be imported: {self._error}"
            ask_to_continue(failure, talk.ask, "On the robot, it would end immediately.", self._error)

    def _run(self) -> None:
        try:
            run_in_subprocess(_load, self._project, "while it was imported")
        except PyfrcError as error:
            self._error = error
        except Exception as error:
            self._error = RobotCodeError(f"the robot program cannot be imported: {error}")


def _load(project: Project, log: CrashLog) -> None:
    from ..runtime.loading import load_robot

    load_robot(project)


_GIT_SECONDS = 5.0


def _deploy_json(root: Path) -> dict[str, str]:
    """Return the record, with the same keys as other tools. The git keys exist only in a git checkout.

    :param root: the code's directory
    """
    record = {
        "deploy-host": socket.gethostname(),
        "deploy-user": _user(),
        "deploy-date": datetime.now().isoformat(timespec="seconds"),
        "code-path": str(root),
    }
    commit = _git(root, "rev-parse", "HEAD")
    if commit:
        record["git-hash"] = commit
        # Ends in "-dirty" if there are uncommitted changes.
        record["git-desc"] = _git(root, "describe", "--dirty=-dirty", "--always") or commit
        record["git-branch"] = _git(root, "rev-parse", "--abbrev-ref", "HEAD") or "HEAD"
    return record


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):
        return "unknown"


def _git(root: Path, *arguments: str) -> str | None:
    """Return the output of git, or None without git, a checkout or a commit."""
    output = git_output(root, *arguments, seconds=_GIT_SECONDS)
    return None if output is None else output.strip()
