"""Try an installed pyfrc as its user: every template and every command (`.ci/run --nightly wheel`).

PYTHON tests/installed_wheel.py DIRECTORY      with the Python of an environment that has nothing but the wheel
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

SHORT = "\n[tool.pyfrc.match]\nautonomous = 2\npause = 1\nteleop = 3\n\n[tool.pyfrc.fuzz]\nmatch_seconds = 3\n"

#: What each command does in the project of the default template; `{}` is a directory for what they write.
COMMANDS = """
test --coverage
test --record {}/recordings
sim --ui none --mode auto --seconds 1 --record {}/auto.jsonl --wpilog {}/auto.wpilog
sim --ui none --log {}/auto.wpilog
replay {}/auto.jsonl --page {}/auto.html
view {}/auto.wpilog --page {}/log.html
fuzz --seed 1 --runs 2
coverage test
profile test
add-tests
create-physics
config check
doctor --no-robot
sync --help
migrate --help
console --help
deploy-info --help
undeploy --help
virtual-robot --directory {}/robot -- pyfrc deploy --skip-tests --robot
virtual-robot --directory {}/robot -- pyfrc logs --robot
"""

LINES = [line.split() for line in COMMANDS.strip().splitlines()]

#: The commands that are tried: these, and what makes the projects.
TRIED = {"init", *(line[0] for line in LINES), *(line[line.index("pyfrc") + 1] for line in LINES if "pyfrc" in line)}


def run(*command: str, cwd: Path) -> None:
    """Run pyfrc; end this program if it fails."""
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    done = subprocess.run(["pyfrc", *command], cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    print("ok" if done.returncode == 0 else "FAILED", "pyfrc", *command, flush=True)
    if done.returncode:
        sys.exit(f"exit code {done.returncode}\n{done.stdout}{done.stderr}")


def main(directory: Path) -> None:
    """Try everything."""
    from pyfrc_core.scaffold import DEFAULT, TEMPLATES

    assert "site-packages" in str(sys.modules["pyfrc_core"].__file__), "pyfrc is not installed here"
    for template in TEMPLATES:
        run("init", template, "--template", template, "--team", "4711", cwd=directory)
        with (directory / template / "pyproject.toml").open("a", encoding="utf-8") as settings:
            settings.write(SHORT)
        run("test", cwd=directory / template)
    (directory / "out").mkdir()
    for line in LINES:
        run(*(word.replace("{}", str(directory / "out")) for word in line), cwd=directory / DEFAULT)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
