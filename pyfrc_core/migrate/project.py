"""Rewrite a project's Python files: read all, find out what everything is, rewrite each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import libcst as cst

from .names.table import Table
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
from .rewrite.ports import Ports
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
    comments: bool = False,
) -> Rewritten:
    """Return what becomes of the files.

    :param home: the directory with robot.py, whose modules import each other, with a `/`; "" for the project's own
    :param first_time: the project is still one of 2026
    :param progress: called with what is done, and how much of it
    :param comments: write what must be changed by hand into the files, too
    """
    modules: dict[str, Module] = {}
    for position, source in enumerate(sources):
        progress("reading", position, len(sources))
        try:
            tree = cst.parse_module(source.text)
            modules[source.name] = Module(source.path, _module_name(source.name.removeprefix(home)), tree)
        except (cst.ParserSyntaxError, UnicodeDecodeError) as error:
            line = getattr(error, "raw_line", 1)
            report.add(source.name, line, "This is no valid Python, so the file stays as it is.", "Correct it first.")
    _report_taken_names(modules, table, report)
    inference = Inference(table, list(modules.values()))
    project = _Project(modules, inference)
    changed = {}
    for position, (name, module) in enumerate(modules.items()):
        progress("rewriting", position, len(modules))
        shared = module.name in project.shared
        file = FileRewriter(module, name, inference, table, report, first_time=first_time, shared=shared)
        new = _rewrite(file, project, comments=comments).encode(module.tree.encoding)
        if new != module.tree.bytes:
            changed[name] = new
    project.ports.report(report)
    progress("rewriting", len(modules), len(modules))
    return Rewritten(changed, project.gamepads)


class _Project:
    """What is known of all files together."""

    def __init__(self, modules: Mapping[str, Module], inference: Inference) -> None:
        table = inference.table
        self.gamepads = gamepads_by_port(modules.values(), inference, table)
        self.camel_names = table.camel_names()
        self.led_lists = led_lists(inference, modules.values())
        self.ports = Ports(table)
        sites = [node for module in modules.values() for node, _ in module.sites]
        self.shared = {binding.path for module in modules.values() for binding in module.scope.bindings.get("*", ())}
        readers = {each for each in table.corrections["dashboard_table"] if not each.startswith("put")}
        reads = {
            key_of(node)
            for node in sites
            if isinstance(node, cst.Call) and isinstance(node.func, cst.Attribute) and node.func.attr.value in readers
        }
        self.dashboard_reads = frozenset(each for each in reads if each is not None)
        names = {each.node.name.value for module in modules.values() for each in module.classes}
        names |= {each.name for module in modules.values() for each in module.functions}
        for module in modules.values():
            names |= {name for each in module.classes for name in each.assigned}
            names |= {name for each in module.classes for name in each.scope.bindings}
        self.own_names = frozenset(names)


def _report_taken_names(modules: Mapping[str, Module], table: Table, report: Report) -> None:
    """Report the project's modules with the name of a new one of WPILib's: only one of the two can be imported."""
    taken = {each.partition(".")[0] for each in (*table.modules.values(), *NEW_MODULES)}
    taken -= {each.partition(".")[0] for each in table.modules}
    for name, module in modules.items():
        first = module.name.partition(".")[0]
        if first in taken:
            taken.remove(first)
            what = f"WPILib 2027 has a module {first}, too, which this one hides, or which hides this one."
            report.add(name, 1, what, f"Give this one another name, such as robot_{first}, in your imports, too.")


def _rewrite(file: FileRewriter, project: _Project, *, comments: bool) -> str:
    calls = Calls(file, project.dashboard_reads, Arguments(file, project.led_lists, project.ports))
    hal_data = HalData(file, project.gamepads)
    leftovers = Leftovers(file, project.own_names, project.camel_names)
    sites = file.module.sites
    for own in file.module.classes:
        for method, found in file.overrides(own):
            if method.name.value == "robotInit":
                robot_init.rewrite(file, own, method)
            else:
                file.gone_override(method, found)
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
            robot_init.super_call(file, node, scope)
            calls.other_pov(node, scope)
            calls.call(node, scope)
            leftovers.call(node, scope)
    for node, scope in sites:
        if isinstance(node, cst.Assign):
            calls.short_name(node, scope)
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
            leftovers.attribute(node, scope)
    for node, scope in sites:
        if isinstance(node, cst.ImportFrom):
            file.import_from(node, scope)
        if isinstance(node, cst.Import | cst.ImportFrom):
            leftovers.imports(node)
    return new_text(file, comments=comments)


def _module_name(name: str) -> str:
    parts = name.removesuffix(".py").split("/")
    if parts[-1] == "__init__":
        parts = parts[:-1]
    return ".".join(parts)
