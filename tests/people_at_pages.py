"""Fixtures of tests with a browser: a browser, a simulation for the tests of a module, and a person at its page."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from browser_pages import Seen
    from playwright.sync_api import Browser
    from web_pages import Served


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """One browser for the tests of a module, which are skipped where there is none."""
    from browser_pages import missing_browser, open_browser
    from skips import require

    require("the page of pyfrc sim in a browser", missing_browser())
    with open_browser() as browser:
        yield browser


@pytest.fixture(scope="module")
def server(make_shared_project: Any) -> Iterator[Served]:
    """A simulation of `ROBOT` in real time, for the tests of a module."""
    from browser_pages import ROBOT
    from web_pages import served

    with served(make_shared_project(ROBOT), speed=1, paused=False) as server:
        yield server


@pytest.fixture
def person(browser: Browser, server: Served) -> Iterator[Seen]:
    """A new person at the page."""
    from browser_pages import page_of

    with page_of(browser, server) as person:
        yield person
