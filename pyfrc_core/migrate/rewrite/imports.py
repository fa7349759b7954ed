"""Rewrite a file's imports, and spell new names as the file imports them."""

from __future__ import annotations

import re
from collections.abc import Iterable

import libcst as cst

from ...season.names.table import Table
from ..types.scopes import Module, Scope, dotted, import_source
from .edits import chain

#: The modules of 2027 that names of 2026 are in.
NEW_MODULES = ("telemetry", "tunables", "wpilib_drivers", "wpilog", "ntcore", "wpilib", "wpimath", "wpiutil", "hal")


class Imports:
    """The imports of a file as they will be.

    :param shared: other files import everything from this one (`from x import *`)
    """

    def __init__(self, module: Module, table: Table, *, shared: bool) -> None:
        self._module = module
        self._table = table
        self._shared = shared
        self._packages = {name.partition(".")[0] for name in table.modules}
        self._new_modules = sorted({*table.modules.values(), *NEW_MODULES} - {""}, key=len, reverse=True)
        self._wanted_names: dict[str, set[str]] = {}
        self._wanted_modules: dict[str, str] = {}
        #: How often each name of a `from` import is still used as it is, by alias.
        self.uses: dict[cst.ImportAlias, int] = {}
        self.consumed: dict[cst.ImportAlias, int] = {}
        #: Names that a star import gave, by its statement, with their new paths.
        self.star_names: dict[str, set[str]] = {}
        #: Statements to add where no import is to put them after.
        self.at_top: list[cst.BaseSmallStatement] = []
        self._top = [
            statement
            for line in module.tree.body
            if isinstance(line, cst.SimpleStatementLine)
            for statement in line.body
            if isinstance(statement, cst.Import | cst.ImportFrom)
        ]
        self._commented = {
            statement
            for line in module.tree.body
            if isinstance(line, cst.SimpleStatementLine) and any(each.comment for each in line.leading_lines)
            for statement in line.body
        }
        self._beside_others = {
            statement
            for line in module.tree.body
            if isinstance(line, cst.SimpleStatementLine) and (len(line.body) > 1 or line.trailing_whitespace.comment)
            for statement in line.body
        }
        texts = " ".join(
            node.value for node, _ in [*module.sites, *module.annotations] if isinstance(node, cst.SimpleString)
        )
        self._said = {node.value for node, _ in module.sites if isinstance(node, cst.Name)} | set(
            re.findall(r"\w+", texts)
        )
        self._bound = {name for scope in _scopes(module) for name in scope.bindings}

    # Spelling

    def split(self, path: str) -> tuple[str, str]:
        """Return a new path as its module and the rest."""
        module = next((each for each in self._new_modules if path == each or path.startswith(each + ".")), "")
        return module, path[len(module) + 1 :]

    def spell(self, path: str, root: cst.BaseExpression | None, scope: Scope) -> str:
        """Return how this file says a new path, and import what that needs.

        :param root: the first name of what was there before; a name that was imported by `from` is again
        """
        module, rest = self.split(path)
        if not rest:
            return self._module_name(module)
        first = rest.partition(".")[0]
        # A function is called by its module's name: `telemetry.log` says more than `log`.
        if self._is_from(root, scope) and first[0].isupper():
            if self._gives(first, f"{module}.{first}", scope):
                self.count(first, scope, self.uses)
                return rest
            if first not in self._bound:
                self._wanted_names.setdefault(module, set()).add(first)
                return rest
        return f"{self._module_name(module)}.{rest}"

    def fill_in(self, text: str, root: cst.BaseExpression | None, scope: Scope) -> str:
        """Return a text with each `<path>` as this file says it."""
        parts = text.replace("<", "\0").replace(">", "\0").split("\0")
        return "".join(self.spell(part, root, scope) if position % 2 else part for position, part in enumerate(parts))

    def is_unused(self, alias: cst.ImportAlias) -> bool:
        """Return whether this file says nothing of a name that it imports, and no other file gets it from here."""
        name = alias.asname.name if alias.asname else alias.name
        return not self._shared and isinstance(name, cst.Name) and name.value not in self._said

    def _is_from(self, root: cst.BaseExpression | None, scope: Scope) -> bool:
        if not isinstance(root, cst.Name):
            return False
        bindings = scope.find(root.value)
        if not bindings:  # a star import gives it
            return "*" in self._module.scope.bindings
        return any(each.kind == "from" and each.path not in self._table.modules for each in bindings)

    def count(self, name: str, scope: Scope, counts: dict[cst.ImportAlias, int]) -> None:
        """Count a use of a name that a `from` import gives."""
        for binding in scope.find(name):
            statement = binding.node
            if not isinstance(statement, cst.ImportFrom) or isinstance(statement.names, cst.ImportStar):
                continue
            for alias in statement.names:
                local = alias.asname.name if alias.asname else alias.name
                if isinstance(local, cst.Name) and local.value == name:
                    counts[alias] = counts.get(alias, 0) + 1

    def _gives(self, name: str, path: str, scope: Scope) -> bool:
        """Return whether the name already is an import of the path."""
        return any(each.kind == "from" and self._table.new_path(each.path) == path for each in scope.find(name))

    def _module_name(self, module: str) -> str:
        top = module.partition(".")[0]
        for name, bindings in self._module.scope.bindings.items():
            for each in bindings:
                if (
                    each.kind == "import"
                    and self._table.new_path(each.path) == module
                    and (name != top or name == module)
                ):
                    return name
                if (
                    each.kind == "from"
                    and each.path in self._table.modules
                    and self._table.new_path(each.path) == module
                ):
                    return name
        mine = self._module.scope.bindings.get(top, ())
        if any(each.kind == "import" and each.path == top for each in mine):
            if module != top and not self._imports(module):
                self._wanted_modules.setdefault(module, module)
            return module
        name = module if top not in self._bound else f"wpilib_{module.replace('.', '_')}"
        return self._wanted_modules.setdefault(module, name)

    def _imports(self, module: str) -> bool:
        return any(
            self._table.new_path(dotted(alias.name)) == module
            for statement in self._top
            if isinstance(statement, cst.Import)
            for alias in statement.names
            if alias.asname is None
        )

    # Statements

    def plan(self) -> dict[cst.CSTNode, list[cst.BaseSmallStatement]]:
        """Return what replaces each import statement that changes."""
        found: dict[cst.CSTNode, list[cst.BaseSmallStatement]] = {}
        seen: set[tuple[str, str]] = set()
        for node, _ in self._module.sites:
            new: list[cst.BaseSmallStatement] | None = None
            if isinstance(node, cst.Import):
                new = self._import(node, seen)
            elif isinstance(node, cst.ImportFrom):
                new = self._import_from(node)
            if new is not None and (len(new) != 1 or new[0] is not node):
                found[node] = new
        self._add_wanted(found)
        self._merge(found)
        return found

    def _merge(self, found: dict[cst.CSTNode, list[cst.BaseSmallStatement]]) -> None:
        """Join imports from modules that are one now, where they stand on lines of their own without comments."""
        first: dict[str, tuple[cst.BaseSmallStatement, int]] = {}
        rewritten = set(found)
        for top in self._top:
            if top in self._commented or top in self._beside_others:
                continue
            kept: list[cst.BaseSmallStatement] = []
            for each in found.get(top, [top]):
                module = dotted(each.module) if isinstance(each, cst.ImportFrom) and _is_plain(each) else ""
                if module in first and top in rewritten:
                    home, index = first[module]
                    others = kept if home is top else found.setdefault(home, [home])
                    others[index] = _joined(others[index], each)
                    continue
                if module:
                    first.setdefault(module, (top, len(kept)))
                kept.append(each)
            if kept != [top]:
                found[top] = kept

    def _import(self, node: cst.Import, seen: set[tuple[str, str]]) -> list[cst.BaseSmallStatement]:
        aliases, changed = [], False
        for alias in node.names:
            old = dotted(alias.name)
            new = self._new_module(old)
            key = (new, dotted(alias.asname.name) if alias.asname and isinstance(alias.asname.name, cst.Name) else "")
            if node in self._top:
                if key in seen and old.split(".")[0] in self._packages and node not in self._commented:
                    changed = True
                    continue
                seen.add(key)
            if new != old:
                changed = True
                alias = alias.with_changes(name=chain(new))
            aliases.append(alias)
        if not changed:
            return [node]
        if not aliases:
            return [] if node in self._top else [cst.Pass()]
        return [node.with_changes(names=_without_last_comma(aliases))]

    def _new_module(self, old: str) -> str:
        if old not in self._table.modules:
            return old
        return self._table.modules[old] or old.partition(".")[0]

    def _import_from(self, node: cst.ImportFrom) -> list[cst.BaseSmallStatement]:
        source = import_source(node, self._module)
        if node.relative or source not in self._table.modules:
            return [node]
        if isinstance(node.names, cst.ImportStar):
            return self._import_star(node, source)
        kept: dict[str, list[cst.ImportAlias]] = {}
        modules: list[cst.BaseSmallStatement] = []
        changed = source != dotted(node.module)
        for alias in node.names:
            name = dotted(alias.name)
            path = f"{source}.{name}"
            if path in self._table.modules:
                new_module = self._new_module(path)
                if new_module != path:
                    changed = True
                    local = alias.asname.name if alias.asname else cst.Name(name)
                    modules.append(_import_module(new_module, local))
                else:
                    kept.setdefault(source, []).append(alias)
                continue
            if self.consumed.get(alias) and not self.uses.get(alias):
                changed = True
                continue
            new = self._table.new_path(self._table.canonical(path))
            if new is None and self.is_unused(alias):
                changed = True
                continue
            if new is None:
                kept.setdefault(source, []).append(alias)
                continue
            module, last = self._place(path, source, new)
            if last != name:
                changed = True
                alias = alias.with_changes(name=cst.Name(last))
            kept.setdefault(module, []).append(alias)
        if not changed and list(kept) == [source]:
            return [node]
        statements: list[cst.BaseSmallStatement] = []
        for module, aliases in kept.items():
            single = len(kept) == 1 and len(aliases) == len(list(node.names))
            names = aliases if single else _without_last_comma(aliases)
            parentheses = {} if single or len(kept) == 1 else {"lpar": None, "rpar": None}
            if not single and node.lpar is not None and len(kept) > 1:
                names = [each.with_changes(comma=cst.MaybeSentinel.DEFAULT) for each in names]
            statements.append(node.with_changes(module=chain(module), names=names, **parentheses))
        statements += modules
        return statements if statements or node in self._top else [cst.Pass()]

    def _place(self, path: str, source: str, new: str) -> tuple[str, str]:
        """Return the module to import a name from: the same one where that still has it."""
        canonical = self._table.canonical(path)
        module, last = self.split(new)
        if canonical != path and new == canonical and self._table.modules.get(source) == source:
            return source, last
        return module, last.partition(".")[0]

    def _import_star(self, node: cst.ImportFrom, source: str) -> list[cst.BaseSmallStatement]:
        new = self._new_module(source)
        if new == source:
            return [node]
        names = {path.rpartition(".")[2] for path in self.star_names.get(source, ()) if self.split(path)[0] == new}
        if self._shared or not names:
            return [node.with_changes(module=chain(new))]
        return [_import_names(new, names)]

    def _add_wanted(self, found: dict[cst.CSTNode, list[cst.BaseSmallStatement]]) -> None:
        wanted: list[cst.BaseSmallStatement] = []
        for module, name in sorted(self._wanted_modules.items()):
            local = cst.Name(name) if name != module else None
            wanted.append(_import_module(module, local))
        for module, names in sorted(self._wanted_names.items()):
            if not self._extend(found, module, names):
                wanted.append(_import_names(module, names))
        if not wanted:
            return
        ours = [each for each in self._top if self._is_ours(each)]
        anchor = next(iter(ours), None)
        if anchor is None:
            self.at_top = wanted
        else:
            found[anchor] = [*found.get(anchor, [anchor]), *wanted]

    def _extend(self, found: dict[cst.CSTNode, list[cst.BaseSmallStatement]], module: str, names: set[str]) -> bool:
        """Add names to an import of the same module, if there is one."""
        for top in self._top:
            statements = found.get(top, [top])
            for index, each in enumerate(statements):
                if isinstance(each, cst.ImportFrom) and dotted(each.module) == module and not each.relative:
                    if isinstance(each.names, cst.ImportStar):
                        continue
                    there = {dotted(alias.name): alias for alias in each.names}
                    new = {name: cst.ImportAlias(cst.Name(name)) for name in names}
                    aliases = [alias for _, alias in sorted({**new, **there}.items())]
                    aliases = [alias.with_changes(comma=cst.MaybeSentinel.DEFAULT) for alias in aliases]
                    found[top] = [*statements[:index], each.with_changes(names=aliases), *statements[index + 1 :]]
                    return True
        return False

    def _is_ours(self, node: cst.Import | cst.ImportFrom) -> bool:
        if isinstance(node, cst.ImportFrom):
            return not node.relative and import_source(node, self._module) in self._table.modules
        return any(dotted(alias.name) in self._table.modules for alias in node.names)


def _import_module(module: str, local: cst.BaseExpression | None) -> cst.Import:
    plain = local is None or (isinstance(local, cst.Name) and local.value == module)
    asname = None if plain or not isinstance(local, cst.Name) else cst.AsName(local)
    return cst.Import([cst.ImportAlias(chain(module), asname)])


def _import_names(module: str, names: Iterable[str]) -> cst.ImportFrom:
    return cst.ImportFrom(chain(module), [cst.ImportAlias(cst.Name(each)) for each in sorted(names)])


def _is_plain(node: cst.ImportFrom) -> bool:
    """Return whether an import is a plain list of names on one line."""
    return not (isinstance(node.names, cst.ImportStar) or node.relative or node.lpar is not None)


def _joined(one: cst.BaseSmallStatement, other: cst.BaseSmallStatement) -> cst.BaseSmallStatement:
    names: dict[str, cst.ImportAlias] = {}
    for each in (one, other):
        assert isinstance(each, cst.ImportFrom)
        assert not isinstance(each.names, cst.ImportStar)
        names |= {cst.Module([]).code_for_node(alias).rstrip(", "): alias for alias in each.names}
    aliases = [alias.with_changes(comma=cst.MaybeSentinel.DEFAULT) for _, alias in sorted(names.items())]
    return one.with_changes(names=aliases)


def _without_last_comma(aliases: list[cst.ImportAlias]) -> list[cst.ImportAlias]:
    return [*aliases[:-1], aliases[-1].with_changes(comma=cst.MaybeSentinel.DEFAULT)]


def _scopes(module: Module) -> list[Scope]:
    return [module.scope, *(each.scope for each in module.functions), *(each.scope for each in module.classes)]
