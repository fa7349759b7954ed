"""What the documentation, the templates and messages say about installing pyfrc.

The index has older packages of this name (2026.0.3 and before), which are another program: every line that installs
pyfrc by its name asks for a version that has what the line is about.
"""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from pyfrc_core._version import __version__, requirement

pytestmark = pytest.mark.bare

ROOT = Path(__file__).parents[1]
OLD = "2026.0.3"
PAGE = (ROOT / "docs/how_to/install.md").read_text("utf-8")
#: A line that has pip install something, up to what ends a command in prose, tables and code.
INSTALLS = re.compile(r"pip install ([^`'\n(|&;]+)")
PYFRC = re.compile(r"""(?<![/\\])["']?pyfrc\b(?!-|/)[^"'\s;&]*["']?""")


def block(heading: str, language: str) -> list[str]:
    """Return the lines of the block in this language, below a heading of the page on installing."""
    section = f"\n{PAGE}".partition(f"\n{heading}\n")[2].partition("\n## ")[0]
    found = re.search(rf"^```{language}\n(.*?)^```$", section, re.MULTILINE | re.DOTALL)
    assert found is not None, f"no {language} below {heading}"
    return found[1].splitlines()


def files_with_text() -> list[Path]:
    templates = [file for file in (ROOT / "templates").rglob("*") if file.suffix in (".md", ".yml", ".template")]
    code = [file for package in ("pyfrc", "pyfrc_cli", "pyfrc_core") for file in (ROOT / package).rglob("*.py")]
    return [ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *templates, *code]


def test_what_is_asked_for_is_this_pyfrc_and_not_the_older_program_of_its_name() -> None:
    for needed in map(Requirement, (requirement(), requirement("profile"))):
        assert needed.name == "pyfrc"
        assert needed.specifier.contains(__version__)
        assert not needed.specifier.contains(OLD)
    assert Requirement(requirement("cluster")).extras == {"cluster"}


def test_every_line_that_installs_pyfrc_by_name_asks_for_it_in_quotes_with_its_version() -> None:
    found = 0
    for file in files_with_text():
        for command in INSTALLS.findall(file.read_text("utf-8")):
            for name in PYFRC.findall(command):
                found += 1
                assert name[0] == name[-1] == '"', f"{file}: {command}: a shell takes > for a file"
                extras = Requirement(name.strip('"')).extras
                assert name.strip('"') == requirement(*extras), f"{file}: {command}"
    assert found >= 5


@pytest.mark.parametrize(
    ("language", "activation"), [("bash", "source .venv/bin/activate"), ("powershell", r".venv\Scripts\Activate.ps1")]
)
def test_the_environment_is_made_then_activated_then_filled_then_used(language: str, activation: str) -> None:
    lines = [line for line in block("# Install pyfrc", language) if not line.startswith("#")]
    made, activated, *rest = lines
    assert made.endswith("-m venv .venv")
    assert activated == activation
    install, check = rest
    *command, place = shlex.split(install, posix=language == "bash")
    assert (command, check) == (["pip", "install"], "pyfrc doctor")
    assert place.endswith("pyfrc")


def test_the_wheel_and_the_index() -> None:
    build, install = block("## From a file", "bash")
    assert shlex.split(build)[:3] == ["pip", "wheel", "--no-deps"]
    assert f"/pyfrc-{__version__}-py3-none-any.whl" in install
    assert block("## From the package index", "bash") == [f'pip install "{requirement()}"']
    assert f"up to {OLD}," in PAGE.replace("\n", " ")


def test_the_readme_installs_from_the_checkout_until_the_release_is_on_the_index() -> None:
    section = (ROOT / "README.md").read_text("utf-8").partition("\n## In your own project\n")[2]
    (line,) = re.findall(r"^\$ (pip install .+)$", section, re.MULTILINE)
    assert shlex.split(line, comments=True) == block("# Install pyfrc", "bash")[2].split()
    assert f'pip install "{requirement()}"' in line.partition("#")[2]
