"""A robot's data cannot control the terminal: output, records, errors, console."""

from __future__ import annotations

import sys
import unicodedata

from hypothesis import given
from hypothesis import strategies as st

from pyfrc_core.terminal_text import one_line, visible

#: Clears the screen, sets the title, has the terminal answer, reverses the text.
HOSTILE = "\x1b[2J\x1b]0;title\x07\x9b5n\x08\r\x7f\u202e\u2066\u061c\u2028\ud800"
SHOWN = "\\x1b[2J\\x1b]0;title\\x07\\x9b5n\\x08\\x0d\\x7f\\u202e\\u2066\\u061c\\u2028\\ud800"


def test_control_characters_are_shown_and_colours_are_left_out() -> None:
    assert visible(HOSTILE) == SHOWN
    assert visible("\x1b[1;31mred\x1b[0m\tGrüße\r\n") == "red\tGrüße\n"
    assert one_line("a\nb\tc" + HOSTILE) == "a\\nb c" + SHOWN
    assert one_line("x" * 5000, 10) == "x" * 10 + " ..."


def test_invisible_characters_are_shown() -> None:
    assert visible("a\u200bb\u00adc\ufeffd\U000e0041") == "a\\u200bb\\xadc\\ufeffd\\U000e0041"
    invisible = {letter for letter in map(chr, range(sys.maxunicode + 1)) if unicodedata.category(letter) == "Cf"}
    visible_marks = {letter for letter in invisible if unicodedata.bidirectional(letter) == "AN"}  # Arabic signs
    kept = {letter for letter in invisible - visible_marks if visible(letter) == letter}
    joiners = {"\u200c", "\u200d"}  # Persian, Indic scripts and emoji need them
    syriac_and_kaithi_signs = {"\u070f", "\U000110bd", "\U000110cd"}
    hieroglyph_joiners = set(map(chr, range(0x13430, 0x13440)))
    assert kept <= joiners | syriac_and_kaithi_signs | hieroglyph_joiners
    assert joiners <= kept
    assert visible("".join(map(chr, range(0xE0000, 0xE0080)))).isascii()


@given(st.text())
def test_no_text_has_control_characters_afterwards(text: str) -> None:
    assert all(each in "\n\t" or not (ord(each) < 32 or 127 <= ord(each) < 160) for each in visible(text))
    assert one_line(text).count("\n") == 0
    assert visible(visible(text)) == visible(text)
