"""A library's function that was called with the wrong arguments: which one, and where its value comes from."""

from __future__ import annotations

import ast
import linecache
import re
import sys
from collections.abc import Iterator
from difflib import get_close_matches
from types import FrameType
from typing import Any

from ..errors import text_of
from ..project.robot_files import RobotFiles, is_pyfrc
from ..wording import counted
from .calls import called_on_class
from .explanation import Explanation, ask_for
from .names import home_of
from .other_season import in_2027
from .places import (
    calls_at,
    frames_of,
    last_name,
    owner_of,
    passed_to,
    robot_calls,
    users_frame,
    value_of,
    without_return,
)
from .returned import class_of, numbers_of, public_name

_INCOMPATIBLE = re.compile(
    r"TypeError: (?:\nTypeError: )?(?:\w+\.)*(?P<name>\w+)\(\): incompatible (?:function|constructor) arguments\..*?\n"
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
    if isinstance(error, AttributeError) and (explained := _wrong_object(error, files)):
        return explained
    if isinstance(error, AssertionError) and (explained := _not_callable(error, files)):
        return explained
    if isinstance(error, (TypeError, AttributeError)) and "'list'" in text and (explained := _list(error, files)):
        return explained
    return None


def _wrong_object(error: AttributeError, files: RobotFiles) -> Explanation | None:
    """Explain an object that a library's function has got from the user, and that is of a wrong type."""
    where = users_frame(error, files)
    inner = frames_of(error)[-1] if where is not None else None
    if where is None or inner is None or files.is_project_file(inner.f_code.co_filename):
        return None
    for call in calls_at(*where, ""):
        for each in call.args:
            value = value_of(each, where[0])
            if error.obj in (value, getattr(value, "__func__", value)):
                a = "a number" if isinstance(error.obj, (int, float)) else f"a {type(error.obj).__name__}"
                kind = "None" if error.obj is None else a
                written = ast.unparse(each)
                has = (name for name, each in _objects(where[0]) if hasattr(each, str(error.name)))
                other = next(has, "") or f"an object with {error.name}, such as {_annotated(inner, error.obj)}"
                remedy = f"Write {written}()" if callable(error.obj) else f"Pass {other}"
                return Explanation(f"{last_name(call.func)}() got {written}, which is {kind}", remedy)
    return None


def _list(error: BaseException, files: RobotFiles) -> Explanation | None:
    """Explain a list for a library's function that takes its elements."""
    where = users_frame(error, files)
    for call in calls_at(*where, "") if where is not None and frames_of(error)[-1] is not where[0] else ():
        if call.args and isinstance(call.args[0], ast.List):
            elements = ", ".join(map(ast.unparse, call.args[0].elts))
            text = f"{last_name(call.func)}() got a list, and takes what is in it"
            return Explanation(text, f"Write {ast.unparse(call.func)}({elements})")
    return None


def _objects(frame: FrameType) -> Iterator[tuple[str, object]]:
    """Yield the attributes of the user's object whose method runs, each with its name."""
    own = getattr(frame.f_locals.get("self"), "__dict__", {})
    yield from ((f"self.{name}", each) for name, each in own.items())


def _annotated(frame: FrameType, value: object) -> str:
    """Return the class that a library's function expects where it has got a value, by its annotation."""
    function = getattr(type(frame.f_locals.get("self")), frame.f_code.co_name, None)
    for name, annotation in getattr(function, "__annotations__", {}).items():
        if frame.f_locals.get(name) is value:
            return str(getattr(annotation, "__name__", annotation))
    return "wpilib.XboxController(0)" if isinstance(value, int) else "the one that its documentation names"


def _incompatible(found: re.Match[str], error: BaseException, files: RobotFiles) -> Explanation:
    forms = [_parameters(form["parameters"]) for form in _FORM.finditer(found["forms"])]
    name = found["name"]
    if name == "__init__":
        named = re.match(r"    1\. ([\w.]+)\(", found["forms"])
        name = named[1].rpartition(".")[2] if named else name
    where = users_frame(error, files)
    call = next(iter(calls_at(*where, name)), None) if where is not None else None
    if where is not None and call is None and (called := _called_from(error, where[0])) is not None:
        name = called.f_code.co_name  # of the library's Python, which has called that of C++
        call, forms = next(iter(calls_at(*where, name)), None), forms[:1]
    if (
        where is not None
        and call is None
        and frames_of(error)[-1] is where[0]
        and len(calls := calls_at(*where, "")) == 1
    ):
        call, name = calls[0], last_name(calls[0].func)  # the library has another name for it
    takes = " or ".join(f"{name}({', '.join(form)})" for form in dict.fromkeys(map(tuple, forms)))
    takes += "".join(map(_members, dict.fromkeys(re.findall(r": ([\w.]+)", found["forms"]))))
    if call is None:
        if passed := _text_passed(found["got"], files):
            return passed
        return Explanation(f"{name}() got arguments that it does not take", f"It takes: {takes}")
    owner = owner_of(call.func, where[0]) if where is not None and name == found["name"] else None
    of_objects = all("self: " in form for form in found["forms"].strip().splitlines())
    if isinstance(owner, type) and where is not None and of_objects:
        return called_on_class(call, owner, where[0], files)
    known = "".join(f" {each}" for form in forms for each in form)
    unknown = [each.arg for each in call.keywords if each.arg and f" {each.arg}: " not in known]
    if unknown:
        return Explanation(f"{name}() has no argument {unknown[0]}", f"It takes: {takes}")
    got = _written(call)
    values = _values(found["got"], len(call.args) + len(call.keywords))
    none = next((at for at, value in enumerate(values) if value == "None"), None)
    if none is not None and none < len(got):
        return _got_none(name, got[none], files, takes)
    shown = ", ".join(got) or "no arguments"
    count = len(got)
    needed = sorted({len([each for each in form if "=" not in each]) for form in forms})
    most = max(map(len, forms), default=0)
    if needed and not needed[0] <= count <= most:
        need = f"{needed[0]}" if needed[0] == most else f"{needed[0]} to {most}"
        text = f"{name}() was called with {counted(count, 'value')}, but takes {need}"
        missing = [each.partition(":")[0] for each in forms[0][count : needed[0]]] if len(forms) == 1 else []
        written = (
            f"Write {ast.unparse(call.func)}({', '.join([*got, *missing])})\n  "
            if missing and not call.keywords
            else ""
        )
        return Explanation(text, f"{written}It takes: {takes}")
    paths = {each.rpartition(".")[2]: each for each in re.findall(r": ([\w.]+)", found["forms"])}
    for at, (value, written) in enumerate(zip(values, got, strict=False)):
        kinds = [form[at].partition(": ")[2].partition(" = ")[0] for form in forms if at < len(form)]
        if not call.keywords and (wrong := _wrong(value, written, kinds, paths)):
            return Explanation(f"{name}() got {wrong[0]}", f"{wrong[1]}\n  It takes: {takes}")
    return Explanation(f"{name}() does not take {shown}", f"It takes: {takes}")


def _members(path: str) -> str:
    """Return a further line with the values of an enum, by its full name; empty for other classes."""
    cls = class_of(path)
    names = ", ".join(getattr(cls, "__members__", ()))
    return f"\n  {cls.__qualname__} is one of: {names}" if cls is not None and names else ""


def _wrong(value: str, written: str, kinds: list[str], paths: dict[str, str]) -> tuple[str, str] | None:
    """Return what an argument is, and what to write instead, if its value is of none of the kinds.

    :param value: as Python shows it
    :param written: as the user has written it
    :param paths: the full names of the classes in `kinds`
    """
    functions = [kind for kind in kinds if "Callable" in kind or kind.startswith("()")]
    if _FUNCTION.match(value):
        return None if functions else (f"the function {written}, and not its value", f"Write {written}()")
    if value.startswith("<class "):
        members = _members(value[8:-2])
        remedy = f"Write one of its values.{members}" if members else f"Write {written}(...), as its __init__ needs."
        return f"the class {written}, and no object of it", remedy
    if functions and (written.endswith(")") or len(functions) == len(kinds)):
        return f"the value {value}, and no function", _pass_function(written)
    is_text = value[:1] in "'\""
    if is_text and "str" not in kinds:
        if kinds == ["bool"]:
            return f"{written}, a text", "Write True or False, without quotes."
        number = value[1:-1] if re.fullmatch(r".-?\d+(\.\d+)?.", value) else ""
        remedy = (
            f"Write it without quotes: {number}"
            if number
            else _value_for(value[1:-1], [paths.get(each, each) for each in kinds])
        )
        return f"{written}, a text", remedy
    if re.fullmatch(r"-?\d+(\.\d+)?|True|False", value) and kinds == ["str"]:
        return f"{written}, which is no text", f"Write str({written}), or the text in quotes."
    if (of := re.match(r"<?(?:[\w.]*\.)?([A-Z]\w+)[ (]", value)) and kinds == ["number"]:
        numbers = numbers_of(getattr(sys.modules.get(home_of(of[1])), of[1], object))
        shown = ", ".join(f".{each}()" for each in numbers[:6])
        return (
            f"{written}, an object of {of[1]}",
            f"Pass a number, such as one of these of it: {shown}" if shown else "Pass a number.",
        )
    if value[:1] == "(" and kinds == ["number"]:
        return f"{written}, which is {value}", f"Is there a comma too much, as in {written} = 0.5,? It makes a tuple."
    classes = [kind for kind in kinds if kind[:1].isupper() and "[" not in kind]
    if re.fullmatch(r"-?\d+(\.\d+)?", value) and classes and len(classes) + len(functions) == len(kinds):
        return f"{written}, a number, and no {classes[0]}", _object_for(
            class_of(paths.get(classes[0], "")), classes[0], written
        )
    if classes and value[:1] == "(":
        return f"{written}, and no {classes[0]}", f"Write {classes[0]}(...)"
    return None


def _value_for(text: str, kinds: list[str]) -> str:
    """Return what to write for a text, where an enum's value or something else belongs."""
    for cls in (class_of(each) for each in kinds):
        known = {re.sub("^k", "", each).lower(): each for each in getattr(cls, "__members__", ())}
        if cls is not None and (close := get_close_matches(text.lower(), known, n=1)):
            return f"Write {public_name(cls)}.{known[close[0]]}"
    if kinds == ["number"]:
        return "Pass a number, and no text."
    return f"It must be: {' or '.join(each.rpartition('.')[2] for each in kinds)}."


def _object_for(cls: type[Any] | None, kind: str, written: str) -> str:
    """Return what to write for an argument that is a number, and must be an object of a class."""
    if hasattr(cls, in_2027("fromDegrees")):
        return (
            f"Write {kind}.{in_2027('fromDegrees')}({written}), if it is in degrees: from {home_of(kind)} import {kind}"
        )
    if kind == "MotorController":
        return f"Write wpilib.PWMSparkMax({written}), or the name of a motor controller that is made already."
    name = cls.__qualname__ if cls is not None else kind
    outer = name.partition(".")[0]
    home = home_of(outer)
    return f"Write {name}(...), from {home} import {outer}" if home else f"Pass an object of {name}, and no number."


def _pass_function(written: str) -> str:
    if re.fullmatch(r"[\w.]+\(\)", written):
        return f"Pass the function itself: {written[:-2]} without (), or lambda: {written}"
    return f"Write lambda: {written or 'function(1)'}"


def _text_passed(got: str, files: RobotFiles) -> Explanation | None:
    """Explain an error that comes later than the call that has got a text for a number."""
    texts = [each for each in _values(got, got.count(", ") + 1) if each[:1] in "'\""]
    for place, call in robot_calls(files):
        for each in (*call.args, *(keyword.value for keyword in call.keywords)):
            if isinstance(each, ast.Constant) and repr(each.value) in texts:
                text = f"{last_name(call.func)}() got {each.value!r}, a text"
                return Explanation(text, "Pass a number, without quotes.", place)
    return None


def _got_none(name: str, written: str, files: RobotFiles, takes: str = "") -> Explanation:
    """Explain an argument that is None.

    :param written: the argument as the user has written it
    """
    form = f"\n  It takes: {takes}" if takes else ""
    if written in ("None", ""):
        return Explanation(f"{name}() got None", f"Pass a value.{form}")
    return Explanation(
        f"{name}() got None, from {written}", f"{without_return(written, files) or ask_for(written)}{form}"
    )


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
        default = re.sub(r"<[^>]* at 0x\w+>", "...", re.sub(r"<([\w.]+): .*>", r"\1", default))
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
    called, name, written = _called_from(error, where[0]), found[1], ""
    for call in calls_at(*where, "") if called is not None else ():
        if called and last_name(call.func) in (called.f_code.co_name, type(called.f_locals.get("self")).__name__):
            passed = passed_to(call, called.f_code.co_varnames[: called.f_code.co_argcount]).items()
            wrong = ((each, ast.unparse(given)) for each, given in passed if called.f_locals.get(each) is value)
            name, written = next(wrong, (name, written))
    text = f"{name} must be a function, but is {kind}{f', from {written}' if '(' in written else ''}"
    return Explanation(text, _pass_function("" if written == "None" else written))


def _called_from(error: BaseException, frame: FrameType) -> FrameType | None:
    """Return the frame of the library's function that the user's has called; None if that is pyfrc's."""
    entry = error.__traceback__
    while entry is not None and entry.tb_frame is not frame:
        entry = entry.tb_next
    called = entry.tb_next.tb_frame if entry is not None and entry.tb_next is not None else None
    return None if called is None or is_pyfrc(called.f_code.co_filename) else called
