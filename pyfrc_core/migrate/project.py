"""Rewrite a project's Python files: read all, find out what everything is, rewrite each."""

from __future__ import annotations

import platform
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from tokenize import detect_encoding

import libcst as cst

from ..season.names.table import Table
from .report import Report
from .rewrite import robot_init
from .rewrite.arguments import Arguments
from .rewrite.calls import Calls, key_of
from .rewrite.file import FileRewriter
from .rewrite.finish import new_text, rewrite_annotation
from .rewrite.gamepads import Gamepad, gamepads_by_port
from .rewrite.hal_data import HalData
from .rewrite.imports import NEW_MODULES
from .rewrite.leds import led_lists, rewrite_list
from .rewrite.leftovers import Leftovers
from .rewrite.lookup import Lookup
from .rewrite.ports import Ports
from .rewrite.unknown import Unknown
from .types.inference import Inference
from .types.scopes import Module

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True)
class Rewritten:
    """What becomes of a project's Python files.

    :param files: the new content of each that changes, by its name
    :param gamepads: those that it has, by their ports
    """

    files: Mapping[str, bytes]
    gamepads: Mapping[int, Gamepad]


@dataclass(frozen=True)
class Source:
    """A Python file of the project.

    :param name: relative to the project, with `/`
    """

    path: Path
    name: str
    text: bytes


def rewrite_all(
    sources: list[Source],
    table: Table,
    report: Report,
    *,
    home: str = "",
    first_time: bool,
    progress: Progress = lambda doing, done, of: None,
) -> Rewritten:
    """Return what becomes of the files.

    :param home: the directory with robot.py, whose modules import each other, with a `/`; "" for the project's own
    :param first_time: the project is still one of 2026
    :param progress: called with what is done, and how much of it
    """
    modules: dict[str, Module] = {}
    for position, source in enumerate(sources):
        progress("reading", position, len(sources))
        try:
            name = _module_name(source.name.removeprefix(home))
            modules[source.name] = Module(source.path, name, _parsed(source.text))
        except RecursionError:  # Python 3.12 has a limit of its own
            what = f"This is nested too deeply for Python {platform.python_version()}, so the file stays as it is."
            report.add(source.name, 1, what, "Run migrate with another Python, or rewrite it by hand.")
        except Exception as error:
            wrong = why_invalid(source.text) or error
            line = getattr(error, "raw_line", None) or getattr(wrong, "lineno", None) or 1
            valid = "Python can read this, but LibCST cannot" if wrong is error else "This is no valid Python"
            remedy = "Rewrite it by hand." if wrong is error else "Correct it first."
            report.add(source.name, line, f"{valid}, so the file stays as it is.", remedy)
    _report_taken_names(modules, table, report)
    project = _Project(modules, Inference(table, list(modules.values())))
    files = {
        module: FileRewriter(
            module, name, project.lookup, report, first_time=first_time, shared=module.name in project.shared
        )
        for name, module in modules.items()
    }
    changed = {}
    for position, (name, module) in enumerate(modules.items()):
        progress("rewriting", position, len(modules))
        old = module.tree.bytes
        try:
            new = _rewrite(files[module], project).encode(module.tree.encoding)
            invalid = new != old and why_invalid(new) is not None and why_invalid(old) is None
            failed = "it would be no valid Python" if invalid else ""
        except Exception as error:
            failed = f"{type(error).__name__}: {error}"
        if failed:
            report.forget(name)
            what = f"migrate cannot rewrite this file ({failed}), so it stays as it is."
            report.add(name, 0, what, "Rewrite it by hand, and report this: it is a mistake of pyfrc.")
        elif new != old:
            changed[name] = new
            report.changed |= files[module].changed_places()
    project.ports.report(report)
    project.unknown.report(report, files)
    progress("rewriting", len(modules), len(modules))
    return Rewritten(changed, project.gamepads)


def _parsed(text: bytes) -> cst.Module:
    """Return the tree of a file. LibCST does not find its encoding where lines end in CR alone, as Python does.

    :raises Exception: when LibCST cannot read it
    """
    try:
        return cst.parse_module(text)
    except SyntaxError:
        lines = BytesIO(text.replace(b"\r", b"\n"))
        return cst.parse_module(text, cst.PartialParserConfig(encoding=detect_encoding(lines.readline)[0]))


def why_invalid(code: bytes) -> Exception | None:
    """Return the error that Python raises when it compiles the code of a file."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            compile(code, "file", "exec", dont_inherit=True)
    except (SyntaxError, ValueError, OverflowError, MemoryError, RecursionError) as error:
        return error
    return None


class _Project:
    """What is known of all files together."""

    def __init__(self, modules: Mapping[str, Module], inference: Inference) -> None:
        table = inference.table
        self.lookup = Lookup(table, inference, modules.values())
        self.unknown = Unknown(self.lookup, modules)
        self.gamepads = gamepads_by_port(modules.values(), inference, table)
        self.led_lists = led_lists(inference, modules.values())
        self.ports = Ports(table)
        sites = [node for module in modules.values() for node, _ in module.sites]
        self.shared = {binding.path for module in modules.values() for binding in module.scope.bindings.get("*", ())}
        readers = {each for each in table.corrections["dashboard_table"]["members"] if not each.startswith("put")}
        reads = {
            key_of(node)
            for node in sites
            if isinstance(node, cst.Call) and isinstance(node.func, cst.Attribute) and node.func.attr.value in readers
        }
        self.dashboard_reads = frozenset(each for each in reads if each is not None)


def _report_taken_names(modules: Mapping[str, Module], table: Table, report: Report) -> None:
    """Report the project's modules with the name of a new one of WPILib's: only one of the two can be imported."""
    taken = {each.partition(".")[0] for each in (*table.modules.values(), *NEW_MODULES)}
    taken -= {"", *(each.partition(".")[0] for each in table.modules)}
    for name, module in modules.items():
        first = module.name.partition(".")[0]
        if first in taken:
            taken.remove(first)
            what = f"WPILib 2027 has a module {first}, too, which this one hides, or which hides this one."
            report.add(name, 1, what, f"Give this one another name, such as robot_{first}, in your imports, too.")


def _rewrite(file: FileRewriter, project: _Project) -> str:
    calls = Calls(file, project.dashboard_reads, Arguments(file, project.led_lists, project.ports))
    hal_data = HalData(file, project.gamepads)
    leftovers = Leftovers(file)
    sites = file.module.sites
    for own in file.module.classes:
        for method, found in file.overrides(own):
            if method.name.value == "robotInit":
                robot_init.rewrite(file, own, method)
            else:
                file.gone_override(method, found)
        project.unknown.methods(file, own)
    file.rename_stand_ins()
    for node, scope in sites:
        if isinstance(node, cst.Expr):
            calls.statement(node, scope)
    for node, scope in sites:
        if isinstance(node, cst.Comparison):
            calls.comparison(node, scope)
        elif node in project.led_lists:
            rewrite_list(file, node, scope)
    for node, scope in sites:
        if isinstance(node, cst.Call):
            calls.other_pov(node, scope)
            calls.call(node, scope)
            leftovers.call(node, scope)
            project.unknown.call(file, node, scope)
    for node, scope in sites:
        if isinstance(node, cst.Attribute):
            file.attribute(node, scope)
        elif isinstance(node, cst.SimpleString):
            leftovers.text(node)
        elif isinstance(node, cst.Subscript):
            hal_data.subscript(node, scope)
    for node, scope in file.module.annotations:
        rewrite_annotation(file, node, scope)
    for node, scope in sites:
        if isinstance(node, cst.Name):
            file.name(node, scope)
        elif isinstance(node, cst.Attribute):
            project.unknown.attribute(file, node, scope)
    for node, scope in sites:
        if isinstance(node, cst.ImportFrom):
            file.import_from(node, scope)
        if isinstance(node, cst.Import | cst.ImportFrom):
            leftovers.imports(node)
    return new_text(file)


def _module_name(name: str) -> str:
    parts = name.removesuffix(".py").split("/")
    if parts[-1] == "__init__":
        parts = parts[:-1]
    return ".".join(parts)
