"""Checks on this computer before a deploy: the tests, and whether the program can be imported."""

from __future__ import annotations

import tempfile
import threading
from datetime import datetime
from typing import IO, TYPE_CHECKING

from ..errors import PyfrcError, RobotCodeError
from ..processes import spawn
from ..processes.call import run_in_subprocess
from ..project import MAIN_FILE, Project
from .errors import RefusedError
from .progress import DeployProgress, Questions

if TYPE_CHECKING:
    from ..processes.crash_report import CrashLog
    from .manifest import Manifest


def refuse_other_main_files(project: Project, nonstandard: bool) -> None:
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


def run_tests(project: Project, builtin: bool, output: IO[str], quiet: bool = False) -> bool:
    """Run the project's tests with `pyfrc test`, and return whether all passed.

    :param output: a stream with a file descriptor, for their output
    :param quiet: print the output only if a test fails
    """
    if project.settings_file is not None:
        which = ["--project", str(project.settings_file.parent)]
    else:
        which = ["--main", str(project.main_file)]
    which += [f"--robot-class={project.class_name}"] if project.class_name else []
    command = ["-m", "pyfrc", "test", *which, *(["--builtin"] if builtin else [])]
    output.flush()
    if not quiet:
        return spawn.run_python(command, output) == 0
    with tempfile.TemporaryFile() as printed:
        passed = spawn.run_python([*command, "--quiet"], printed) == 0
        if not passed:
            printed.seek(0)
            output.write(printed.read().decode(errors="replace"))
        return passed


def passed_already(project: Project, builtin: bool) -> str | None:
    """Return when the project's tests passed, if nothing that they read has changed since, such as ``16:40``."""
    from ..passes.memory import Passes

    since = Passes(project, builtin=builtin).green_since()
    if since is None:
        return None
    return f"{since:%H:%M}" if since.date() == datetime.now().astimezone().date() else f"{since:%Y-%m-%d %H:%M}"


def refuse_untested(tested: Manifest, manifest: Manifest, progress: DeployProgress) -> None:
    """Check that the files to deploy are those that the tests have run with.

    A changed source is refused: it was saved while the tests ran. So is a new one, which robots may import from a
    directory by its name, and a removed one. Tests seldom write sources, and mostly the same each time, so that the
    next deploy works. They do write other files, such as logs, which may differ each time and would prevent every
    deploy: when such a file has changed, the deploy goes on with a warning, and a new one is the tests'.

    :param tested: the files at the beginning of the tests
    :param manifest: the files to deploy
    :raises RefusedError: with the changed sources
    """
    from .manifest import listed_paths

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
        progress.warning(f"files have changed since the tests began: {listed_paths(others)}")


class ImportCheck:
    """Imports the project in a separate process, in the background."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self._error: PyfrcError | None = None
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def result(self) -> PyfrcError | None:
        """Wait for the import. Return its error, or None."""
        self._thread.join()
        return self._error

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


def ask_to_continue(failure: str, ask: Questions | None, remedy: str, error: PyfrcError | None = None) -> None:
    """Ask the user whether to deploy in spite of a failure.

    :param ask: None if the user cannot be asked
    :raises RefusedError: if the user says no or cannot be asked
    """
    if ask is None:
        raise RefusedError(f"not deployed: {failure}", remedy=remedy) from error
    if not ask.yes(f"{failure[:1].upper()}{failure[1:]}. Deploy anyway?"):
        raise RefusedError(f"not deployed: {failure}") from error
