"""What the documentation shows works: its files are written into a new project, its commands are run there."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(document: str, language: str) -> list[str]:
    text = (ROOT / document).read_text("utf-8")
    return [block for found, block in BLOCK.findall(text) if found == language]


def files(document: str) -> dict[str, str]:
    """The documentation's Python examples, by the file name in their first line."""
    named = {}
    for block in blocks(document, "python"):
        first, _, rest = block.partition("\n")
        assert first.startswith("# "), f"an example that is no file: {block}"
        named[first.removeprefix("# ")] = rest
    return named


def json_files(document: str) -> dict[str, str]:
    """Its JSON examples, by the file name in the line above: JSON has no comments."""
    text = (ROOT / document).read_text("utf-8")
    return dict(re.findall(r"^`([^`]+[.]json)`:\n\n```json\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))


def commands(document: str) -> list[str]:
    return [line.removeprefix("$ ") for block in blocks(document, "console") for line in block.splitlines()]


@pytest.fixture
def new_project(make_project):
    project = make_project({})
    result = project.run("init")
    assert result.code == 0, result.output
    return project


def test_the_examples_in_the_testing_guide_pass(new_project) -> None:
    new_project.write(files("docs/testing.md"))
    (settings,) = blocks("docs/testing.md", "toml")
    with (new_project.path / "pyproject.toml").open("a") as pyproject:
        pyproject.write(settings)
    result = new_project.run("test", "--", "-v")
    assert result.code == 0, result.output
    for file in files("docs/testing.md"):
        assert any(test.startswith(f"{file}::") for test in result.outcomes()), file


PHYSICS = files("docs/physics.md")
PHYSICS_PROJECTS = sorted({file.rpartition("/")[0] for file in PHYSICS if f"/{file}".endswith("/physics.py")})


@pytest.mark.parametrize("directory", PHYSICS_PROJECTS)
def test_the_examples_in_the_physics_guide_pass(directory: str, new_project) -> None:
    new_project.write(PHYSICS | json_files("docs/physics.md"))
    result = new_project.run("test", "--", "-v", cwd=new_project.path / directory)
    assert result.code == 0, result.output
    here = f"{directory}/tests/".removeprefix("/")
    for file in PHYSICS:
        if file.startswith(here):
            assert any(test.startswith(f"{file.removeprefix(directory + '/')}::") for test in result.outcomes()), file


def test_the_examples_in_the_replay_guide_work(new_project) -> None:
    (script,) = re.findall(r"^`(tests/.+[.]jsonl)`:$", (ROOT / "docs/replay.md").read_text("utf-8"), re.MULTILINE)
    new_project.write(files("docs/replay.md") | {script: blocks("docs/replay.md", "json")[0]})
    result = new_project.run("test", "--", "-v")
    assert result.outcomes()["tests/test_replay.py::test_the_script"] == "PASSED", result.output
    for command in commands("docs/replay.md"):
        result = new_project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output


@pytest.mark.parametrize("command", commands("docs/testing.md") + commands("docs/physics.md"))
def test_the_commands_in_the_guides_work(command: str, new_project) -> None:
    program, *arguments = shlex.split(command)
    assert program == "pyfrc"
    result = new_project.run(*arguments)
    assert result.code == 0, result.output


def test_the_readmes_example_passes(new_project) -> None:
    new_project.write(files("README.md"))
    result = new_project.run("test", "--", "-q")
    assert result.code == 0, result.output


def test_the_readmes_commands_exist_in_the_makefile() -> None:
    makefile = (ROOT / "Makefile").read_text("utf-8")
    first = blocks("README.md", "console")[0]
    for line in first.splitlines():
        target = shlex.split(line, comments=True)[2]
        assert re.search(rf"^{target}:", makefile, re.MULTILINE)


@pytest.mark.parametrize(
    "document",
    ["README.md", "benchmarks/README.md", *sorted(f"docs/{file.name}" for file in (ROOT / "docs").glob("*.md"))],
)
def test_links_lead_somewhere(document: str) -> None:
    text = (ROOT / document).read_text("utf-8")
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", text):
        if not target.startswith("http"):
            assert ((ROOT / document).parent / target).exists(), target
