"""Create an environment with pyfrc, and run a task in it. The Makefile calls this; it needs no make itself.

    python3 make.py demo                      on Windows: py make.py demo
    python3 make.py test [options of pytest]

Only the standard library; and an old Python must get as far as the sentence that it is too old.
"""

from __future__ import annotations

import argparse
import os
import runpy
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

OLDEST = (3, 10)
ROOT = Path(__file__).resolve().parent


class Environment:
    """A virtual environment in a directory."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self.python = self.program("python")

    def program(self, name: str) -> str:
        """Return the path of one of its programs."""
        windows = sys.platform == "win32"
        return str(self.directory / ("Scripts" if windows else "bin") / (f"{name}.exe" if windows else name))

    def install(self, group: str) -> None:
        """Install pyfrc, unless that was done since pyproject.toml has changed; create the environment if necessary.

        :param group: the dependency group of pyproject.toml to install; empty for none
        """
        self._create()
        done = [self.directory / name for name in (["installed", f"installed-{group}"] if group else ["installed"])]
        if done[-1].exists() and done[-1].stat().st_mtime >= (ROOT / "pyproject.toml").stat().st_mtime:
            return
        what = "pyfrc, WPILib and the tools for pyfrc's tests" if group else "pyfrc and WPILib"
        print(f"Installing {what} in {self.directory}, from the network: this may take a few minutes.", flush=True)
        if group:  # older ones know no groups
            self.run("pip", "install", "--quiet", "--upgrade", "pip>=25.1")
        self.run("pip", "install", "--quiet", "--editable", ".", *(["--group", group] if group else []))
        for file in done:
            file.touch()

    def run(self, *module: str) -> None:
        """Run a module; end this process if it fails."""
        run([self.python, "-m", *module])

    def _create(self) -> None:
        if Path(self.python).exists():
            return
        if sys.version_info < OLDEST:
            other = "py -3.13 make.py" if sys.platform == "win32" else "make PYTHON=python3.13"
            sys.exit(f"pyfrc needs Python 3.10 or newer; if you have one: {other}")
        try:
            run([sys.executable, "-m", "venv", str(self.directory)])
        except SystemExit:  # Debian's Python creates one without pip if python3-venv is missing
            shutil.rmtree(self.directory, ignore_errors=True)
            raise


def run(command: Sequence[str]) -> None:
    """Print a command, and run it. End this process with its exit code if it fails."""
    line = subprocess.list2cmdline(command) if sys.platform == "win32" else " ".join(map(shlex.quote, command))
    print(line, flush=True)
    # Without compiled modules, each of many processes compiles the tests and pytest's plugins again.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    # Ctrl-C reaches every process of a terminal: this one ends when the command has.
    before = signal.signal(signal.SIGINT, lambda number, frame: None)
    try:
        with subprocess.Popen(command, env=environment) as process:
            code = process.wait()
    finally:
        signal.signal(signal.SIGINT, before)
    if code:
        sys.exit(code if code > 0 else 128 - code)


def demo(environment: Environment, arguments: Sequence[str]) -> None:
    """Create a robot project in demo/, run its tests, deploy it to a virtual robot, change it, roll back."""
    if not Path("demo").is_dir():
        environment.run("pyfrc", "init", "demo")
    environment.run("pyfrc", "test", "--project", "demo", "--coverage")
    robot = ("pyfrc", "virtual-robot", "--directory", "demo/.pyfrc/virtual-robot", "--fresh", "--")
    environment.run(*robot, environment.python, "tests/demo.py", "demo")


def test(environment: Environment, arguments: Sequence[str]) -> None:
    """Run pyfrc's own tests, with options for pytest."""
    # Two more than the number of processors, because many tests wait for other programs.
    workers = str(2 + (os.cpu_count() or 1))
    environment.run("pytest", "-n", workers, "--dist", "worksteal", *arguments)


def test_like_windows(environment: Environment, arguments: Sequence[str]) -> None:
    """Run the tests that are about what Windows lacks or does otherwise, on Linux, like Windows."""
    _test_like(environment, "windows", arguments)


def test_like_macos(environment: Environment, arguments: Sequence[str]) -> None:
    """The same for macOS."""
    _test_like(environment, "macos", arguments)


def _test_like(environment: Environment, system: str, arguments: Sequence[str]) -> None:
    program = (environment.python, "tests/on_another_system.py", system)
    run([*program, "-n", str(os.cpu_count() or 1), "--dist", "worksteal", *arguments])


def check(environment: Environment, arguments: Sequence[str]) -> None:
    """Check style, types, and which room imports which."""
    environment.run("ruff", "check", ".")
    # Text files of unnamed encoding: on Windows, they are cp1252.
    environment.run("ruff", "check", "--quiet", "--preview", "--select", "PLW1514", ".")
    environment.run("ruff", "format", "--check", ".")
    environment.run("mypy")
    run([environment.program("lint-imports"), "--no-logo"])


def check_platforms(environment: Environment, arguments: Sequence[str]) -> None:
    """Check the types as on Windows and on macOS: which names their Python lacks."""
    # Libraries are the same there: to look into them, and to check what they make known, would take most of the time.
    without = ("--no-site-packages", "--ignore-missing-imports", "--allow-subclassing-any", "--no-warn-return-any")
    unchecked = (*without, "--no-warn-unused-ignores", "--allow-untyped-decorators")
    for system in ("win32", "darwin"):
        environment.run("mypy", "--platform", system, "--cache-dir", f".mypy_cache/{system}", *unchecked)


def docs(environment: Environment, arguments: Sequence[str]) -> None:
    """Build the documentation with the API reference in build/docs, with warnings as errors."""
    environment.run("sphinx", "-q", "-E", "-W", "--keep-going", "docs", "build/docs")


def dist(environment: Environment, arguments: Sequence[str]) -> None:
    """Build the wheel and the source distribution in build/dist, and check them."""
    version = runpy.run_path("pyfrc_core/_version.py")["__version__"]
    if arguments and list(arguments) != [f"v{version}"]:
        sys.exit(f"The tag is {' '.join(arguments)}, and the version in pyfrc_core/_version.py is {version}.")
    shutil.rmtree("build/dist", ignore_errors=True)
    environment.run("build", "--outdir", "build/dist")
    environment.run("twine", "check", "--strict", *sorted(map(str, Path("build/dist").iterdir())))


def templates_2027(environment: Environment, arguments: Sequence[str]) -> None:
    """Make templates/2027 from the templates of 2026 with pyfrc migrate."""
    run([environment.python, "tests/make_2027.py", *arguments])


def next_preview(environment: Environment, arguments: Sequence[str]) -> None:
    """Run season 2027's tests with the newest preview in a new environment, and print which names it has changed."""
    newest = Environment(Path(".venv-next"))
    shutil.rmtree(newest.directory, ignore_errors=True)
    newest.install("dev-2027")
    run([newest.python, "tests/next_preview.py", *arguments])


def mutants(environment: Environment, arguments: Sequence[str]) -> None:
    """Change pyfrc in one place at a time, and see whether a test fails."""
    run([environment.python, "tests/mutants.py", *arguments])


def install(environment: Environment, arguments: Sequence[str]) -> None:
    """Create the environment with the tools for pyfrc's tests, and do no more."""


TASKS: dict[str, Callable[[Environment, Sequence[str]], None]] = {
    task.__name__.replace("_", "-"): task
    for task in (
        *(
            demo,
            test,
            test_like_windows,
            test_like_macos,
            check,
            check_platforms,
            docs,
            dist,
            templates_2027,
            next_preview,
            mutants,
            install,
        ),
    )
}


#: Those that take arguments.
WITH_OPTIONS = ("dist", "test", "test-like-windows", "test-like-macos", "templates-2027", "next-preview", "mutants")


def main(words: Sequence[str]) -> None:
    """Run one task."""
    listed = "\n".join(f"  {name:17} {task.__doc__}" for name, task in TASKS.items())
    parser = argparse.ArgumentParser(
        prog="make.py", description=f"tasks:\n{listed}", formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--venv", default=".venv", help="the directory of the environment (%(default)s)")
    parser.add_argument("--group", default="dev", help="the group of pyproject.toml with the tools (%(default)s)")
    parser.add_argument("task", choices=TASKS, metavar="TASK")
    parser.add_argument(
        "arguments",
        nargs=argparse.REMAINDER,
        metavar="...",
        help="for the tests: options of pytest; for dist: the tag; for templates-2027: --patches; for mutants: --help",
    )
    options = parser.parse_args(words)
    if options.arguments and options.task not in WITH_OPTIONS:
        parser.error(f"{options.task} takes no arguments")
    os.chdir(ROOT)
    environment = Environment(Path(options.venv))
    if options.task != "next-preview":
        environment.install("" if options.task == "demo" else options.group)
    TASKS[options.task](environment, options.arguments)


if __name__ == "__main__":
    main(sys.argv[1:])
