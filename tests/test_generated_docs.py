"""The reference: its tables are made from the code, and the pages that the program's messages name exist."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import click
from loops import for_each

from pyfrc_cli.main import COMMANDS, cli

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))

from generated import COMMON, MARK, TABLES, expanded  # noqa: E402

DOCS = ROOT / "docs"
PAGES = {file.relative_to(DOCS).as_posix(): file.read_text("utf-8") for file in DOCS.rglob("*.md")}


@for_each("page", [page for page, text in PAGES.items() if "<!-- generated" in text])
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


def test_a_page_begins_with_whom_it_is_for() -> None:
    for page, text in PAGES.items():
        if page.partition("/")[0] in ("tutorials", "how_to", "reference", "explanation") and "/api/" not in page:
            first = text.partition("\n\n")[2]
            assert first.startswith("For "), page


def test_pages_are_short() -> None:
    """A how-to has two screens at most; a page of the reference may be a table."""
    sizes = {page: len(text.encode()) for page, text in PAGES.items()}
    for page, size in sizes.items():
        assert size <= (5_400 if page.startswith("how_to/") else 12_000), (page, size)
    too_much = sum(sizes.values()) - 230_000
    longest = sorted(sizes, key=lambda page: sizes[page])[-5:]
    assert too_much <= 0, f"the manual is {too_much} bytes too long: shorten a page, such as {', '.join(longest)}"


def test_every_page_is_reached_from_the_front_page() -> None:
    listed = re.findall(r"^(\w+/[\w/*]+)$", PAGES["index.md"], re.MULTILINE)
    found = [page.relative_to(DOCS).as_posix() for name in listed for page in DOCS.glob(f"{name}.md")]
    assert sorted(found) == sorted(page for page in PAGES if "/" in page and ("/api/" not in page or "index" in page))


def test_a_test_reads_each_page_with_commands_or_examples() -> None:
    tests = "".join(file.read_text("utf-8") for file in (ROOT / "tests").rglob("test_*.py"))
    with_code = [page for page, text in PAGES.items() if re.search("^```(?:console|python)$", text, re.MULTILINE)]
    assert len(with_code) > 30
    assert [page for page in with_code if page not in tests] == []
    indented = [page for page, text in PAGES.items() if re.search("^ +```(?:console|python)$", text, re.MULTILINE)]
    assert indented == [], "the tests do not find these"


def test_names_are_spelled_as_their_owners_do() -> None:
    names = "roboRIO SystemCore WPILib NetworkTables PathPlanner PhotonVision AdvantageScope Shuffleboard navX CANcoder"
    for page, text in PAGES.items():
        prose = re.sub(r"^```.*?^```|`[^`\n]*`|\]\([^)]*\)", "", text, flags=re.MULTILINE | re.DOTALL)
        for name in names.split():
            found = set(re.findall(rf"\b{name}\b(?!-)", prose, re.IGNORECASE)) - {name, name.lower()}
            assert not found, (page, found)
