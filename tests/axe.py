"""What keeps people from using a page, as the program axe-core finds it. It comes from npm: `npm ci`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page

_PROGRAM = Path(__file__).parents[1] / "node_modules" / "axe-core" / "axe.min.js"

#: One text for each element, with axe's own sentences.
_LOOK = """async ([within, rules]) => {
  const only = rules.length ? { runOnly: rules } : {};
  const { violations } = await axe.run(within, { resultTypes: ["violations"], ...only });
  const grave = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
  return grave.flatMap(({ id, impact, help, nodes }) =>
    nodes.map(({ html, failureSummary }) => `${impact}, ${id}: ${help}: ${html.slice(0, 200)}: ${failureSummary}`));
}"""


def missing_axe() -> list[str]:
    """Return what is missing for axe-core."""
    return [] if _PROGRAM.exists() else ["axe-core"]


def barriers(page: Page, within: str = "html", rules: Sequence[str] = ()) -> list[str]:
    """Return what is serious or critical on a page as it is now: rule, element and what to do, in axe's words.

    :param within: a selector of the part of the page to look at
    :param rules: the only ones that are asked for; all without them
    """
    if not page.evaluate("'axe' in window"):
        page.evaluate(_PROGRAM.read_text("utf-8"))
    found: list[str] = page.evaluate(_LOOK, [within, list(rules)])
    return found
