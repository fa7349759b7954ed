"""Campaigns in several parts: on several machines, and after an interruption."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Any

import pytest
import yaml
from loops import for_each

from pyfrc_cli.fuzz import command
from pyfrc_core.fuzz.campaign.corpus import Corpus
from pyfrc_core.fuzz.campaign.kept_guidance import DIRECTORY
from pyfrc_core.project import Project
from pyfrc_core.runtime.scripts.script import InputScript

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


def written(project: Any) -> dict[str, bytes]:
    """The files that a campaign has written, with what is in them."""
    files = (file for file in (project.path / "tests").rglob("*") if file.is_file() and file.suffix != ".pyc")
    return {file.relative_to(project.path).as_posix(): file.read_bytes() for file in sorted(files)}


def copy(make_shared_project: Any) -> Any:
    return make_shared_project({"robot.py": ROBOT, "pyproject.toml": SETTINGS})


@pytest.mark.slow
def test_what_two_machines_have_found_is_put_together(make_shared_project) -> None:
    shards = []
    for number in (1, 2):
        shards.append(copy(make_shared_project))
        result = shards[-1].run("fuzz", "--seed", "4", "--runs", "64", "--shard", f"{number}/2")
        assert (result.code, "32 matches" in result.stdout) == (1, True), result.output
    merged = copy(make_shared_project)
    directories = [str(each.path / "tests") for each in shards]
    result = merged.run("fuzz", "--merge", *directories)
    assert result.code == 1, result.output
    assert "  pyfrc replay tests/fuzz/" in result.stdout
    names = {name for each in shards for name in written(each)}
    assert written(merged).keys() == names
    # A second time, there is nothing to copy.
    assert merged.run("fuzz", "--merge", *directories).code == 0


def test_of_one_failure_the_script_of_the_earliest_match_is_taken(tmp_path: Path) -> None:
    def save(machine: str, name: str, match: int, cause: str, repeats: bool = True) -> None:
        found = {"seed": 1, "match": match, "failure": cause}
        file = tmp_path / machine / ("" if repeats else "not_repeated") / f"{name}.jsonl"
        InputScript((), 20_000 * (1 + match), found=found, repeats=repeats).save(file)

    save("one", "valueerror-robot-f", 9, "ValueError robot.py:1")
    save("two", "valueerror-robot-f", 4, "ValueError robot.py:1")
    save("two", "valueerror-robot-f-2", 6, "ValueError robot.py:2")
    save("two", "keyerror-robot-f", 2, "KeyError robot.py:3", repeats=False)
    (tmp_path / "robot.py").write_text("")
    (tmp_path / "tests").mkdir()
    corpus = Corpus(Project(tmp_path / "robot.py"))
    shards = [tmp_path / "one", tmp_path / "two"]
    entries = corpus.merge(shards)
    assert [(each.file.name, each.script.found["match"]) for each in entries] == [
        ("keyerror-robot-f.jsonl", 2), ("valueerror-robot-f.jsonl", 4), ("valueerror-robot-f-2.jsonl", 6)
    ]  # fmt: skip
    assert [each.file.parent.name for each in entries] == ["not_repeated", "fuzz", "fuzz"]
    assert [each.file.name for each in corpus.all()] == ["valueerror-robot-f-2.jsonl", "valueerror-robot-f.jsonl"]
    assert corpus.merge(shards) == []


@for_each("text", ["0/4", "5/4", "1", "a/b", "/", "1/2/3"])
def test_a_shard_that_does_not_exist(text: str, make_shared_project) -> None:
    result = copy(make_shared_project).run("fuzz", "--shard", text)
    assert result.code == 2
    assert "is not I/N" in result.stderr


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
