"""What is looked at here, before anything is done to the robot: the tests, whether the program can be imported."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import threading
from typing import IO, TYPE_CHECKING

from ..errors import PyfrcError, RobotCodeError
from ..processes.call import run_in_subprocess
from ..project import MAIN_FILE, Project
from ..runtime.loading import load_robot
from .errors import RefusedError
from .progress import Questions

if TYPE_CHECKING:
    from ..processes.crash_report import CrashLog


def refuse_other_main_files(project: Project, nonstandard: bool) -> None:
    """:raises RefusedError: when the main file has a name that nobody has said it should have on the robot"""
    said = nonstandard or project.settings_file is not None
    if project.main_file.name != MAIN_FILE and not said:
        raise RefusedError(
            f"the robot program's main file is called {MAIN_FILE}, for other tools to find it",
            where=project.main_file.name,
            remedy=f"Rename it to {MAIN_FILE}, deploy it as it is with --nonstandard, "
            f'or say main = "{project.main_file.name}" under [tool.pyfrc] in pyproject.toml.',
        )


def run_tests(project: Project, builtin: bool, output: IO[str], quiet: bool = False) -> bool:
    """Run the project's tests as `pyfrc test` does; whether all have passed.

    :param output: where they print; it must be a file of the system's
    :param quiet: let them print only when not all have passed
    """
    if project.settings_file is not None:
        which = ["--project", str(project.settings_file.parent)]
    else:
        which = ["--main", str(project.main_file)]
    which += [f"--robot-class={project.class_name}"] if project.class_name else []
    command = [sys.executable, "-m", "pyfrc", "test", *which, *(["--builtin"] if builtin else [])]
    output.flush()
    if not quiet:
        return subprocess.run(command, stdout=output, check=False).returncode == 0
    with tempfile.TemporaryFile() as printed:
        passed = subprocess.run([*command, "--quiet"], stdout=printed, check=False).returncode == 0
        if not passed:
            printed.seek(0)
            output.write(printed.read().decode(errors="replace"))
        return passed


class ImportCheck:
    """Whether the project can be imported; found out in a process apart, while other things are done."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self._error: PyfrcError | None = None
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def result(self) -> PyfrcError | None:
        """Wait for it; what is wrong, if anything is."""
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
    load_robot(project)


def go_on_after(failure: str, ask: Questions | None, remedy: str, error: PyfrcError | None = None) -> None:
    """Ask the user whether to deploy all the same.

    :param ask: none where there is nobody to ask
    :raises RefusedError: when the answer is no
    """
    if ask is None:
        raise RefusedError(f"not deployed: {failure}", remedy=remedy) from error
    if not ask.yes(f"{failure[:1].upper()}{failure[1:]}. Deploy all the same?"):
        raise RefusedError(f"not deployed: {failure}") from error
