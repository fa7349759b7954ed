"""Export the robot project of another git commit to a temporary directory."""

from __future__ import annotations

import subprocess
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from ...errors import UsageError
from ...project import Project


@dataclass(frozen=True)
class Revision:
    """A commit, exported.

    :param project: the robot project as it was
    :param name: the short hash and the subject of the commit
    """

    project: Project
    name: str


@contextmanager
def exported(project: Project, revision: str) -> Iterator[Revision]:
    """Export a commit until the context ends; neither the work tree nor the index is touched.

    :raises UsageError: when there is no git, no repository or no such commit, or the commit has no robot program
    """
    top = Path(_git(project.root, "rev-parse", "--show-toplevel", otherwise="this project is in no git repository"))
    missing = f"there is no commit {revision!r}"
    commit = _git(
        top, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}", otherwise=missing
    )
    name = _git(top, "log", "-1", "--format=%h %s", commit, otherwise=missing)
    with tempfile.TemporaryDirectory(prefix="pyfrc-against-") as temporary:
        archive, directory = Path(temporary, "commit.tar"), Path(temporary, "commit").resolve()
        _git(top, "archive", "--format=tar", f"--output={archive}", commit, otherwise=f"{revision} cannot be exported")
        with tarfile.open(archive) as tar:
            if hasattr(tarfile, "data_filter"):
                tar.extractall(directory, filter="data")
            else:  # Python before 3.10.12
                tar.extractall(directory)
        main_file = directory / project.main_file.resolve().relative_to(top.resolve())
        if not main_file.is_file():
            raise UsageError(f"commit {name} has no {project.main_file.name} in this directory")
        settings_file = project.settings_file and directory / project.settings_file.resolve().relative_to(top.resolve())
        yield Revision(replace(project, main_file=main_file, settings_file=settings_file), name)


def _git(directory: Path, *arguments: str, otherwise: str) -> str:
    """Return the output of git.

    :raises UsageError: with the text `otherwise` when git fails
    """
    command = ["git", "-C", str(directory), *arguments]
    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8", errors="replace"
        )
    except OSError:
        raise UsageError("git was not found", remedy="--against compares with a commit: install git.") from None
    if done.returncode != 0:
        said = done.stderr.strip().removeprefix("fatal: ")
        raise UsageError(f"{otherwise} ({said})" if said else otherwise)
    return done.stdout.strip()
