"""The reference: its tables are made from the code, and the pages that the program's messages name exist."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import click
import pytest

from pyfrc_cli.main import COMMANDS, cli

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))

from generated import COMMON, MARK, TABLES, expanded  # noqa: E402

DOCS = ROOT / "docs"
PAGES = {file.relative_to(DOCS).as_posix(): file.read_text("utf-8") for file in DOCS.rglob("*.md")}


@pytest.mark.parametrize("page", [page for page, text in PAGES.items() if "<!-- generated" in text])
def test_each_table_can_be_made(page: str) -> None:
    assert PAGES[page].count("<!-- generated") == len(MARK.findall(PAGES[page]))
    text = expanded(PAGES[page])
    for table in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        columns = {len(re.findall(r"(?<!\\)\|", row)) for row in table.splitlines()}
        assert len(columns) == 1, table
    assert "| |" not in text.partition("generated")[2]


def test_an_option_of_a_command_is_in_its_table() -> None:
    for name, (module, _) in COMMANDS.items():
        command = cli.get_command(click.Context(cli), name)
        table = TABLES["options"](name)
        for each in command.params:
            if isinstance(each, click.Option) and not each.hidden and not COMMON & set(each.opts):
                assert f"{each.opts[-1]}" in table, (module, each.opts)


def test_messages_name_pages_that_exist() -> None:
    named = {}
    for package in ("pyfrc", "pyfrc_cli", "pyfrc_core"):
        for file in (ROOT / package).rglob("*.py"):
            for page in re.findall(r"docs/([\w/]+\.md)", file.read_text("utf-8")):
                named[page] = file
    assert len(named) >= 3
    assert {page: file for page, file in named.items() if page not in PAGES} == {}
