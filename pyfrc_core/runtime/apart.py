"""Robot code in a new interpreter, for commands that must live on whatever it does: end the process, crash, print.

Run as ``python -m pyfrc_core.runtime.apart``, with its job pickled on standard input.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, TypeVar

from ..errors import PyfrcError, RobotCodeError
from ..project import Project

if TYPE_CHECKING:
    from .own_process import LastWords

Answer = TypeVar("Answer")

#: Its output is never read: no letter of it is an error.
ENVIRONMENT = {"PYTHONIOENCODING": "utf-8:backslashreplace"}

_BESIDE_OUR_PACKAGE = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Job:
    """Work for another process.

    :param call: the pickled work and its project, apart, since unpickling it needs `path`
    """

    call: bytes
    path: list[str]
    directory: str
    answer: Path
    words: Path


class _FailedThere(Exception):
    """The traceback of an error in the other process."""

    def __str__(self) -> str:
        return f"\n{self.args[0]}"


def run_interpreter(job: Job) -> int:
    """Run `main` in a new interpreter; tests replace this function by one that starts it faster.

    :return: the exit code; a signal's number, negative
    """
    return subprocess.run(
        [sys.executable, "-m", __name__],
        input=pickle.dumps(job),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        cwd=_BESIDE_OUR_PACKAGE,  # where no module of the user's is in Python's way
        env=os.environ | ENVIRONMENT,
        check=False,
    ).returncode


def run_apart(work: Callable[[Project, LastWords], Answer], project: Project, meanwhile: str) -> Answer:
    """Have another process do `work`, and answer what it answers; nothing that is printed there is seen.

    :param work: a function of a module, whose answer can be pickled; it raises here what it raises there
    :param meanwhile: what robot code interrupts when it ends the process, such as "in the middle of the test"
    :raises RobotCodeError: when the process ends without an answer, naming the user's line
    """
    with TemporaryDirectory(prefix="pyfrc-apart-") as temporary:
        answer, words = Path(temporary, "answer"), Path(temporary, "words")
        # A copy, without what the project has read already.
        job = Job(pickle.dumps((work, replace(project))), sys.path, str(Path.cwd()), answer, words)
        status = run_interpreter(job)
        if not answer.is_file():
            left = words.read_bytes().decode(errors="surrogateescape") if words.is_file() else ""
            from .own_process import explain_end

            raise RobotCodeError(explain_end(left, status, project.files, meanwhile))
        result, error, stack = pickle.loads(answer.read_bytes())
    if stack:
        raise (error or RuntimeError("a mistake in pyfrc itself")) from _FailedThere(stack)
    return result  # type: ignore[no-any-return]


def main() -> None:
    """The other process."""
    job: Job = pickle.load(sys.stdin.buffer)
    sys.path[:] = job.path
    os.chdir(job.directory)
    from .own_process import LastWords, end_processes_of_the_robot, exit_now

    result, error, stack = None, None, ""
    with job.words.open("w+b", buffering=0) as file:
        words = LastWords(file.fileno())
        words.leave_on_crash()
        try:
            work, project = pickle.loads(job.call)
            result = work(project, words)
        except BaseException as raised:
            stack = traceback.format_exc()
            error = raised if isinstance(raised, (PyfrcError, OSError)) else None
        # Whole or not at all.
        beside = job.answer.with_suffix(".part")
        beside.write_bytes(pickle.dumps((result, error, stack)))
        beside.replace(job.answer)
        end_processes_of_the_robot()
        exit_now(0)  # without waiting for what the robot left running


if __name__ == "__main__":
    main()
