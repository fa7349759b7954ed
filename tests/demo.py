"""The deploys of `make demo`: to a virtual robot, changed, deployed again, and rolled back.

``pyfrc virtual-robot -- python tests/demo.py PROJECT`` adds the robot's address. Ends with an error when a step fails.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

PROJECT, ROBOT = sys.argv[1:]

#: Seconds that one command may take.
LIMIT = 300.0


def pyfrc(*words: str) -> None:
    """Run a command about the robot, and show it."""
    words = (*words, "--robot", ROBOT)
    print(f"\n$ pyfrc {' '.join(words)}", flush=True)
    subprocess.run([sys.executable, "-m", "pyfrc", *words], check=True, timeout=LIMIT)


def ask(*words: str) -> dict[str, Any]:
    """Run a command about the robot, and return the result that it has for tools."""
    command = [sys.executable, "-m", "pyfrc", *words, "--robot", ROBOT, "--json"]
    printed = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, timeout=LIMIT).stdout
    result: dict[str, Any] = json.loads(printed.splitlines()[-1])
    return result


def main() -> None:
    """Deploy twice, go back, and see each time that the robot runs what it should."""
    deploy = ("deploy", "--project", PROJECT)
    info = ("deploy-info", "--project", PROJECT)
    robot_file = Path(PROJECT, "robot.py")
    print("\nA virtual robot is running: an SSH server that runs the deployed program in simulation.")
    pyfrc(*deploy)
    first = ask(*info)
    expect(first["running"], "the program does not run")
    source = robot_file.read_text("utf-8")
    try:
        robot_file.write_text(f"{source}\n# A change.\n", "utf-8")
        print(f"\nA comment is added to {robot_file}, and removed again later. Only that file is sent.")
        plan = ask(*deploy, "--dry-run")["plan"]
        expect(plan["files_to_send"] == 1, f"not one file is to be sent, but {plan['files_to_send']}")
        pyfrc(*deploy, "--skip-tests")
    finally:
        robot_file.write_text(source, "utf-8")
    second = ask(*info)
    expect(second["running"] and second["current"] != first["current"], "the new program does not run")
    print("\nAnd back to the program before.")
    pyfrc("deploy", "--project", PROJECT, "--rollback")
    pyfrc(*info)
    last = ask(*info)
    expect(last["running"] and last["current"] == first["current"], "the first program does not run again")
    print("\nDeployed, changed, deployed again, rolled back: this robot runs its first program.")


def expect(condition: object, otherwise: str) -> None:
    """End the demo when a step has failed."""
    if not condition:
        sys.exit(f"the demo has failed: {otherwise}")


try:
    main()
except subprocess.CalledProcessError as failed:
    sys.exit(f"the demo has failed: exit code {failed.returncode}")
