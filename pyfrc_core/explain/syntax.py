"""Files that Python cannot read: what the mistake is in its line."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..project.robot_files import RobotFiles
from .explanation import Explanation

#: Characters of word processors and chat programs, and what to write instead.
_LOOK_ALIKES = {
    **dict.fromkeys("\u201c\u201d\u201e\u201f\u00ab\u00bb\u2033", ('"', "quotation mark")),
    **dict.fromkeys("\u2018\u2019\u201a\u201b\u2032\u00b4", ("'", "quotation mark")),
    **dict.fromkeys("\u2013\u2014\u2212\u2010\u2011", ("-", "dash")),
    **dict.fromkeys("\u00d7", ("*", "multiplication sign")),
    **dict.fromkeys("\u00a0\u2003\u2009\u200b\ufeff", (" ", "special space")),
    **dict.fromkeys("\uff08", ("(", "bracket")),
    **dict.fromkeys("\uff09", (")", "bracket")),
    **dict.fromkeys("\uff1a", (":", "colon")),
    **dict.fromkeys("\uff0c", (",", "comma")),
}


@dataclass(frozen=True)
class _Row:
    """A mistake and its remedy, in which ``{0}`` is the first group of `line`.

    :param message: what Python's message contains
    :param line: what the user's line contains
    """

    message: str
    line: str
    remedy: str


_UNREADABLE = "^invalid syntax$|^expected ':'|was never closed|^unmatched"
_KEYWORDS = "|".join(keyword.kwlist)
_ROWS = (
    # What other languages write.
    _Row(_UNREADABLE, r"\belse +if\b", "Write elif, in one word."),
    _Row(_UNREADABLE, r"([\w.]+) *\+\+", "Write {0} += 1"),
    _Row(_UNREADABLE, r"([\w.]+) *--", "Write {0} -= 1"),
    _Row(_UNREADABLE, r"&&|\|\|", "Write and for &&, and or for ||."),
    _Row(_UNREADABLE, r"!(?!=)", "Write not for !, as in: if not pressed:"),
    _Row(_UNREADABLE, r"\bnew +(\w+)", "Write {0}(...) without new."),
    _Row(
        _UNREADABLE,
        r"\)\s*\{\s*$",
        "Write a colon for the brace, and indent what belongs to it; Python needs no braces.",
    ),
    _Row(
        _UNREADABLE,
        r"^\s*(?:(?:public|private|static|final|const|var|let|int|float|double|boolean|String) +)+(\w+) *=",
        "Write {0} = ... without the words before it.",
    ),
    _Row(_UNREADABLE, r"^\s*(elif|else)\b", "Write {0} exactly below its if, with nothing less indented between them."),
    _Row(_UNREADABLE, r"//", "A comment begins with #."),
    _Row(_UNREADABLE, rf"(?:\.|\bdef |\bclass )({_KEYWORDS})\b", "{0} is a word of Python: choose another name."),
    # What is missing, or too much.
    _Row("inconsistent use of tabs", "", "Indent with spaces only (VS Code: Convert Indentation to Spaces)."),
    _Row(
        "expected an indented block",
        "",
        "After a line with a colon, the next is indented: by four spaces more than that line, or write pass before it.",
    ),
    _Row(
        "unexpected indent|unindent does not match",
        "",
        "Indent this line exactly as the line above it that belongs to the same block.",
    ),
    _Row("^expected ':'", "", "Write a colon at the end of this line."),
    _Row("was never closed", "", "Close the bracket, on this line or on one of those that follow."),
    _Row("^unmatched", "", "Remove this bracket, or write the one that opens it."),
    _Row("^unterminated (?:string|f-string) literal", "", "Write the quotation mark that ends the text."),
    _Row("^invalid decimal literal", r"\.\d*[fFdD]\b", "Write the number without a letter."),
    _Row("^invalid decimal literal", "", "A name cannot begin with a digit."),
    _Row(
        "cannot assign to function call",
        r"(\w[\w.]*)\.get(\w*)\([^()]*\) *= *(.+?)\s*$",
        "Write {0}.set{1}({2}) to set it; to compare, write ==.",
    ),
    _Row("Maybe you meant '=='", "", "Write == to compare."),
    _Row("^expected 'except'", "", "Write except SomeError: below the lines of try, or remove try."),
    _Row("^positional argument follows", "", "Write arguments with a name and = behind those without."),
    _Row("outside function", "", "Indent this line into the function that it belongs to."),
)

_CONFLICT = re.compile(r"^(<{7}|={7}|>{7})(?:\s|$)")


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    if not isinstance(error, SyntaxError) or error.filename is None or not files.is_project_file(error.filename):
        return None
    name = files.relative(error.filename)
    lines = _lines_of(error.filename)
    if marks := list(_conflict_marks(lines)):
        return Explanation(
            f"a merge conflict of git is not resolved: its marks are in {_listed(marks)}",
            "Keep one of the two versions, or what is right of both, and delete the lines with marks.",
            f"{name}:{marks[0]}",
        )
    place = f"{name}:{error.lineno}" if error.lineno else name
    wrong = re.match(r"invalid (?:non-printable )?character (?:'(.)' )?\(?U\+(\w+)", error.msg or "")
    if wrong is not None:
        character = wrong[1] or chr(int(wrong[2], 16))
        if character in _LOOK_ALIKES:
            right, kind = _LOOK_ALIKES[character]
            shown = f"the character {character} is" if character.isprintable() else f"U+{wrong[2]} is"
            meant = "an ordinary space" if right == " " else f"{right} with your keyboard"
            text = f"{shown} a {kind} of a word processor, which Python does not read{_shown_line(error)}"
            return Explanation(text, f"Write {meant}; search the whole file for it.", place)
    outside = [at for at, text in enumerate(lines[: error.lineno], 1) if re.match(r"def \w+\(self\b", text)]
    if isinstance(error, IndentationError) and outside:
        method = lines[outside[-1] - 1].partition("(")[0]
        text = f"{method}(self) is not indented, so it is outside of its class{_shown_line(error)}"
        return Explanation(text, "Indent it as much as the other methods.", f"{name}:{outside[-1]}")
    remedy = _remedy(error)
    return Explanation(f"{type(error).__name__}: {error.msg}{_shown_line(error)}", remedy, place)


def _remedy(error: SyntaxError) -> str:
    """Return what to write instead; empty if no row is about this mistake."""
    message, line = error.msg or "", (error.text or "").partition("#")[0]
    for row in _ROWS:
        found = re.search(row.line, line)
        if found is not None and re.search(row.message, message):
            return row.remedy.format(*found.groups())
    return ""


def _shown_line(error: SyntaxError) -> str:
    return f"\n    {error.text.strip()}" if error.text and error.text.strip() else ""


def _lines_of(file: str) -> list[str]:
    try:
        return Path(file).read_text("utf-8", "replace").splitlines()
    except OSError:
        return []


def _conflict_marks(lines: list[str]) -> Iterator[int]:
    found = [(number, line) for number, line in enumerate(lines, 1) if _CONFLICT.match(line)]
    # A line of equals signs alone may be a heading in a docstring.
    if any(line.startswith(("<<<<<<<", ">>>>>>>")) for _, line in found):
        yield from (number for number, _ in found)


def _listed(numbers: list[int]) -> str:
    shown = ", ".join(map(str, numbers[:6]))
    return f"line{'s' * (len(numbers) > 1)} {shown}{' and more' if len(numbers) > 6 else ''}"
