"""Calls that Python refuses: a method without its brackets, a module for its class, too many or too few values."""

from __future__ import annotations

import ast
import builtins
import inspect
import re
from types import FrameType, ModuleType
from typing import Any

from ..errors import nearest, text_of
from ..project.robot_files import RobotFiles
from ..wording import counted
from .explanation import Explanation, ask_for
from .other_season import earlier_name
from .places import (
    UNKNOWN,
    beginning,
    calls_at,
    frames_of,
    functions_around,
    last_name,
    line_of_class,
    made_by,
    owner_of,
    passed_to,
    place_of_assignment,
    robot_calls,
    statement_at,
    users_frame,
    value_of,
)
from .returned import class_of, numbers_of, public_name

#: How Python names a function in the text of an error about a value.
_FUNCTION = r"(?:method|builtin_function_or_method|function|instancemethod)"
_OF_A_FUNCTION = re.compile(
    rf"AttributeError: ('{_FUNCTION}' object|__enter__)|TypeError: (?!.*arguments).*(?:'|not |type ){_FUNCTION}\b"
)
_NO_NUMBER = re.compile(
    r"TypeError: (?:'.+' not supported between instances of|unsupported operand type.*?:|bad operand type.*?:) "
    r"'(?P<left>[\w.]+)'(?: and '(?P<right>[\w.]+)')?"
)
#: The functions of Python that compute with what they get.
_COMPUTING = frozenset({"abs", "max", "min", "round", "float", "int", "len", "str", "sum"})
_COUNT = re.compile(
    r"TypeError: (?:[\w.<>]+\.)?(?P<name>\w+)\(\) (takes .* positional arguments?"
    r"|missing \d+ required[^:]*: (?P<missing>.*)|got an unexpected keyword argument '(?P<keyword>\w+)')"
)


#: Functions of pyfrc whose parameters say less than an example.
_SUCH_AS = {
    "run_test": "For three seconds of robot time, write: control.run_test(lambda tm: tm < 3)",
    "step_timing": "Write control.step_timing(seconds=3, autonomous=False, enabled=True)",
}


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    text = text_of(error)
    where = users_frame(error, files)
    if where is None:
        return None
    if _OF_A_FUNCTION.match(text) and (explained := _not_called(*where, files)):
        return explained
    if text.startswith("TypeError: 'module' object is not callable"):  # since Python 3.13 perhaps with a suggestion
        return _module(*where)
    if "'NoneType'" in text and frames_of(error)[-1] is where[0] and (explained := _none_from_call(*where)):
        return explained
    if text.endswith("object is not callable"):
        return _called_value(*where, files)
    if found := _NO_NUMBER.match(text):
        return _no_number(found, *where)
    if isinstance(error, (KeyError, IndexError)) and frames_of(error)[-1] is where[0]:
        return _key(error, *where)
    if text == "TypeError: 'float' object cannot be interpreted as an integer":
        return _whole_number(*where)
    if found := _COUNT.match(text):
        return _count(found, *where, files)
    return None


def _not_called(frame: FrameType, line: int, files: RobotFiles) -> Explanation | None:
    """Explain a method that is used like its value, such as ``self.timer.get < 2``."""
    nodes = list(ast.walk(statement_at(frame, line)))
    calls = [each for each in nodes if isinstance(each, ast.Call)]
    # A function that another one gets is probably meant, unless that one computes.
    passed = [each for call in calls if last_name(call.func) not in _COMPUTING for each in call.args]
    passed += [keyword.value for call in calls for keyword in call.keywords] + [call.func for call in calls]
    for each in nodes:
        value = value_of(each, frame) if isinstance(each, ast.expr) and each not in passed else UNKNOWN
        if not callable(value) or isinstance(value, type) or not isinstance(each, ast.expr):
            continue
        written, owner = ast.unparse(each), owner_of(each, frame)
        place, _, _ = place_of_assignment(type(owner), files, last_name(each))
        own = callable(getattr(type(owner), last_name(each), None))  # and set by no line that has run
        remedy = f"Write () where it is set ({place})" if place and not own else f"Write {written}()"
        code = getattr(value, "__code__", None)
        if code is not None and not re.search(r"\breturn [^\s#]|\blambda\b", inspect.getsource(code)):
            return Explanation(f"{written} is a function, and returns nothing", "Is the name right?")
        if isinstance(owner, type) and (instead := earlier_name(last_name(each), owner)):
            remedy = f"Instead: {instead}."
        return Explanation(f"{written} is a function, and not its value", remedy)
    return None


def _no_functions(frame: FrameType, line: int, files: RobotFiles) -> Explanation | None:
    """Explain values that a function around a line has got for parameters that it calls."""
    called = {ast.unparse(each.func): value_of(each.func, frame) for each in calls_at(frame, line, "")}
    for function in functions_around(frame, line):
        parameters = [each.arg for each in function.args.args]
        wrong = [each for each in parameters if not callable(called.get(each, print))]
        calls = [each for each in robot_calls(files) if last_name(each[1].func) == function.name]
        given = [(place, [passed_to(call, parameters).get(each) for each in wrong]) for place, call in calls]
        given = [each for each in given if each[1] and all(each[1]) and ast.Lambda not in map(type, each[1])]
        if len(given) == 1:
            kinds = ", ".join(dict.fromkeys(type(called[each]).__name__ for each in wrong))
            be = f"functions, but are values ({kinds})" if wrong[1:] else f"a function, but is a value ({kinds})"
            remedy = ", ".join(f"lambda: {ast.unparse(each)}" for each in given[0][1] if each is not None)
            return Explanation(f"{' and '.join(wrong)} must be {be}", f"Write there: {remedy}", given[0][0])
    return None


def _called_value(frame: FrameType, line: int, files: RobotFiles) -> Explanation | None:
    """Explain ``self.speed()``, where `speed` is a number, and a method that a value has replaced."""
    for call in calls_at(frame, line, ""):
        value, written = value_of(call.func, frame), ast.unparse(call.func)
        if value is UNKNOWN or callable(value):
            continue
        if value is None:
            return Explanation(f"{written} is None, and no function", ask_for(written))
        if callable(getattr(type(owner_of(call.func, frame)), last_name(call.func), None)):
            owner, name = owner_of(call.func, frame), last_name(call.func)
            cls = next(each for each in type(owner).__mro__ if name in vars(each))
            place, _, _ = place_of_assignment(type(owner), files, name)
            if place and (method := line_of_class(cls, files, name)):
                method = method.replace(f"{place.rpartition(':')[0]}:", "line ")
                text = f"{place} sets {written}, which hides the method of {method}"
                return Explanation(text, "Give one of the two another name.")
            shown = repr(value) if isinstance(value, (bool, int, float, str)) else f"a {type(value).__name__}"
            text = f"{written} was a method, but something has set it to {shown}"
            return Explanation(text, f"Search for {name} = and choose another name there.")
        kind = type(value).__name__
        if hasattr(builtins, written):
            text = f"{written} is {value!r} here, and no longer Python's function {written}()"
            return Explanation(text, f"Write another name for it where {written} = ... stands.")
        if isinstance(call.func, ast.Name) and (explained := _no_functions(frame, line, files)):
            return explained
        method = next((each for each in ("calculate", "get") if hasattr(value, each)), "")
        if method and not isinstance(value, dict):
            text = f"{written} is an object of {kind}, and no function"
            return Explanation(text, f"Write {written}.{method}({', '.join(map(ast.unparse, call.args))})")
        instead = f"{written}[...]" if isinstance(value, (list, tuple, dict)) else written
        return Explanation(f"{written} is a value ({kind}), and no function", f"Write {instead}, without ()")
    return None


def _none_from_call(frame: FrameType, line: int) -> Explanation | None:
    """Explain a local name that is None, if its only value is that of a call in the same function."""
    nodes = [each for function in functions_around(frame, line)[-1:] for each in ast.walk(function)]
    stored = [each.id for each in nodes if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)]
    used = [each.id for each in ast.walk(statement_at(frame, line)) if isinstance(each, ast.Name)]
    nones = [each for each in used if frame.f_locals.get(each, UNKNOWN) is None and stored.count(each) == 1]
    for each in (node for node in nodes if isinstance(node, ast.Assign) and last_name(node.targets[0]) in nones):
        if isinstance(call := each.value, ast.Call):
            name, (written, *rest) = last_name(each.targets[0]), map(ast.unparse, call.args or [call.func])
            changed = f"{written}.{last_name(call.func)}({', '.join(rest)}), and use {written} for {name}"
            on_class = isinstance(owner_of(call.func, frame), type)
            remedy = f"If it changes {written}: write {changed}." if on_class else ask_for(ast.unparse(call))
            return Explanation(f"{name} is None: {ast.unparse(call)} in line {call.lineno} returns nothing", remedy)
    return None


def _no_number(found: re.Match[str], frame: FrameType, line: int) -> Explanation | None:
    """Explain a text, None, or an object of a library's class, such as a Rotation2d, among numbers."""
    names = [each for each in found.groups() if each]
    computed = map(_operands, ast.walk(statement_at(frame, line)))
    operands = next((each for each in computed if each and _may_be_of(names, each, frame)), [])
    for each, name in zip(operands, names, strict=False):
        written, cls = ast.unparse(each), class_of(name)
        if name == "NoneType":
            return Explanation(f"{written} is None, and no number", ask_for(written))
        if name == "str" and found["left"] != found["right"]:
            return Explanation(f"{written} is a text, and no number", f"Write float({written}), if it has digits only.")
        if cls is not None and (numbers := numbers_of(cls)):
            shown = ", ".join(f".{each}()" for each in numbers[:6])
            text = f"{written} is an object of {cls.__name__}, and no number"
            return Explanation(text, f"Write one of these behind it: {shown}")
    return None


def _may_be_of(names: list[str], operands: list[ast.expr], frame: FrameType) -> bool:
    """Return whether operands may be of the classes with these names: a line may compute more than once."""
    values = zip((value_of(each, frame) for each in operands), names, strict=False)
    return all(value is UNKNOWN or type(value).__name__ == name.rpartition(".")[2] for value, name in values)


def _key(error: KeyError | IndexError, frame: FrameType, line: int) -> Explanation | None:
    """Explain a key that a dict of the user's does not have, or an index that a list does not have."""
    for each in ast.walk(statement_at(frame, line)):
        held: Any = value_of(each.value, frame) if isinstance(each, ast.Subscript) else None
        at = value_of(each.slice, frame) if isinstance(each, ast.Subscript) else UNKNOWN
        if isinstance(each, ast.Subscript) and type(held) in (list, tuple) and type(at) is int and at >= len(held):
            written, count = ast.unparse(each.value), len(held)
            text = f"{ast.unparse(each)}: {written} has {counted(count, 'value')}, and indexes begin with 0"
            return Explanation(
                text, f"The last one is {written}[{count - 1}]" if held else f"Has anything filled {written}?"
            )
        if isinstance(each, ast.Subscript) and type(held) is dict and error.args[0] not in held:
            written, hint = ast.unparse(each.value), nearest(str(error.args[0]), list(map(str, held)))
            got = f", from {ast.unparse(each)}" * (not isinstance(each.slice, ast.Constant))
            return Explanation(f"{written} has no key {error.args[0]!r}{got}", hint[0].upper() + hint[1:])
    return None


def _whole_number(frame: FrameType, line: int) -> Explanation | None:
    """Explain ``range(10 / 2)``."""
    for call in calls_at(frame, line, ""):
        for each in call.args:
            if isinstance(each, ast.BinOp) and isinstance(each.op, ast.Div):
                whole = ast.unparse(ast.BinOp(each.left, ast.FloorDiv(), each.right))
                text = f"{last_name(call.func)}() takes whole numbers, and {ast.unparse(each)} is none: / makes a float"
                return Explanation(text, f"Write {whole}")
        if call.args:
            written = ast.unparse(call.args[0])
            return Explanation(f"{last_name(call.func)}() takes whole numbers", f"Write int({written})")
    return None


def _operands(node: ast.AST) -> list[ast.expr]:
    if isinstance(node, ast.UnaryOp):
        return [node.operand]
    if isinstance(node, (ast.BinOp, ast.AugAssign)):
        return [node.left, node.right] if isinstance(node, ast.BinOp) else [node.target, node.value]
    return [node.left, *node.comparators] if isinstance(node, ast.Compare) else []


def _module(frame: FrameType, line: int) -> Explanation | None:
    """Explain ``arm()`` for ``arm.Arm()``, and ``time()`` for ``time.time()``."""
    for call in calls_at(frame, line, ""):
        module = value_of(call.func, frame)
        if not isinstance(module, ModuleType):
            continue
        name = ast.unparse(call.func)
        known = [each for each, value in vars(module).items() if getattr(value, "__module__", "") == module.__name__]
        same = [each for each in vars(module) if each.lower() == last_name(call.func).lower()]
        meant = next(iter([*same, *known]), "NAME")
        return Explanation(f"{name} is a module, and cannot be called", f"Write {name}.{meant}(), or what else it has")
    return None


def _count(found: re.Match[str], frame: FrameType, line: int, files: RobotFiles) -> Explanation | None:
    """Explain a call with the wrong number of values, or a wrong name; Python counts `self` among them."""
    for call in calls_at(frame, line, ""):
        called = value_of(call.func, frame)
        name = ast.unparse(call.func)
        owner = owner_of(call.func, frame)
        if isinstance(owner, type) and last_name(call.func) == found["name"] and found["missing"] == "'self'":
            return called_on_class(call, owner, frame, files)
        function = vars(called).get("__init__") if isinstance(called, type) else called
        if getattr(function, "__name__", "") != found["name"]:
            continue
        parameters = [
            f"{each.name}={each.default!r}"
            if each.default is not each.empty
            else f"{each.name}{'=...' * (each.kind is each.KEYWORD_ONLY)}"
            for each in inspect.signature(called).parameters.values()
        ]
        code = getattr(function, "__code__", None)
        ours = code is not None and files.is_project_file(code.co_filename)
        at = f" ({files.relative(code.co_filename)}:{code.co_firstlineno})" if code is not None and ours else ""
        got = f"with {counted(len(call.args) + len(call.keywords), 'value')}"
        if found["keyword"]:
            got = f"with {found['keyword']}="
        elif found["missing"]:
            got = f"without {found['missing']}"
        if call.args and ast.unparse(call.args[0]) == "self" and name.startswith(("self.", "super().")):
            rest = ", ".join(map(ast.unparse, call.args[1:]))
            return Explanation(f"{name}() gets self twice: before the dot, and in ()", f"Write {name}({rest}){at}")
        takes = f"It takes: {name}({', '.join(parameters)}){at}"
        return Explanation(f"{name}() was called {got}", _SUCH_AS.get(found["name"], takes))
    return None


def called_on_class(call: ast.Call, cls: type, frame: FrameType, files: RobotFiles) -> Explanation:
    """Explain a method that is called on a class, such as ``wpilib.Timer.get()``."""
    name, written = last_name(call.func), ast.unparse(call.func).rpartition(".")[0]
    if isinstance(frame.f_locals.get("self"), cls):
        return Explanation(f"{name}() is called without self", f"Write super().{name}(), with what it takes.")
    text = f"{name}() is called on the class {written}, and not on an object of it"
    for method in ("getInstance", "getDefault", "get_instance", "get_default"):
        if hasattr(cls, method):
            return Explanation(text, f"Write {written}.{method}().{name}(...)")
    attribute, owner = written.rpartition(".")[2], type(frame.f_locals.get("self"))
    if vars(owner).get(attribute) is cls:
        class_name = public_name(cls)
        return Explanation(
            f"{written} is the class {class_name}, and no object: = in the class {owner.__name__} sets it to that",
            f"For magicbot, write {attribute}: {class_name}. Else create it in __init__: {written} = {class_name}(...)",
        )
    if held := next((each[1] for each in made_by(cls.__name__, files)), ""):
        return Explanation(text, f"Write {held}.{name}(...)")
    if written.rpartition(".")[2] == cls.__name__:
        start = beginning(frame)
        remedy = f"Create an object in {start}, as in: self.it = {written}(...). Then call: self.it.{name}(...)"
        return Explanation(text, remedy)
    passed = (place for place, call in robot_calls(files) if cls.__name__ in map(last_name, call.args))
    text = f"{written} is the class {cls.__name__}, and no object of it"
    return Explanation(text, f"Write {cls.__name__}(...), with what its __init__ needs.", next(passed, ""))
