"""Names that a library no longer has, or that are misspelt."""

from __future__ import annotations

import ast
import builtins
import os
import re
import sys
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from importlib.util import find_spec
from itertools import pairwise
from pathlib import PurePath
from traceback import walk_tb
from types import FrameType

from ..project.robot_files import RobotFiles
from ..season import CURRENT
from ..season.names.table import table
from . import places
from .explanation import Explanation
from .other_season import earlier_name, in_2027
from .places import (
    imported_name,
    last_name,
    line_of_class,
    made_by,
    owner_of,
    place_of_assignment,
    robot_trees,
    statement_at,
    users_frame,
    value_of,
)
from .returned import class_of, maker_of, returned_by, short_name, sibling_of

#: Names of other languages: what Python calls them.
_ELSEWHERE = {"true": "True", "false": "False", "null": "None", "nil": "None", "NULL": "None", "this": "self"}

#: The parameters of tests.
_FIXTURES = frozenset({"control", "fake_time", "hal_data", "physics_controller", "robot", "robot_file", "robot_path"})
#: The longest expression of the robot's code that a message repeats, in characters.
_LONGEST_WRITTEN = 60
#: How many names are listed.
_SHOWN = 8
#: The methods that create what a robot has.
_AT_START = ("robotInit", "robot_init", "createObjects", "__init__")
#: The libraries whose names may be in the table.
_KNOWN = (
    *("wpilib", "wpilib_drivers", "commands2", "rev", "phoenix6", "phoenix5", "navx", "ntcore", "wpimath", "magicbot"),
    *("hal", "telemetry", "tunables"),
)


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    if isinstance(error, AttributeError) and error.name and " for setting " not in str(error):  # from Python 3.13 on
        return _attribute(error, error.name, files)
    if isinstance(error, AttributeError) and (found := re.search(r"object (?:has no )?attribute '(\w+)'", str(error))):
        return _assigned(found[1], users_frame(error, files))
    if isinstance(error, ImportError) and error.name and (wanted := imported_name(error)):
        return _import(wanted, error.name)
    if isinstance(error, UnboundLocalError):
        return _unbound(error, files)
    if isinstance(error, NameError) and error.name:
        return _name(error.name, users_frame(error, files), files)
    return None


def _assigned(name: str, where: tuple[FrameType, int] | None) -> Explanation | None:
    """Explain ``motor.inverted = True`` and ``motor.setInverted = True``, which a library's object does not allow."""
    statement = statement_at(*where) if where is not None else None
    for target in statement.targets if isinstance(statement, ast.Assign) and where is not None else []:
        owner = owner_of(target, where[0]) if last_name(target) == name and where is not None else None
        if callable(getattr(owner, name, None)) and isinstance(statement, ast.Assign):
            text, written = "is a method, and cannot be set", ast.unparse(target)
            return Explanation(f"{written} {text}", f"Write {written}({ast.unparse(statement.value)})")
        if owner is not None:
            setters = [each for each in dir(owner) if each.startswith("set")]
            return Explanation(f"{ast.unparse(target)} cannot be set", meant(f"set_{name}", setters))
    return None


def _name(name: str, where: tuple[FrameType, int] | None, files: RobotFiles) -> Explanation:
    if name in _ELSEWHERE and not (name == "this" and where is None):
        return Explanation(remedy=f"Did you mean {_ELSEWHERE[name]}?")
    known = [*where[0].f_locals, *where[0].f_globals, *dir(builtins)] if where else []
    if where and name in dir(where[0].f_locals.get("self")):
        return Explanation(remedy=f"Did you mean self.{name}?")
    if name == "self":
        remedy = "Only methods with the parameter self have it: move the line into one, such as robotInit."
        return Explanation(remedy=remedy)
    if where and name in _FIXTURES and not files.is_robot_code(where[0].f_code.co_filename):
        return Explanation(remedy=f"Write it as a parameter: {_with_fixtures(*where)}")
    if path := _nested(name, sys.modules.get("wpilib")):
        return Explanation(remedy=f"Did you mean {path}?")
    if home := home_of(name) or _in_project(name, files):
        return Explanation(remedy=f"Is this line missing at the top: from {home} import {name}")
    if close := get_close_matches(name, known, n=1, cutoff=0.75):
        return Explanation(remedy=f"Did you mean {close[0]}?")
    robot = where[0].f_locals.get("self") if where else None
    place, target, method = place_of_assignment(type(robot), files, name)
    if target == name:
        return Explanation(remedy=f"Only {method} has this {name} ({place}): write self.{name} in both places.")
    remedy = f"Nothing has given {name} a value: is it misspelt, or is an import or a parameter missing?"
    return Explanation(remedy=remedy)


def _with_fixtures(frame: FrameType, line: int) -> str:
    """Return the head of the function around a line, with each fixture that it uses among its parameters."""
    function = places.functions_around(frame, line)[0]
    names = [each for each in ast.walk(function) if isinstance(each, ast.Name)]
    own = {each.id for each in names if isinstance(each.ctx, ast.Store)} | {*frame.f_globals}
    own |= {each.arg for each in ast.walk(function) if isinstance(each, ast.arg)}
    used = sorted({each.id for each in names if each.id in _FIXTURES} - own)
    return f"def {function.name}({', '.join(filter(None, (ast.unparse(function.args), *used)))}):"


def _unbound(error: UnboundLocalError, files: RobotFiles) -> Explanation | None:
    found, frame = re.search(r"variable '(\w+)'", str(error)), users_frame(error, files)
    if found is None or frame is None:
        return None
    name = found[1]
    robot, statement = frame[0].f_locals.get("self"), statement_at(*frame)
    if isinstance(statement, ast.AugAssign) and last_name(statement.target) == name and robot is not None:
        changed = ast.unparse(ast.AugAssign(ast.Name(f"self.{name}"), statement.op, statement.value))
        before = "" if hasattr(robot, name) else f", and self.{name} = 0 in {in_2027('robotInit')} or __init__"
        text = f"{name} has no value yet: a function forgets its names when it ends"
        return Explanation(text, f"Write {changed}{before}.")
    if name in frame[0].f_globals:
        remedy = f"Keep the value in the robot, as self.{name}; or write first in the function: global {name}"
        return Explanation(remedy=remedy)
    return Explanation(remedy=f"Not every way through the function sets {name}: give it a value at the beginning.")


def _attribute(error: AttributeError, name: str, files: RobotFiles) -> Explanation | None:
    obj = error.obj
    owner = obj if isinstance(obj, type) else type(obj)
    is_module = owner.__module__ == "builtins" and not isinstance(obj, type)
    module = getattr(obj, "__name__", "") if is_module else owner.__module__
    bases = (module, *(each.__module__ for each in owner.__mro__))
    is_library = any(base.partition(".")[0] in (*_KNOWN, "pyfrc_core") for base in bases)
    if is_library and (instead := earlier_name(name, owner)):
        what = module if is_module else owner.__name__
        any_more = " any more" if is_module or owner.__module__.partition(".")[0] in _KNOWN else ""
        return Explanation(f"{what} has no {name}{any_more}", f"Instead: {instead}.")
    if is_module and module in _KNOWN and find_spec(f"{module}.{name}") is not None:
        return Explanation(remedy=f"Is this line missing at the top: import {module}.{name}")
    if is_module and is_library and (home := home_of(name)):
        return Explanation(remedy=f"{name} is in another module: from {home} import {name}")
    known = [each for each in dir(obj) if not each.startswith("__")]
    where = users_frame(error, files)
    in_test = where is not None and not files.is_robot_code(where[0].f_code.co_filename)
    if in_test and is_module and module in _FIXTURES and files.is_robot_code(str(getattr(obj, "__file__", ""))):
        text = f"{module} is the file {module}.py here, and not the {module} that the test runs"
        return Explanation(text, f"Remove import {module}, and write {module} as a parameter of the test.")
    if isinstance(obj, Mapping) and name in obj and where is not None:
        written = next(ast.unparse(each) for each in _of_attribute(name, *where))
        return Explanation(f"{written} has no attributes: its values have keys", f"Write {written}[{name!r}]")
    if isinstance(obj, (int, float, str)):
        of = [each for each in _of_attribute(name, *where) if value_of(each, where[0]) is obj] if where else []
        written = ast.unparse(of[0]) if of else ""
        kind = "a text" if isinstance(obj, str) else "True or False" if isinstance(obj, bool) else "a number"
        return Explanation(f"{written or repr(obj)} is {kind} ({obj!r}) and has no {name}", meant(name, known))
    declared = any(name in getattr(base, "__annotations__", {}) for base in owner.__mro__)
    if declared and not isinstance(obj, type) and "magicbot" in sys.modules:
        if any(base.__name__ == "MagicRobot" for base in owner.__mro__):
            text = f"there is no {name} yet: magicbot creates the components after createObjects()"
            return Explanation(text, "Use it in teleopInit or teleopPeriodic, or in setup() of a component.")
        text = f"{name} has no value yet: magicbot sets what a class declares after its __init__"
        return Explanation(text, "Write def setup(self): in place of __init__, or move this line there.")
    words = meant(name, known)
    if is_library and not is_module and where is not None:
        written = next((ast.unparse(each) for each in _of_attribute(name, *where)), owner.__name__)
        inner = (each for each in vars(owner).values() if isinstance(each, type) and hasattr(each, name))
        if isinstance(obj, type) and (holder := next(inner, None)) is not None:
            return Explanation(f"{written} has no {name}", f"Write {written}.{holder.__name__}.{name}")
        what = f"{'the class' if isinstance(obj, type) else 'an object of'} {owner.__name__}"
        # A long chain of calls says less than its class.
        text = f"{written}, {what}, has no {name}" if len(written) <= _LONGEST_WRITTEN else f"{what} has no {name}"
        spelt_alike = len(name) > 1 and any(each.lower() == name.lower() for each in known)
        if not isinstance(obj, type) and not spelt_alike and (instead := _elsewhere(owner, name, written, files)):
            return Explanation(text, instead)
        if words and owner.__module__.partition(".")[0] in _KNOWN:
            return Explanation(text, words)
    if words and not (isinstance(obj, type) and not is_library):
        return Explanation(remedy=words)
    if is_module and is_library and (nested := _nested(name, obj)):
        return Explanation(remedy=f"Did you mean {nested}?")
    if is_library and not is_module and owner.__module__.partition(".")[0] in (*_KNOWN, "pyfrc_core"):
        members = dict.fromkeys(
            each
            for base in owner.__mro__
            for each, value in sorted(vars(base).items())
            if each[0] != "_" and base is not object and not isinstance(value, type)
        )
        remedy = f"It has: {', '.join(list(members)[:_SHOWN])}{', ...' if len(members) > _SHOWN else ''}"
        return Explanation(remedy=remedy)
    if owner.__module__.partition(".")[0] in ("builtins", *_KNOWN):
        return None
    place, target, method = place_of_assignment(owner, files, name)
    if isinstance(obj, type):
        instance = next((each[1] for each in made_by(owner.__name__, files)), "")
        if not place or not instance:
            return Explanation(remedy=words) if words else None
        text = f"{owner.__name__} is the class, and only an object of it has {name} ({place} sets it)"
        return Explanation(text, f"Write {instance}.{name}")
    if (base := _missing_base(owner, name)) and not place:
        text = f"{owner.__name__} has no {name}: the class has no base class that has it"
        remedy = f"Write class {owner.__name__}({base}):, and super().__init__() as the first line of its __init__."
        return Explanation(text, remedy, line_of_class(owner, files))
    if target == name:
        return Explanation(remedy=f"Write self.{name} = ... in {place}: without self, the name is known there only.")
    for (test, line), (called, _) in pairwise(walk_tb(error.__traceback__)):
        file, its_name = test.f_code.co_filename, called.f_code.co_name
        in_test = files.is_project_file(file) and not files.is_robot_code(file)
        if in_test and files.is_robot_code(called.f_code.co_filename) and place and method in _AT_START[:-1]:
            mode = "autonomous" if its_name.startswith("auto") else "operator_control"
            text = f"the test calls {its_name}() itself, but {method} ({place}), which sets {name}, has not run"
            remedy = f"Instead: control.set_{mode}(enabled=True), then control.run_test(lambda tm: tm < 1)"
            return Explanation(text, remedy, f"{files.relative(file)}:{line}")
    if place and method in _AT_START and where is not None and not files.is_robot_code(where[0].f_code.co_filename):
        text = (
            f"the robot does not have {name} yet: {method} sets it ({place}), which runs when the test runs the robot"
        )
        return Explanation(text, "Read it after control.run_test(...), or inside: with control.run_robot():")
    if place:
        remedy = f"{place} sets {name}, but has not run yet: move it to __init__ or {in_2027('robotInit')}."
        return Explanation(remedy=remedy)
    return Explanation(remedy=f"Nothing has set {name}: is the line missing, or is the name misspelt?")


def _elsewhere(owner: type, name: str, written: str, files: RobotFiles) -> str:
    """Return what to write for a name that another object has: one that a method of the object returns, or one of a
    class that is much like its own; empty if there is none.
    """
    if (maker := maker_of(owner, name)) is not None:
        method, cls = maker
        kept = short_name(cls)
        calls = f"{written}.{method}().{name}(...)"
        kept_once = f"{kept} = {written}.{method}() once, and then {kept}.{name}(...)"
        return f"{cls.__name__} has it: write {calls if method.startswith('get') else kept_once}"
    if (other := sibling_of(owner, name, _with_classes())) is None:
        return ""
    module, cls = other
    if returning := returned_by(cls, module):
        return f"{cls.__name__} has it, which {returning}(...) returns."
    place, _, call = next(made_by(owner.__name__, files), ("", "", None))
    arguments = ", ".join(map(ast.unparse, call.args)) if call is not None else "..."
    where_made = f" in {place}, where it is made" if place else ", where it is made"
    return f"{cls.__name__} has it: write {module}.{cls.__name__}({arguments}){where_made}"


def _missing_base(owner: type, name: str) -> str:
    """Return the library's class that a class of the user's was probably to be derived from; empty if it has a base."""
    bases = ("commands2.Subsystem", "commands2.Command", "wpilib.TimedRobot", "magicbot.StateMachine")
    found = (each for each in bases if owner.__bases__ == (object,) and hasattr(class_of(each), name))
    return next(found, "")


def _of_attribute(name: str, frame: FrameType, line: int) -> Iterator[ast.expr]:
    """Yield what stands before an attribute of this name in a statement."""
    for each in ast.walk(statement_at(frame, line)):
        if isinstance(each, ast.Attribute) and each.attr == name:
            yield each.value


def home_of(name: str) -> str:
    """Return the module of WPILib or a vendor's that has a class or function of this name; empty if none has."""
    homes = table().homes(name, new=CURRENT.year >= 2027) if len(name) > 5 and "wpilib" in sys.modules else []
    return next((each for each in homes if find_spec(each.partition(".")[0]) is not None), "")


def _with_classes() -> list[str]:
    """Return the imported public modules of WPILib, with the names of the robot's classes first."""
    tops = ("wpilib", "commands2", "wpimath", "ntcore", "cscore")
    found = [each for each in sys.modules if each.partition(".")[0] in tops and "._" not in each]
    return sorted(found, key=lambda each: (tops.index(each.partition(".")[0]), "simulation" in each, each))


def _in_project(name: str, files: RobotFiles) -> str:
    """Return the module of the robot that defines a class or function; empty if none does."""
    for file, tree in robot_trees(files):
        if any(getattr(node, "name", "") == name for node in tree.body):
            return str(PurePath(file).with_suffix("")).replace(os.sep, ".")
    return ""


def _nested(name: str, module: object) -> str:
    """Return the path of a class or constant that is inside a class, such as ``wpilib.Alert.AlertType``."""
    classes = [each for each in vars(module or object).values() if isinstance(each, type)]
    classes += [inner for each in classes for inner in vars(each).values() if isinstance(inner, type)]
    found = [cls for cls in classes if name in vars(cls) and (name[:1].isupper() or hasattr(cls, "__members__"))]
    return f"{getattr(module, '__name__', '')}.{found[0].__qualname__}.{name}" if found else ""


def _import(name: str, module: str) -> Explanation:
    if module.partition(".")[0] in _KNOWN and (instead := earlier_name(name, object)):
        return Explanation(f"{module} has no {name} any more", f"Instead: {instead}.")
    known = [each for each in dir(sys.modules.get(module)) if not each.startswith("_")]
    if home := home_of(name):
        return Explanation(f"{module} has no {name}", f"Write: from {home} import {name}")
    return Explanation(f"{module} has no {name}", meant(name, known) or "Is the name right?")


def meant(name: str, known: list[str]) -> str:
    """Return a question with the names that were probably meant: those that differ in a letter or two, or in order of
    words, or that have its words among others; empty if there are none.
    """
    known = [each for each in known if each[:1].islower() or not name[:1].islower()] or known
    same = [each for each in known if each.lower().replace("_", "") == name.lower().replace("_", "")]
    words = _words(name)
    same = same or [each for each in known if sorted(_words(each)) == sorted(words)]
    begins = _words(name, whole=True)[:1]  # set, get: of two names, the one that does the same
    same = same or [each for each in known if _words(each) == words]
    longer = [each for each in known if set(words) <= set(_words(each, whole=True)) and each[0] != "_"]
    if same and begins != words[:1] and _words(same[0], whole=True)[:1] != begins:
        same = [each for each in longer if _words(each, whole=True)[:1] == begins] or same
    close = same[:1] or get_close_matches(name, known, n=1, cutoff=0.75 if len(name) > 3 else 0.9) or longer
    if name[:1].islower():  # reset, for resetEncoder
        close = close or [each for each in known if len(each) > 3 and set(_words(each, whole=True)) < set(words)]
    return f"Did you mean {' or '.join(close[:_SHOWN])}?" if words and close else ""


def _words(name: str, whole: bool = False) -> list[str]:
    """Return the words of a name, in lower case, without what says only that it returns or sets something."""
    words = [each.lower() for each in re.findall(r"[A-Z]{2,}(?![a-z])|[A-Z]?[a-z]+|[A-Z]|\d+", name)]
    return [each for each in words if whole or each not in ("get", "is", "k")] or words
