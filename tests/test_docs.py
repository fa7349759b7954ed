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


@pytest.mark.parametrize(
    "command",
    [line.removeprefix("$ ") for block in blocks("docs/testing.md", "console") for line in block.splitlines()],
)
def test_the_commands_in_the_testing_guide_work(command: str, new_project) -> None:
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


@pytest.mark.parametrize("document", ["README.md", "docs/testing.md", "docs/architecture.md", "benchmarks/README.md"])
def test_links_lead_somewhere(document: str) -> None:
    text = (ROOT / document).read_text("utf-8")
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", text):
        if not target.startswith("http"):
            assert ((ROOT / document).parent / target).exists(), target
