"""Rewrite one file: names, members, keywords, overridden methods; the imports at the end."""

from __future__ import annotations

import re

import libcst as cst

from ...season.spelling import snake_case
from ..report import Place, Report
from ..types.atoms import OwnModuleRef, Ref
from ..types.scopes import Module, OwnClass, Scope
from .edits import Edit, chain, fill, renamed
from .imports import Imports
from .lookup import Found, Lookup


class FileRewriter:
    """The rewriting of one file.

    :param name: of the file, for the report
    :param first_time: the project is still one of 2026: what means something else under the same name is rewritten
    :param shared: other files import everything from this one
    """

    def __init__(
        self,
        module: Module,
        name: str,
        lookup: Lookup,
        report: Report,
        *,
        first_time: bool,
        shared: bool,
    ) -> None:
        self.module = module
        self.lookup = lookup
        self.table = lookup.table
        self.inference = lookup.inference
        self.first_time = first_time
        self.imports = Imports(module, self.table, shared=shared)
        self.edits: dict[cst.CSTNode, Edit] = {}
        #: Nodes that an edit of the expression around them takes care of.
        self.handled: set[cst.CSTNode] = set()
        #: Imports that are replaced.
        self.replaced: frozenset[cst.CSTNode] = frozenset()
        #: Statements that are left out.
        self.removed: set[cst.BaseSmallStatement] = set()
        self.name_in_report = name
        self.report = report
        self.positions = module.positions
        self.default_line = 1

    def line(self, node: cst.CSTNode) -> int:
        """Return the line of a node; of a string annotation, for nodes inside it."""
        found = self.positions.get(node)
        if isinstance(node, cst.FunctionDef | cst.ClassDef):
            found = self.positions.get(node.name)
        return self.default_line if found is None else found.start.line

    def say(self, node: cst.CSTNode, what: str, remedy: str = "", *, done: bool = False) -> None:
        """Add a remark about a node."""
        self.report.add(self.name_in_report, self.line(node), what, remedy, done=done)

    def edit(self, node: cst.CSTNode, edit: Edit) -> None:
        """Add an edit, after those that the node has."""
        before = self.edits.get(node)
        self.edits[node] = edit if before is None else lambda updated: edit(before(updated))

    def remove(self, statement: cst.Expr) -> None:
        """Leave a statement out."""
        self.edit(statement, lambda updated: cst.Pass(semicolon=updated.semicolon))
        self.removed.add(statement)

    # Attributes

    def attribute(self, node: cst.Attribute, scope: Scope) -> None:
        """Rewrite an attribute."""
        if node in self.handled:
            return
        found = self.lookup.attribute(node, scope)
        if all(each.stays for each in found):
            self._of_own_module(node, scope)
            return
        new = {self.lookup.new_name(each) for each in found}
        if len(new) > 1:
            names = ", ".join(sorted(str(each) for each in new))
            self.say(node, f"{node.attr.value} can be several things here.", f"Their new names: {names}.")
            return
        for each in found:
            self._say_note(node, each.path)
        first, target = found[0], new.pop()
        template, known = self.table.corrections["templates"].get(first.path), self.table.name(first.path)
        is_class = known is not None and known.is_class  # as an annotation, a base, or of isinstance
        if isinstance(template, str) and node not in self.module.called and not is_class:
            self._as_function(node, scope, template)
        elif target is None:
            self._say_gone(node, first)
        elif first.owner:
            is_value = first.member is not None and first.member.is_value
            self._rename_member(node, scope, target, is_value=is_value)
        elif target != first.path or target.rpartition(".")[2] != node.attr.value:
            self._respell(node, scope, first.path, target)

    def _of_own_module(self, node: cst.Attribute, scope: Scope) -> None:
        """Rename what another file of the project has from an import: `base.SubsystemBase`."""
        for owner in self.inference.infer(node.value, scope):
            if isinstance(owner, OwnModuleRef) and owner.module is not None:
                new = self.lookup.name_from(f"{owner.name}.{node.attr.value}")
                if new is not None and new != node.attr.value:
                    self.edit(node, renamed(new))

    def _as_function(self, node: cst.Attribute, scope: Scope, template: str) -> None:
        """Rewrite a method that is not called here, such as `now = RobotController.getFPGATime`."""
        count = len(set(re.findall(r"\{\d\}", template)))
        values = [f"value{number or ''}" for number in range(count)]
        head = " ".join(["lambda", ", ".join(values)]).rstrip()
        code = template.removesuffix("({args})") if "{args}" in template else f"({head}: {template})"
        text = self.imports.fill_in(code, self.consume(node.value, scope), scope)
        self.handled.add(node)
        parts = {str(number): cst.Name(value) for number, value in enumerate(values)}
        self.edit(node, lambda updated: fill(text, {"self": updated.value, **parts}))

    def _say_note(self, node: cst.Attribute | cst.Name, path: str) -> None:
        """Report another meaning; of a class, where it is called."""
        note = self.table.corrections["notes"].get(path)
        known = self.table.name(path)
        if (
            note is None
            or not self.first_time
            or (known is not None and known.is_class and node not in self.module.called)
        ):
            return
        name = node.attr.value if isinstance(node, cst.Attribute) else node.value
        self.say(node, f"{name} has another meaning.", note, done=True)

    def _say_gone(self, node: cst.Attribute, found: Found) -> None:
        receiver = self.table.name(found.receiver)
        if receiver is not None and receiver.new is None:
            return  # said where the object is made
        if found.path in self.table.modules:
            return  # said at the import
        advice = self.table.advice(found.path, f"{found.receiver}.{node.attr.value}", node.attr.value)
        self.say(node, f"{found.path} is gone.", advice)

    def _rename_member(self, node: cst.Attribute, scope: Scope, new: str, *, is_value: bool) -> None:
        if is_value and node not in self.module.called:
            self.edit(node, lambda updated: fill(f"(lambda: {{self}}.{new})", {"self": updated.value}))
        elif new.endswith("().get") and node not in self.module.called:
            self.edit(node, lambda updated: fill(f"(lambda: {{self}}.{new}())", {"self": updated.value}))
        elif "(" in new:
            self.edit(node, lambda updated: fill(f"{{self}}.{new}", {"self": updated.value}))
        elif "." in new:
            self._spell_anew(node, scope, new)
        elif new != node.attr.value:
            self.edit(node, renamed(new))

    def _respell(self, node: cst.Attribute, scope: Scope, old: str, new: str) -> None:
        before = {each.path for each in self.inference.infer(node.value, scope) if isinstance(each, Ref)}
        outer, _, last = new.rpartition(".")
        if before and {self.table.new_path(each) for each in before} == {outer} and old not in self.table.modules:
            if last != node.attr.value:
                self.edit(node, renamed(last))
            return
        self._spell_anew(node, scope, new)

    def _spell_anew(self, node: cst.Attribute, scope: Scope, new: str) -> None:
        spelled = chain(self.imports.spell(new, self.consume(node, scope), scope))
        self.edit(node, lambda updated: spelled.with_changes(lpar=updated.lpar, rpar=updated.rpar))

    # Names

    def consume(self, node: cst.BaseExpression, scope: Scope) -> cst.BaseExpression:
        """Mark what an edit replaces, and return its first name."""
        while isinstance(node, cst.Attribute | cst.Call):
            self.handled.add(node)
            node = node.value if isinstance(node, cst.Attribute) else node.func
        self.handled.add(node)
        if isinstance(node, cst.Name):
            self.imports.count(node.value, scope, self.imports.consumed)
        return node

    def consume_all(self, node: cst.CSTNode, scope: Scope) -> None:
        """Mark an expression that is left out."""
        if isinstance(node, cst.BaseExpression):
            self.consume(node, scope)
        for child in node.children:
            self.consume_all(child, scope)

    def name(self, node: cst.Name, scope: Scope) -> None:
        """Rewrite a name that an import gives."""
        if node in self.handled:
            return
        bindings = scope.find(node.value)
        if bindings and not any(each.kind == "from" for each in bindings):
            return
        refs = [each for each in self.inference.named(node.value, scope) if isinstance(each, Ref)]
        if not refs or refs[0].path in self.table.modules:
            return
        old = refs[0].path
        new = self.table.new_path(old)
        self.imports.count(node.value, scope, self.imports.uses)
        self._say_note(node, old)
        if new is None:
            self.say(node, f"{old} is gone.", self.table.advice(old))
            return
        if not bindings:
            self._from_star(node, scope, old, new)
            return
        names = {self.lookup.name_from(each.path) for each in bindings if each.path.endswith(f".{node.value}")}
        if len(names) == 1 and (name := names.pop()) not in (None, node.value):
            self.edit(node, renamed(str(name)))

    def _from_star(self, node: cst.Name, scope: Scope, old: str, new: str) -> None:
        module, rest = self.imports.split(new)
        for binding in self.module.scope.bindings.get("*", ()):
            self.imports.star_names.setdefault(binding.path, set()).add(new)
            if self.table.modules.get(binding.path) == module or binding.path not in self.table.modules:
                if rest != node.value:
                    self.edit(node, renamed(rest))
                return
        spelled = self.imports.spell(new, node, scope)
        if spelled != node.value:
            self.edit(node, lambda updated: chain(spelled))

    def import_from(self, node: cst.ImportFrom, scope: Scope) -> None:
        """Report what an import names that is gone, and rename what another file of the project renamed."""
        if isinstance(node.names, cst.ImportStar):
            return
        for alias in node.names:
            local = alias.asname.name if alias.asname else alias.name
            if not isinstance(local, cst.Name) or not isinstance(alias.name, cst.Name):
                continue
            for binding in scope.bindings.get(local.value, ()):
                if binding.node is node:
                    self._import_alias(node, alias, binding.path)
                    for ref in self.inference.bound(binding, local.value):
                        if isinstance(ref, Ref) and self.table.new_path(ref.path) is None:
                            self._say_gone_import(node, alias, ref.path)

    def _import_alias(self, node: cst.ImportFrom, alias: cst.ImportAlias, path: str) -> None:
        """Rename what another file of the project renamed, and report what no file defines."""
        module, _, name = path.rpartition(".")
        if module in self.inference.modules:
            new = self.lookup.name_from(path)
            if new is None:
                what = f"{name} is imported in a circle: {module} and what it imports define no {name}."
                self.say(node, what, f"Import {name} from the file that defines it.")
            elif new != name:
                self.edit(alias, renamed(new))

    def _say_gone_import(self, node: cst.ImportFrom, alias: cst.ImportAlias, ref: str) -> None:
        if self.imports.is_unused(alias):
            self.say(node, f"{ref} is gone, and its import, which is not used, is removed.", done=True)
        elif not (self.imports.consumed.get(alias) and not self.imports.uses.get(alias)):
            self.say(node, f"{ref} is gone.", self.table.advice(ref))

    # Classes

    def overrides(self, own: OwnClass) -> list[tuple[cst.FunctionDef, Found]]:
        """Rename the methods that override methods of WPILib's, and return those that override what is gone."""
        gone: list[tuple[cst.FunctionDef, Found]] = []
        theirs = self.inference.family(own)[1]
        if not theirs:
            return gone
        for name, bindings in own.scope.bindings.items():
            methods = [each.node for each in bindings if isinstance(each.node, cst.FunctionDef)]
            found = self.lookup.member_of(theirs, name) if methods else []
            if not found or not found[0].owner:
                self._hidden(own, theirs, name, methods)
                continue
            member = found[0].member
            assert member is not None
            for method in methods:
                if member.new is None:
                    gone.append((method, found[0]))
                elif member.new.isidentifier() and member.new != name:
                    if not self.inference.own_bindings(own, member.new):
                        self.edit(method, renamed(member.new))
                    elif snake_case(name) == member.new:
                        self.say(method, f"{name} is {member.new} now, and {own.name} already has a {member.new}.")
        return gone

    def rename_stand_ins(self) -> None:
        """Rename the team's methods that stand in for WPILib's."""
        for method, new, path in self.lookup.renamed_methods(self.module):
            self.edit(method, renamed(new))
            self.say(method, f"{method.name.value} is {new} now, since it stands in for {path}.", done=True)

    def changed_places(self) -> set[Place]:
        """Return the lines that the edits are in."""
        nodes = self.edits.keys() | self.replaced
        return {Place(self.name_in_report, self.line(node)) for node in nodes if node in self.positions}

    def gone_override(self, method: cst.FunctionDef, found: Found) -> None:
        """Report an override of a method that is gone."""
        name = method.name.value
        self.say(method, f"{name} is not called any more.", self.table.advice(found.path, name))

    def _hidden(self, own: OwnClass, theirs: list[str], name: str, methods: list[cst.FunctionDef]) -> None:
        if not methods or name.startswith("_") or not self.first_time:
            return
        for path in theirs:
            for each in self.table.ancestors(path):
                known = self.table.name(each)
                members = known.members.values() if known is not None else ()
                new = {each.new for each in members if each.new == snake_case(each.name) != each.name}
                if name in new or name in self.table.corrections["new_members"].get(each, ()):
                    self.say(methods[0], f"{own.name}.{name} overrides a method of WPILib 2027.", "Rename it.")
                    return
