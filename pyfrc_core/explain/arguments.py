"""A library's function that was called with the wrong arguments: which one, and where its value comes from."""

from __future__ import annotations

import ast
import linecache
import re
from types import FrameType
from typing import Any

from ..errors import text_of
from ..project.robot_files import RobotFiles
from ..wording import counted
from .explanation import Explanation
from .places import calls_at, users_frame, value_of

_INCOMPATIBLE = re.compile(
    r"TypeError: (?:\w+\.)*(?P<name>\w+)\(\): incompatible (?:function|constructor) arguments\..*?\n"
    r"(?P<forms>(?:    \d+\. .*\n)+)\s*Invoked with:? ?(?P<got>.*)",
    re.DOTALL,
)
_FORM = re.compile(r"    \d+\. (?:[\w.]+)?\((?P<parameters>.*)\)(?: -> .*)?\n")
_PARAMETER = re.compile(r"(?<![.\w])(\w+): ")
_NOT_CALLABLE = re.compile(r"assert (?:\w+ is None or )?callable\((\w+)\)")
#: Annotations of numbers, as the bindings of C++ write them.
_NUMBER = re.compile(r"typing\.Supports\w+(?: \| typing\.Supports\w+)*|\b(?:float|int)\b")
#: How Python shows a function.
_FUNCTION = re.compile(r"<(?:bound method|function|built-in method|staticmethod)")


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    text = text_of(error)
    if found := _INCOMPATIBLE.match(text):
        return _incompatible(found, error, files)
    if isinstance(error, AssertionError) and (explained := _not_callable(error, files)):
        return explained
    if text.startswith("ArgumentError: argument "):
        return _wrong_type(error, files)
    return None


def _incompatible(found: re.Match[str], error: BaseException, files: RobotFiles) -> Explanation:
    forms = [_parameters(form["parameters"]) for form in _FORM.finditer(found["forms"])]
    name = found["name"]
    if name == "__init__":
        named = re.match(r"    1\. ([\w.]+)\(", found["forms"])
        name = named[1].rpartition(".")[2] if named else name
    where = users_frame(error, files)
    call = next(iter(calls_at(*where, name)), None) if where is not None else None
    takes = " or ".join(f"{name}({', '.join(form)})" for form in dict.fromkeys(map(tuple, forms)))
    if call is None:
        return Explanation(f"{name}() got arguments that it does not take", f"It takes: {takes}")
    owner = value_of(call.func.value, where[0]) if where is not None and isinstance(call.func, ast.Attribute) else None
    if isinstance(owner, type) and all("self: " in form for form in found["forms"].strip().splitlines()):
        cls = ast.unparse(call.func.value) if isinstance(call.func, ast.Attribute) else ""
        if where is not None and isinstance(where[0].f_locals.get("self"), owner):
            return Explanation(f"{cls}.{name}() is called without self", f"Write super().{name}(), with what it takes.")
        return Explanation(
            f"{name}() is called on the class {cls}, and not on an object of it",
            f"Create an object in robotInit, as in: self.it = {cls}(...). Then call: self.it.{name}(...)",
        )
    unknown = [each.arg for each in call.keywords if each.arg and not _has_parameter(forms, each.arg)]
    if unknown:
        return Explanation(f"{name}() has no argument {unknown[0]}", f"It takes: {takes}")
    got = _written(call)
    values = _values(found["got"], len(call.args) + len(call.keywords))
    none = next((at for at, value in enumerate(values) if value == "None"), None)
    if none is not None and none < len(got):
        return _got_none(name, got[none], takes)
    shown = ", ".join(got) or "no arguments"
    count = len(got)
    needed = sorted({len([each for each in form if "=" not in each]) for form in forms})
    most = max(map(len, forms), default=0)
    if needed and not needed[0] <= count <= most:
        need = f"{needed[0]}" if needed[0] == most else f"{needed[0]} to {most}"
        return Explanation(
            f"{name}() was called with {counted(count, 'value')}, but takes {need}", f"It takes: {takes}"
        )
    function = next((at for at, value in enumerate(values) if _FUNCTION.match(value)), None)
    if function is not None and function < len(got):
        return Explanation(f"{name}() got the function {got[function]}, and not its value", f"Write {got[function]}()")
    return Explanation(f"{name}() does not take {shown}{_types(values)}", f"It takes: {takes}")


def _got_none(name: str, written: str, takes: str = "") -> Explanation:
    """Explain an argument that is None.

    :param written: the argument as the user has written it
    """
    form = f"\n  It takes: {takes}" if takes else ""
    if written in ("None", ""):
        return Explanation(f"{name}() got None", f"Pass a value.{form}")
    asked = f"Does {written} return something?" if written.endswith(")") else f"Has anything set {written} before?"
    return Explanation(f"{name}() got None, from {written}", f"{asked}{form}")


def _has_parameter(forms: list[list[str]], name: str) -> bool:
    return any(each.startswith(f"{name}: ") for form in forms for each in form)


def _parameters(text: str) -> list[str]:
    """Return the parameters of a form, such as ``["speed: number"]``, without `self`."""
    found = list(_PARAMETER.finditer(text))
    parameters = []
    for at, each in enumerate(found):
        end = found[at + 1].start() if at + 1 < len(found) else len(text)
        kind, equals, default = text[each.end() : end].rstrip(", ").partition(" = ")
        if each[1] == "self":
            continue
        short = re.sub(r"[\w.]+\.(\w+)", r"\1", _NUMBER.sub("number", kind))
        default = re.sub(r"<([\w.]+): .*>", r"\1", default)
        parameters.append(f"{each[1]}: {short}" + (f" = {default}" if equals else ""))
    return parameters


def _written(call: ast.Call) -> list[str]:
    """Return the arguments of a call, as the user has written them."""
    return [ast.unparse(each) for each in (*call.args, *(keyword.value for keyword in call.keywords))]


def _values(text: str, count: int) -> list[str]:
    """Return the values that a function got, as Python shows them, without `self`; empty if that is not certain."""
    values = re.sub(r"kwargs: |\b\w+=", "", text).strip()
    parts = re.split(r"[,;] (?![^<\[({]*[>\])}])", values) if values else []
    return parts[len(parts) - count :] if len(parts) in (count, count + 1) else []


def _types(values: list[str]) -> str:
    texts = [value for value in values if value[:1] in "'\""]
    return f" ({texts[0]} is a text)" if texts else ""


def _not_callable(error: BaseException, files: RobotFiles) -> Explanation | None:
    """Explain a library's assertion that one of its arguments is a function."""
    entry = error.__traceback__
    while entry is not None and entry.tb_next is not None:
        entry = entry.tb_next
    where = users_frame(error, files)
    if entry is None or where is None or files.is_project_file(entry.tb_frame.f_code.co_filename):
        return None
    line = linecache.getline(entry.tb_frame.f_code.co_filename, entry.tb_lineno)
    found = _NOT_CALLABLE.search(line)
    if found is None:
        return None
    value: Any = entry.tb_frame.f_locals.get(found[1])
    kind = "None" if value is None else f"of type {type(value).__name__}"
    argument = next((each for call in calls_at(*where, "") for each in call.args if isinstance(each, ast.Call)), None)
    written = ast.unparse(argument) if argument is not None else ""
    without = f"Pass the function itself: {_without_brackets(written)} without (). " if written else ""
    return Explanation(
        f"{found[1]} must be a function, but is {kind}{f', from {written}' if written else ''}",
        f"{without}With arguments: lambda: {written or 'function(1)'}",
    )


def _without_brackets(written: str) -> str:
    return written.partition("(")[0]


def _wrong_type(error: BaseException, files: RobotFiles) -> Explanation | None:
    """Explain an error of a library in C, by the arguments of the library's function that the user has called."""
    where = users_frame(error, files)
    entry = error.__traceback__
    while entry is not None and (where is None or entry.tb_frame is not where[0]):
        entry = entry.tb_next
    called: FrameType | None = entry.tb_next.tb_frame if entry is not None and entry.tb_next is not None else None
    if called is None or where is None:
        return None
    name = called.f_code.co_name
    names = called.f_code.co_varnames[: called.f_code.co_argcount]
    wrong = [each for each in names if called.f_locals.get(each) is None and each != "self"]
    call = next(iter(calls_at(*where, name)), None)
    got = _written(call) if call is not None else []
    if wrong:
        return _got_none(name, got[0] if len(got) == 1 else "")
    return Explanation(f"{name}() does not take {', '.join(got) or 'a value of this type'}", "Pass a number.")
