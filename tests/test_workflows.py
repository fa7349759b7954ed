"""pyfrc's GitHub workflows and forms parse, every command in them exists, and pyproject.toml claims what they run."""

from __future__ import annotations

import os
import re
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import pytest
import yaml
from make_script import make_script

from pyfrc_cli.main import cli

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[1]
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
MAKEFILE = (ROOT / "Makefile").read_text("utf-8")
GATE = (ROOT / ".ci/run").read_text("utf-8")

#: What a system is called in workflows, and in a classifier.
SYSTEMS = {"ubuntu": "POSIX :: Linux", "windows": "Microsoft :: Windows", "macos": "MacOS"}

#: Options of commands that are not pyfrc's, as far as the workflows use them.
OPTIONS = {
    "pip install": set(),
    "pip wheel": {"--no-deps", "--wheel-dir"},
    "apt-get update": {"--quiet=2"},
    "apt-get install": {"--quiet=2", "--yes"},
}


def parsed(workflow: Path) -> dict[str, Any]:
    document = yaml.safe_load(workflow.read_text("utf-8"))
    assert isinstance(document, dict)
    return document


def jobs() -> Iterator[tuple[str, dict[str, Any]]]:
    for workflow in WORKFLOWS:
        yield from parsed(workflow)["jobs"].items()


JOBS = dict(jobs())


def commands() -> list[list[str]]:
    runs = (step["run"] for job in JOBS.values() for step in job["steps"] if "run" in step)
    return [shlex.split(line) for run in runs for line in run.splitlines()]


COMMANDS = commands()


def matrix(job: str) -> dict[str, list[str]]:
    return JOBS[job]["strategy"]["matrix"]


def unknown_options(arguments: list[str], known: set[str]) -> set[str]:
    return {argument for argument in arguments if argument.startswith("-")} - known


def test_there_are_workflows_for_the_tests_and_the_gate() -> None:
    assert [workflow.name for workflow in WORKFLOWS] == ["gate.yml", "publish.yml", "test.yml"]


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_every_command_in_the_workflows_exists(command: list[str]) -> None:
    while command[0] in ("sudo", "env") or re.fullmatch(r"\w+=.*", command[0]):
        command = command[1:]
    if command[:2] == ["python", "-m"]:
        command = command[2:]
    program, *arguments = command
    if program == "make":
        for target in (argument for argument in arguments if "=" not in argument):
            assert re.search(rf"^{target}:", MAKEFILE, re.MULTILINE), target
        for variable in (argument.partition("=")[0] for argument in arguments if "=" in argument):
            assert re.search(rf"^{variable} \?=", MAKEFILE, re.MULTILINE), variable
    elif program == "python":
        assert arguments[0] == "make.py"
        assert arguments[1] in make_script.TASKS
    elif program == "pyfrc":
        context = click.Context(cli)
        found = cli if arguments[0] == "--help" else cli.get_command(context, arguments[0])
        assert found is not None, arguments[0]
        known = {option for parameter in found.params for option in parameter.opts} | {"--help"}
        assert unknown_options(arguments, known) == set()
    elif program == ".ci/run":
        assert os.access(ROOT / program, os.X_OK)
    else:
        assert unknown_options(arguments, OPTIONS[f"{program} {arguments[0]}"]) == set()


@pytest.mark.parametrize("job", ["linux", "windows-and-macos"])
def test_every_system_runs_the_two_commands_of_the_readme(job: str) -> None:
    runs = [step["run"] for step in JOBS[job]["steps"] if "run" in step]
    with_make, without = (["make demo", "make test"], ["make.py demo", "make.py test"])
    readme = (ROOT / "README.md").read_text("utf-8")
    assert all(f"$ {command} " in readme for command in with_make)
    assert all(f"`py {command}`" in readme for command in without)
    if job == "linux":
        assert runs == [f"{command} PYTHON=python" for command in with_make]
    else:
        assert runs == [f"python {command}" for command in without]


def pythons_of(job: str) -> set[str]:
    (setup,) = (step for step in JOBS[job]["steps"] if "setup-python" in step.get("uses", ""))
    return set(setup["with"]["python-version"].split())


def test_the_gate_and_its_shards_get_each_python_that_they_ask_for() -> None:
    required = set(re.findall(r"python_of (3\.\d+)\)", GATE))
    assert len(required) >= 2
    assert required <= pythons_of("gate")
    (shards,) = re.findall(r"^shards=\(\$\{2:-(.*)\}\)$", GATE, re.MULTILINE)
    assert shards.split() == matrix("nightly")["shard"]
    assert required | {each for each in shards.split() if each.startswith("3.")} <= pythons_of("nightly")


def test_the_workflows_run_every_version_that_is_claimed() -> None:
    claimed = {found[1] for each in PROJECT["classifiers"] if (found := re.search(r"Python :: (3\.\d+)$", each))}
    assert PROJECT["requires-python"].removeprefix(">=") in claimed
    for job in ("linux", "windows-and-macos", "wheel"):
        assert claimed <= set(matrix(job)["python"])


def test_the_gate_runs_every_version_that_is_claimed() -> None:
    claimed = {found[1] for each in PROJECT["classifiers"] if (found := re.search(r"Python :: (3\.\d+)$", each))}
    here = "3.11"  # the version that runs the whole suite
    assert claimed <= {here, *re.findall(r"3\.\d+", GATE)}


def test_only_systems_whose_jobs_must_pass_are_claimed() -> None:
    claimed = {
        each.removeprefix("Operating System :: ")
        for each in PROJECT["classifiers"]
        if each.startswith("Operating System :: ")
    }
    must_pass = {
        SYSTEMS[str(job["runs-on"]).partition("-")[0]]
        for job in JOBS.values()
        if not job.get("continue-on-error") and "matrix" not in job["runs-on"]
    }
    assert claimed == must_pass


def test_windows_and_macos_may_fail_until_they_have_passed_once() -> None:
    assert JOBS["windows-and-macos"]["continue-on-error"] is True
    assert matrix("windows-and-macos")["system"] == ["windows-latest", "macos-latest"]
    assert "ubuntu-latest" in JOBS["wheel"]["continue-on-error"]
