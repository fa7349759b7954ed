"""The page as one HTML file: its modules, styles, fonts and pictures are in it, so that it needs no server.

Modules import each other by names such as ``#js/model.js``, which an import map turns into addresses: those of the
server in `index.html`, and ``data:`` URLs with the modules themselves in a single file. The Content-Security-Policy of
a single file trusts scripts by a nonce, which is new for each file. Modules inherit it from the script that imports
them, so no other ``data:`` URL is trusted. Styles are trusted by their hash.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
import secrets
from functools import cache
from pathlib import Path

from ....config.pictures import picture_kind

#: The page's files.
PAGE = Path(__file__).with_name("page")

_MAP = re.compile(r'[ ]*<script type="importmap">(?P<map>.*?)</script>\n')
_MAIN = '    <script type="module" src="/static/js/main.js"></script>\n'
_URL = re.compile(r'url\("(?P<file>[^"]+)"\)')
_STYLES = re.compile(r'[ ]*<link rel="stylesheet" href="/static/(?P<file>[^"]+)">\n')
_TYPES = {".woff2": "font/woff2", ".svg": "image/svg+xml", ".js": "text/javascript", ".mjs": "text/javascript"}


def single_file(title: str, data: bytes) -> str:
    """Return the page with a recorded run in it.

    :param title: plain ASCII text of pyfrc's own
    :param data: the run, as `js/recorded.js` reads it
    """
    styles, nonce = _styles(), secrets.token_urlsafe(24)
    policy = (
        f"default-src 'none'; script-src 'nonce-{nonce}'; style-src '{_hash(styles)}'; img-src data: blob:; "
        "font-src data:; base-uri 'none'; form-action 'none'"
    )
    text = _MAP.sub("", _STYLES.sub("", _index()))
    run = base64.b64encode(data).decode()
    for place, new in (
        (
            '<meta charset="utf-8">',
            f'<meta charset="utf-8">\n    <meta http-equiv="Content-Security-Policy" content="{policy}">',
        ),
        ("<title>pyfrc sim</title>", f"<title>{title}</title>"),
        ('href="/static/icon.svg"', f'href="{data_url(PAGE / "icon.svg")}"'),
        (_MAIN, f"    <style>{styles}</style>\n"),
        (
            "  </body>",
            f'    <script type="application/gzip" id="run">{run}</script>\n'
            f'    <script type="text/plain">{_licences()}</script>\n'
            f'    <script type="importmap" nonce="{nonce}">{_module_map()}</script>\n'
            f'    <script type="module" nonce="{nonce}">import "#js/main.js";</script>\n  </body>',
        ),
    ):
        assert text.count(place) == 1, place
        text = text.replace(place, new)
    return text


@cache
def import_map_source() -> str:
    """Return the source by which a Content-Security-Policy allows the import map of the served page."""
    match = _MAP.search(_index())
    assert match is not None
    return f"'{_hash(match['map'])}'"


def data_url(file: Path) -> str:
    """Return an address that holds a file's content.

    :raises OSError: when it cannot be read
    """
    kind = picture_kind(file) or _TYPES[file.suffix.lower()]
    return f"data:{kind};base64,{base64.b64encode(file.read_bytes()).decode()}"


def _index() -> str:
    return (PAGE / "index.html").read_text("utf-8")


def _module_map() -> str:
    """Return an import map with all modules in it."""
    files = sorted([*PAGE.rglob("*.js"), *PAGE.rglob("*.mjs")])
    return json.dumps({"imports": {f"#{file.relative_to(PAGE).as_posix()}": data_url(file) for file in files}})


def _hash(text: str) -> str:
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"


def _styles() -> str:
    return _checked("\n".join(_style(PAGE / name) for name in _STYLES.findall(_index())), "</style")


def _style(file: Path) -> str:
    return _URL.sub(lambda match: f'url("{data_url(file.parent / match["file"])}")', file.read_text("utf-8"))


def _licences() -> str:
    """Return the licences of the libraries and fonts, which belong to every copy."""
    files = sorted((PAGE / "vendor").glob("*/LICENSE"))
    return _checked("\n\n".join(f"{file.parent.name}\n\n{file.read_text('utf-8')}" for file in files), "</script")


def _checked(text: str, end: str) -> str:
    """Return a text that has nothing that would end its element, or begin a comment in it."""
    found = [wrong for wrong in (end, "<!--") if wrong in text.lower()]
    assert not found, found
    return text
