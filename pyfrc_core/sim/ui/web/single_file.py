"""The page as one HTML file: its modules, styles, fonts and pictures are in it, so that it needs no server.

A browser does not let a page from disk import modules from other files, and asks a server for each of fifty modules. So
all modules become one script: each is a function, in the order in which they import each other. An imported name is a
variable of the importing module, which is set before its code runs and again when all modules are there, since modules
may import each other. The page's code is not changed otherwise. The Content-Security-Policy names this one script and
the styles by their hashes.
"""

from __future__ import annotations

import base64
import hashlib
import re
from functools import cache, lru_cache
from pathlib import Path, PurePosixPath

from ....config.pictures import picture_kind

#: The page's files.
PAGE = Path(__file__).with_name("page")

_MAIN = PurePosixPath("js/main.js")
_IMPORT = re.compile(r'^import\s+(?P<names>[^;"]+?)\s+from\s+"(?P<file>[^"]+)";?$', re.MULTILINE)
_EXPORT_FROM = re.compile(r'^export\s*\{(?P<names>[^}]*)\}\s*from\s+"(?P<file>[^"]+)";?$', re.MULTILINE)
_EXPORT_LIST = re.compile(r"\bexport\s*\{(?P<names>[^}]*)\};?")
_EXPORT_DEFAULT = re.compile(r"\bexport default\b")
_EXPORT = re.compile(r"^export\s+(?=(?:async\s+)?(?:function\*?|class|const|let)\s+(?P<name>[\w$]+))", re.MULTILINE)
_URL = re.compile(r'url\("(?P<file>[^"]+)"\)')
_STYLES = re.compile(r'[ ]*<link rel="stylesheet" href="/static/(?P<file>[^"]+)">\n')
_TYPES = {".woff2": "font/woff2", ".svg": "image/svg+xml"}


def single_file(title: str, data: bytes) -> str:
    """Return the page with a recorded run in it.

    :param title: plain ASCII text of pyfrc's own
    :param data: the run, as `js/recorded.js` reads it
    """
    script, styles = _script(_newest_module()), _styles()
    policy = (
        f"default-src 'none'; script-src '{_hash(script)}'; style-src '{_hash(styles)}'; img-src data: blob:; "
        "font-src data:; base-uri 'none'; form-action 'none'"
    )
    text = _STYLES.sub("", (PAGE / "index.html").read_text("utf-8"))
    run = base64.b64encode(data).decode()
    for place, new in (
        (
            '<meta charset="utf-8">',
            f'<meta charset="utf-8">\n    <meta http-equiv="Content-Security-Policy" content="{policy}">',
        ),
        ("<title>pyfrc sim</title>", f"<title>{title}</title>"),
        ('href="/static/icon.svg"', f'href="{data_url(PAGE / "icon.svg")}"'),
        ('    <script type="module" src="/static/page.js"></script>\n', f"    <style>{styles}</style>\n"),
        (
            "  </body>",
            f'    <script type="application/gzip" id="run">{run}</script>\n'
            f'    <script type="text/plain">{_licences()}</script>\n'
            f'    <script type="module">{script}</script>\n  </body>',
        ),
    ):
        assert text.count(place) == 1, place
        text = text.replace(place, new)
    return text


def served_script() -> bytes:
    """Return the script that a server sends: all modules as their files are now.

    It exports `modules`: tests and benchmarks look at their names.
    """
    return _script(_newest_module()).encode() + b"export { pyfrcModules as modules };\n"


def data_url(file: Path) -> str:
    """Return an address that holds a file's content.

    :raises OSError: when it cannot be read
    """
    kind = picture_kind(file) or _TYPES[file.suffix.lower()]
    return f"data:{kind};base64,{base64.b64encode(file.read_bytes()).decode()}"


def _hash(text: str) -> str:
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"


@cache
def _styles() -> str:
    index = (PAGE / "index.html").read_text("utf-8")
    return _checked("\n".join(_style(PAGE / name) for name in _STYLES.findall(index)), "</style")


def _style(file: Path) -> str:
    return _URL.sub(lambda match: f'url("{data_url(file.parent / match["file"])}")', file.read_text("utf-8"))


@cache
def _licences() -> str:
    """Return the licences of the libraries and fonts, which belong to every copy."""
    files = sorted((PAGE / "vendor").glob("*/LICENSE"))
    return _checked("\n\n".join(f"{file.parent.name}\n\n{file.read_text('utf-8')}" for file in files), "</script")


def _checked(text: str, end: str) -> str:
    """Return a text that has nothing that would end its element, or begin a comment in it."""
    found = [wrong for wrong in (end, "<!--") if wrong in text.lower()]
    assert not found, found
    return text


def _newest_module() -> int:
    """Return when a module was last changed."""
    return max(file.stat().st_mtime_ns for file in PAGE.rglob("*.js"))


@lru_cache(maxsize=1)
def _script(changed: int) -> str:
    """Return all modules as one script.

    :param changed: when a module was last changed
    """
    order: list[PurePosixPath] = []
    _add_module(_MAIN, order, set())
    *others, main = (f"{_module(name)}\n" for name in order)
    names = ", ".join(f'"{name}": {{}}' for name in order)
    relink = "for (const link of pyfrcLinks) link();\n"
    begin = f"const pyfrcModules = {{ {names} }};\nconst pyfrcLinks = [];\n"
    return _checked("".join([begin, *others, relink, main]), "</script")


def _add_module(name: PurePosixPath, order: list[PurePosixPath], seen: set[PurePosixPath]) -> None:
    """Add a module after those that it imports, as browsers evaluate them."""
    seen.add(name)
    text = (PAGE / name).read_text("utf-8")
    found = [*_IMPORT.finditer(text), *_EXPORT_FROM.finditer(text)]
    for match in sorted(found, key=lambda each: each.start()):
        other = _resolved(name, match["file"])
        if other not in seen:
            _add_module(other, order, seen)
    order.append(name)


def _resolved(name: PurePosixPath, other: str) -> PurePosixPath:
    parts: list[str] = []
    for part in (*name.parent.parts, *PurePosixPath(other).parts):
        if part == "..":
            parts.pop()
        elif part != ".":
            parts.append(part)
    return PurePosixPath(*parts)


def _module(name: PurePosixPath) -> str:
    """Return a module as a function that is called at once."""
    text = (PAGE / name).read_text("utf-8")
    variables: list[str] = []
    links: list[str] = []
    exports: dict[str, str] = {}  # by the exported name: an expression

    def take_import(match: re.Match[str]) -> str:
        module = f'pyfrcModules["{_resolved(name, match["file"])}"]'
        for local, outer in _imported(match["names"]):
            variables.append(local)
            links.append(f"{local} = {module}{'' if outer == '*' else f'.{outer}'};")
        return ""

    def take_export_from(match: re.Match[str]) -> str:
        module = f'pyfrcModules["{_resolved(name, match["file"])}"]'
        exports.update((outer, f"{module}.{local}") for local, outer in _pairs(match["names"]))
        return ""

    def take_export_list(match: re.Match[str]) -> str:
        exports.update((outer, local) for local, outer in _pairs(match["names"]))
        return ""

    def take_export(match: re.Match[str]) -> str:
        exports[match["name"]] = match["name"]
        return ""

    text = _IMPORT.sub(take_import, text)
    text = _EXPORT_FROM.sub(take_export_from, text)
    text = _EXPORT.sub(take_export, text)
    text = _EXPORT_LIST.sub(take_export_list, text)
    if _EXPORT_DEFAULT.search(text):
        text = _EXPORT_DEFAULT.sub("const pyfrcDefault =", text)
        exports["default"] = "pyfrcDefault"
    getters = ", ".join(f"{outer}: {{ get: () => {inner} }}" for outer, inner in exports.items())
    linking = ""
    if links:
        linking = f"let {', '.join(variables)};\nconst pyfrcLink = () => {{ {' '.join(links)} }};\n"
        linking += "pyfrcLinks.push(pyfrcLink);\npyfrcLink();\n"
    exporting = f'Object.defineProperties(pyfrcModules["{name}"], {{ {getters} }});'
    return f"(() => {{ // {name}\n{linking}{text}\n{exporting}\n}})();"


def _imported(names: str) -> list[tuple[str, str]]:
    """Return the names that an import gives, each with the name that the other module has for it."""
    whole, _, listed = names.partition("{")
    found = _pairs(listed.rstrip("} \n")) if listed else []
    pairs = [(local, outer) for outer, local in found]
    for each in filter(None, (part.strip() for part in whole.split(","))):
        pairs.append((each.removeprefix("* as "), "*") if each.startswith("* as ") else (each, "default"))
    return pairs


def _pairs(names: str) -> list[tuple[str, str]]:
    """Return the pairs of ``a, b as c``."""
    found = []
    for each in filter(None, (part.strip() for part in names.split(","))):
        first, _, second = each.partition(" as ")
        found.append((first, second or first))
    return found
