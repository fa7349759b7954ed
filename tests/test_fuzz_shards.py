"""Campaigns in several parts: on several machines, and after an interruption."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

from pyfrc_cli.fuzz import command
from pyfrc_core.fuzz.campaign.kept_guidance import DIRECTORY

SETTINGS = "[tool.pyfrc.fuzz]\nmatch_seconds = 1.5\n"

#: Its last failure needs a restart of the program in the middle of a match.
ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.pad = wpilib.XboxController(0)
            assert wpilib.Preferences.getString("state", "") != str(type(self))

        def teleopPeriodic(self):
            wpilib.Preferences.setString("state", str(type(self)))
            if self.pad.getBButton() and self.pad.getXButton():
                raise ValueError("chord")
            if self.pad.getPOV() == 315:
                {"up": 1}["left"]
    """

EMPTY = "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"


def written(project: Any) -> dict[str, bytes]:
    """The files that a campaign has written, with what is in them."""
    files = (file for file in (project.path / "tests").rglob("*") if file.is_file() and file.suffix != ".pyc")
    return {file.relative_to(project.path).as_posix(): file.read_bytes() for file in sorted(files)}


def guidance(project: Any) -> dict[str, Any]:
    directory = project.path / ".pyfrc/fuzz/corpus"
    return {file.name: json.loads(file.read_text()) for file in sorted(directory.iterdir())}


def copy(make_shared_project: Any) -> Any:
    return make_shared_project({"robot.py": ROBOT, "pyproject.toml": SETTINGS})


#: Two batches: in the second one, each stream goes on from what its first matches have reached.
CAMPAIGN = ("--seed", "4", "--runs", "40")


@pytest.fixture(scope="module")
def whole(make_shared_project) -> Any:
    """A project in which one process has played a whole campaign."""
    project = copy(make_shared_project)
    found = project.run("fuzz", *CAMPAIGN, "-j", "1")
    assert (found.code, "40 matches" in found.stdout) == (1, True), found.output
    return project


@pytest.mark.slow
def test_four_shards_find_together_what_one_machine_finds(whole, make_shared_project, tmp_path: Path) -> None:
    scripts = [name for name in written(whole) if name.endswith(".jsonl")]
    assert (len(scripts), "tests/fuzz/assertionerror-robot-robotinit.jsonl" in scripts) == (3, True)

    shards = []
    for number in (1, 2, 3, 4):
        shard = copy(make_shared_project)
        # More processes than one run scripts while shrinking that are not needed then.
        jobs = "2" if number == 1 else "1"
        result = shard.run("fuzz", *CAMPAIGN, "--shard", f"{number}/4", "-j", jobs)
        assert "10 matches" in result.stdout, result.output
        shards.append(tmp_path / str(number))
        if (shard.path / "tests").is_dir():
            shutil.copytree(shard.path / "tests", shards[-1])
        else:
            shards[-1].mkdir()
    merged = copy(make_shared_project)
    result = merged.run("fuzz", "--merge", *map(str, reversed(shards)))
    assert result.code == 1, result.output
    assert "  pyfrc replay tests/fuzz/" in result.stdout
    assert written(merged) == written(whole)
    # A second time, there is nothing to copy.
    again = merged.run("fuzz", "--merge", *map(str, shards))
    assert (again.code, written(merged)) == (0, written(whole)), again.output


@pytest.mark.slow
def test_an_interrupted_campaign_goes_on_where_it_was(whole, make_shared_project) -> None:
    parts = copy(make_shared_project)
    first = parts.run("fuzz", *CAMPAIGN[:2], "--runs", "32", "-j", "1")
    second = parts.run("fuzz", *CAMPAIGN, "--continue")
    assert re.search("^8 matches, ", second.stdout, re.MULTILINE), second.output
    assert written(parts) == written(whole)
    assert guidance(parts) == guidance(whole)
    # Nothing is found twice.
    replays = [line for line in (first.stdout + second.stdout).splitlines() if "pyfrc replay" in line]
    assert len(replays) == len(set(replays))
    assert (parts.path / ".pyfrc/.gitignore").read_text() == "*\n"


@pytest.mark.slow
def test_after_a_change_of_the_code_matches_that_reach_nothing_are_dropped(make_shared_project) -> None:
    project = copy(make_shared_project)
    project.run("fuzz", "--runs", "8")
    ((name, before),) = guidance(project).items()
    assert name == "seed-0-streams-8.json"
    assert all(stream["played"] == 1 and stream["worthwhile"]["line"] for stream in before["streams"])
    project.write({"robot.py": EMPTY})
    result = project.run("fuzz", "--runs", "16", "--continue")
    assert re.search("^16 matches, ", result.stdout, re.MULTILINE), result.output  # half of them for the second time
    (after,) = guidance(project).values()
    assert after["project"] != before["project"]
    for stream in after["streams"]:
        assert (stream["played"], stream["reached"]) == (2, [])
        assert not any(stream["worthwhile"].values())


def test_a_damaged_file_of_an_earlier_campaign_does_not_matter(make_shared_project) -> None:
    project = copy(make_shared_project)
    project.write({"robot.py": EMPTY})
    project.write({".pyfrc/fuzz/corpus/seed-1-streams-8.json": '{"project": "", "streams": [{"played": 3}]}'})
    result = project.run("fuzz", "--seed", "1", "--runs", "8", "--continue")
    assert re.search("^8 matches, ", result.stdout, re.MULTILINE), result.output


@pytest.mark.parametrize("text", ["0/4", "5/4", "1", "1/9", "a/b", "/", "1/2/3"])
def test_a_shard_that_does_not_exist(text: str, make_shared_project) -> None:
    result = copy(make_shared_project).run("fuzz", "--shard", text)
    assert result.code == 2
    assert "is not I/N" in result.stderr


def test_merge_needs_directories(make_shared_project) -> None:
    result = copy(make_shared_project).run("fuzz", "--merge")
    assert (result.code, "belong together" in result.stderr) == (2, True)


def test_the_nightly_workflow_of_new_projects() -> None:
    workflow = Path(__file__).parents[1] / "templates/base/github/workflows/fuzz.yml"
    steps = yaml.safe_load(workflow.read_text("utf-8"))["jobs"]["fuzz"]["steps"]
    (arguments,) = (shlex.split(step["run"])[4:] for step in steps if "pyfrc fuzz" in step.get("run", ""))
    context = command.make_context("fuzz", arguments)
    # Without --seed and --runs it goes on where the last night ended: with what is kept here.
    assert context.params["seed"] is None is context.params["runs"]
    assert {step["with"]["path"] for step in steps if "actions/cache" in step.get("uses", "")} == {DIRECTORY.as_posix()}


@pytest.mark.slow
def test_github_shows_a_failure_at_its_line(make_shared_project, monkeypatch) -> None:
    robot = "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    def teleopInit(self):\n        {}['50%']\n"
    project = make_shared_project({"robot/robot.py": robot, "robot/pyproject.toml": SETTINGS})
    assert "::error" not in project.run("fuzz", "--project", "robot", "--runs", "2").stdout
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    monkeypatch.setenv("GITHUB_WORKSPACE", str(project.path))
    result = project.run("fuzz", "--project", "robot", "--runs", "2")
    (line,) = [line for line in result.stdout.splitlines() if line.startswith("::")]
    assert line.startswith("::error file=robot/robot.py,line=6,title=pyfrc fuzz::")
    assert "KeyError: '50%25'%0Apyfrc replay " in line
