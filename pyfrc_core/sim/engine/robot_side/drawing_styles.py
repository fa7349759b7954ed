"""Styles from the keywords of `draw_line` and `draw_text`, which have the names of tkinter's options.

The names are documented, and older than front ends without tkinter; a scene has styles that any front end can draw.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from ....config.colors import color_problem
from ....errors import nearest
from ..scene import Line, LineStyle, Text, TextStyle

#: Options that have a meaning in tkinter, and none for a drawing that stays as it is.
_WITHOUT_EFFECT = frozenset({"tags"})

Style = TypeVar("Style", LineStyle, TextStyle)


def line_style(options: Mapping[str, object]) -> tuple[LineStyle, str, None, str]:
    """Return the style of a line, its colour, no size, and what is wrong with the options; empty: nothing."""
    return _read("draw_line", LineStyle, _LINE, options, Line.color)


def text_style(options: Mapping[str, object]) -> tuple[TextStyle, str, int | None, str]:
    """Return the style of a text, its colour, its size if the options say it, and what is wrong with them."""
    return _read("draw_text", TextStyle, _TEXT, options, Text.color)


def _one_of(*names: str) -> Callable[[Any], str]:
    def read(value: object) -> str:
        if value not in names:
            raise ValueError(f"it is one of {', '.join(names)}")
        return str(value)

    return read


def _color(value: object) -> str:
    if problem := color_problem(str(value)):
        raise ValueError(problem)
    return str(value)


def _dash(value: Any) -> tuple[int, ...]:
    if isinstance(value, int):
        return (value,)
    if isinstance(value, str):
        value = value.split()
    return tuple(int(each) for each in value)


def _font(value: Any) -> dict[str, Any]:
    """Read ``("Arial", 12, "bold")`` or ``"Arial 12 bold"``."""
    family, *others = value.split() if isinstance(value, str) else value
    words = [str(each).lower() for each in others]
    sizes = [word for word in words if word.lstrip("-").isdigit()]
    styles: dict[str, Any] = {name: True for name in ("bold", "italic", "underline") if name in words}
    return {"family": str(family), **styles, **({"size": abs(int(sizes[0]))} if sizes else {})}


def _single(name: str, read: Callable[[Any], Any]) -> Callable[[Any], dict[str, Any]]:
    return lambda value: {name: read(value)}


#: How each option is read, into attributes of the style, and `color` and `size`.
_Readers = Mapping[str, Callable[[Any], dict[str, Any]]]
_LINE: _Readers = {
    "color": _single("color", _color),
    "width": _single("width", float),
    "dash": _single("dash", _dash),
    "smooth": _single("smooth", bool),
    "capstyle": _single("cap", _one_of("butt", "projecting", "round")),
    "joinstyle": _single("join", _one_of("bevel", "miter", "round")),
    "fill": _single("color", _color),
}
_TEXT: _Readers = {
    "color": _single("color", _color),
    "anchor": _single("anchor", _one_of("center", "n", "ne", "e", "se", "s", "sw", "w", "nw")),
    "angle": _single("angle", float),
    "justify": _single("justify", _one_of("left", "center", "right")),
    "width": _single("width", float),
    "font": _font,
    "fill": _single("color", _color),
}


def _read(
    function: str, make: Callable[..., Style], readers: _Readers, options: Mapping[str, object], color: str
) -> tuple[Style, str, Any, str]:
    found: dict[str, Any] = {}
    problems = []
    for name, value in options.items():
        if name in _WITHOUT_EFFECT:
            continue
        if name not in readers:
            problems.append(f"{function}: there is no option {name!r}: {nearest(name, list(readers))}")
            continue
        try:
            found |= readers[name](value)
        except (TypeError, ValueError) as wrong:
            problems.append(f"{function}: {name}={value!r}: {wrong}")
    color, size = found.pop("color", color), found.pop("size", None)
    return make(**found), color, size, "; ".join(problems)
