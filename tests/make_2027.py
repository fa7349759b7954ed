"""Make the templates of 2027: what `pyfrc migrate` makes of those of 2026, changed by one small patch each.

    make templates-2027                  # after a change to a template or to migrate: writes templates/2027
    make templates-2027 ARGS=--patches   # after a change by hand in templates/2027: writes tests/patches_2027/templates

A patch begins with the reasons for its differences. Those in `tests/patches_2027/robots` are written by hand, for some
robots of `tests/robots` (`season_2027/test_migrated_robots.py`).
"""

from __future__ import annotations

import difflib
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from pyfrc_core.migrate.migration import migrate

TESTS = Path(__file__).parent
TEMPLATES = TESTS.parent / "templates"
OF_2027 = TEMPLATES / "2027"
PATCHES = TESTS / "patches_2027"

#: The templates that both seasons have.
NAMES = sorted(path.parent.name for path in TEMPLATES.glob("*/robot.py"))


def main(arguments: list[str]) -> int:
    """Write what the arguments ask for, and return the exit code."""
    for name in NAMES:
        try:
            if arguments == ["--patches"]:
                write_patch(name)
            else:
                write_template(name)
        except PatchError as error:
            print(error, file=sys.stderr)
            return 1
    return 0


def write_template(name: str) -> None:
    """Write `templates/2027/NAME`."""
    made = template_of_2027(name)
    shutil.rmtree(OF_2027 / name, ignore_errors=True)
    for file, text in made.items():
        (OF_2027 / name / file).parent.mkdir(parents=True, exist_ok=True)
        (OF_2027 / name / file).write_text(text, "utf-8", newline="\n")


def write_patch(name: str) -> None:
    """Write the differences between what migrate makes and `templates/2027/NAME` into the template's patch."""
    before = migrated_template(name)
    after = {**texts(TEMPLATES / name), **texts(OF_2027 / name)}
    hunks = ""
    for file, text in before.items():
        lines = text.splitlines(keepends=True), after[file].splitlines(keepends=True)
        hunks += "".join(difflib.unified_diff(*lines, f"a/{file}", f"b/{file}", n=2))
    patch = PATCHES / f"templates/{name}.patch"
    if hunks:
        patch.write_text(reasons(f"templates/{name}") + hunks, "utf-8", newline="\n")
    else:
        patch.unlink(missing_ok=True)


def template_of_2027(name: str) -> dict[str, str]:
    """Return the files of `templates/2027/NAME`: those that are not as in 2026."""
    files = migrated_template(name)
    apply_patch(f"templates/{name}", files)
    before = texts(TEMPLATES / name)
    return {file: text for file, text in files.items() if text != before[file]}


def migrated_template(name: str) -> dict[str, str]:
    """Return what migrate makes of a template's files, with imports sorted and lines broken as in all templates."""
    with TemporaryDirectory() as directory:
        project = Path(shutil.copytree(TEMPLATES / name, Path(directory, name), ignore=_CACHES))
        names = texts(project)
        migrate(project).write()
        for command in (["check", "--fix-only", "--select", "I,F401"], ["format"]):
            ruff = [sys.executable, "-m", "ruff", *command, "--quiet", "--no-cache"]
            subprocess.run([*ruff, "--config", str(TEMPLATES / "ruff.toml"), name], cwd=directory, check=True)
        return {file: text for file, text in texts(project).items() if file in names}


class PatchError(Exception):
    """A patch does not fit."""


def apply_patch(name: str, files: dict[str, str]) -> None:
    """Change files as a patch says. Each of its hunks must fit at one place; the line numbers do not matter.

    :param name: of the patch, such as `templates/tank`; without one, nothing changes
    :raises PatchError: with the hunk that does not
    """
    for part in re.split(r"^--- a/", _patch(name), flags=re.MULTILINE)[1:]:
        header, *hunks = re.split(r"^@@.*\n", part, flags=re.MULTILINE)
        file = header.split()[0]
        for hunk in hunks:
            lines = hunk.splitlines(keepends=True)
            old, new = ("".join(line[1:] for line in lines if line[0] in kinds) for kinds in (" -", " +"))
            if files.get(file, "").count(old) != 1:
                raise PatchError(
                    f"tests/patches_2027/{name}.patch does not fit {file} any more:\n{hunk}"
                    "Correct this hunk or remove it. Then run: make templates-2027"
                )
            files[file] = files[file].replace(old, new)


def reasons(name: str) -> str:
    """Return how a patch begins: with the reasons for its differences."""
    return re.split(r"^--- a/", _patch(name), maxsplit=1, flags=re.MULTILINE)[0]


def _patch(name: str) -> str:
    file = PATCHES / f"{name}.patch"
    return file.read_text("utf-8") if file.is_file() else ""


_CACHES = shutil.ignore_patterns("__pycache__", ".*")


def texts(directory: Path) -> Mapping[str, str]:
    """Return the texts of a directory's files, by their names with `/`."""
    files = (file for file in sorted(directory.rglob("*")) if file.is_file() and "__pycache__" not in file.parts)
    # Bytes, since read_text hides how lines end.
    return {file.relative_to(directory).as_posix(): file.read_bytes().decode() for file in files}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
