"""The documentation as web pages: `docs/` builds without a warning, and lists every documented name."""

from __future__ import annotations

import importlib
import pkgutil
import re
import subprocess
import sys
import zlib
from pathlib import Path

import pytest
from test_specification_names import FIXTURES, SPECIFICATION

import pyfrc

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[1]
COMMAND = ("sphinx", "-q", "-E", "-W", "--keep-going")

NAMES = [f"{module}.{name}" for module, name, _ in SPECIFICATION]
NAMES += [f"pyfrc.test_support.pytest_plugin.PyFrcPlugin.{name}" for name in FIXTURES]


@pytest.fixture(scope="module")
def build(tmp_path_factory: pytest.TempPathFactory) -> tuple[subprocess.CompletedProcess[str], Path]:
    """What building them said, and where they are."""
    site = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", *COMMAND, "docs", str(site)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return done, site


def listed(site: Path) -> dict[str, str]:
    """The Python names that the pages have entries for, and where; from what other projects' documentation links by."""
    *_, packed = (site / "objects.inv").read_bytes().split(b"\n", 4)
    entries = re.findall(r"^(\S+) py:\w+ -?\d+ (\S+) ", zlib.decompress(packed).decode("utf-8"), flags=re.MULTILINE)
    return {name: place.partition("#")[0] for name, place in entries}


def test_it_builds_without_a_warning(build: tuple[subprocess.CompletedProcess[str], Path]) -> None:
    done, site = build
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert (site / "index.html").is_file()


def test_the_api_pages_list_every_documented_name(build: tuple[subprocess.CompletedProcess[str], Path]) -> None:
    entries = listed(build[1])
    assert [name for name in NAMES if not entries.get(name, "").startswith("reference/api/")] == []


def test_they_list_everything_that_is_public(build: tuple[subprocess.CompletedProcess[str], Path]) -> None:
    modules = [name for _, name, _ in pkgutil.walk_packages(pyfrc.__path__, "pyfrc.") if name != "pyfrc.__main__"]
    names = [
        f"{module}.{name}"
        for module in (*modules, "pyfrc_core.hal", "pyfrc_core.sim")
        for name in getattr(importlib.import_module(module), "__all__", ())
    ]
    assert len(names) > 60
    entries = listed(build[1])
    assert [name for name in names if name not in entries] == []


def test_each_page_loads_without_a_network_in_a_hundred_kilobytes(
    build: tuple[subprocess.CompletedProcess[str], Path],
) -> None:
    """With its styles, scripts and pictures, as a server compresses them."""
    pages = sorted(build[1].rglob("*.html"))
    assert len(pages) > 20
    for page in pages:
        text = page.read_text("utf-8")
        files = re.findall(r"<(?:script|img|iframe)[^>]+src=\"([^\"]+)|<link[^>]+stylesheet[^>]+href=\"([^\"]+)", text)
        parts = [page, *(page.parent / (script or style).partition("?")[0] for script, style in files)]
        sizes = {part.name: len(zlib.compress(part.read_bytes())) for part in parts}  # a file: nothing is elsewhere
        assert sum(sizes.values()) <= 100_000, (page, sizes)
        assert "copy.js" in sizes


def test_links_between_the_pages_lead_somewhere(build: tuple[subprocess.CompletedProcess[str], Path]) -> None:
    texts = {page: page.read_text("utf-8") for page in build[1].rglob("*.html")}
    for page, text in texts.items():
        for target in re.findall(r"<a [^>]*href=\"([^\"]+)", text):
            name, _, anchor = target.partition("#")
            if not re.match(r"\w+:", target):
                file = (page.parent / name).resolve() if name else page
                assert file.exists(), (page, target)
                assert not anchor or f'id="{anchor}"' in texts[file], (page, target)


def test_make_builds_them_the_same_way() -> None:
    command = ", ".join(f'"{word}"' for word in (*COMMAND, "docs", "build/docs"))
    assert f"environment.run({command})" in (ROOT / "make.py").read_text("utf-8")
