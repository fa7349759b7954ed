"""Read the public names of WPILib's packages from their stubs and modules, without importing them.

A compiled module has a stub (`.pyi`) beside it; commands2 and magicbot are read as they are. The result is a flat
dictionary: each module, class, function and constant by its shortest public path.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

#: The packages whose names robot code uses; a season has some of them.
PACKAGES = (
    "wpilib",
    "wpimath",
    "wpiutil",
    "hal",
    "ntcore",
    "commands2",
    "magicbot",
    "robotpy_ext",
    "robotpy_apriltag",
    "robotpy_fields",
    "wpilib_drivers",
    "telemetry",
    "tunables",
    "wpilog",
    "romi",
    "xrp",
    "cscore",
    "rev",
    "phoenix6",
)

#: Modules of vendors whose names are the same in both seasons.
_UNCHANGED = tuple(
    f"phoenix6.{module}"
    for module in ("configs", "controls", "mechanisms", "phoenix_native", "signals", "sim", "spns", "units", "wpiutils")
)

_CONTAINERS = {"list", "List", "tuple", "Tuple", "Sequence", "Iterable", "set", "Annotated", "Optional", "Union"}


@dataclass
class Function:
    """A function or method: the names of its parameters (of all overloads), and what it returns."""

    parameters: list[str] = field(default_factory=list)
    returns: str = ""


@dataclass
class Class:
    """A class: the paths of its bases, its members by name."""

    bases: list[str] = field(default_factory=list)
    members: dict[str, Function | Class | Value] = field(default_factory=dict)


@dataclass
class Value:
    """A constant, attribute or property, and the path of its type."""

    type: str = ""


Entry = Function | Class | Value

_Definition = tuple[str, ast.AST]


@dataclass(frozen=True)
class _Imported:
    """A name that is imported from another module."""

    module: str
    name: str


class Packages:
    """The packages in some site-packages directories.

    :param sites: the directories
    """

    def __init__(self, *sites: Path) -> None:
        self._sites = sites
        self._trees: dict[str, ast.Module | None] = {}
        self._names: dict[str, dict[str, _Definition | _Imported | str]] = {}
        self._public: dict[str, str] = {}
        self.modules: list[str] = []
        #: Each class (nested ones too), function and value of a module by its public path.
        self.entries: dict[str, Entry] = {}
        #: Public paths that are a second name of another one.
        self.aliases: dict[str, str] = {}

    def read(self) -> None:
        """Read all packages."""
        self.modules = sorted(self._public_modules(), key=lambda name: (name.count("."), name))
        # A name belongs to the package that defines it; where another one imports it, that is a second path.
        for at_home in (True, False):
            for module in self.modules:
                self._name_all(module, at_home=at_home)
        for module in self.modules:
            for name, found in self._namespace(module).items():
                public = f"{module}.{name}"
                if name.startswith("_") or isinstance(found, str) or public in self.aliases:
                    continue
                origin, node = found
                if self._public.get(f"{origin}.{_name_of(node)}") == public:
                    self._add_entry(public, self._entry(node, origin, ""))

    def _add_entry(self, path: str, entry: Entry) -> None:
        self.entries[path] = entry
        if isinstance(entry, Class):
            for name, member in entry.members.items():
                if isinstance(member, Class):
                    self._add_entry(f"{path}.{name}", member)

    def _name_all(self, module: str, *, at_home: bool) -> None:
        for name, found in self._namespace(module).items():
            if name.startswith("_") or isinstance(found, str):
                continue
            origin, node = found
            if (origin.split(".")[0] == module.split(".")[0]) != at_home or origin.startswith(_UNCHANGED):
                continue
            private, public = f"{origin}.{_name_of(node)}", f"{module}.{name}"
            if private in self._public:
                if self._public[private] != public:
                    self.aliases[public] = self._public[private]
                continue
            self._public[private] = public
            if isinstance(node, ast.ClassDef):
                self._name_nested(node, private, public)

    def _public_modules(self) -> list[str]:
        found = []
        for package in PACKAGES:
            root = self._home(package)
            files = [*root.rglob("*.py"), *root.rglob("*.pyi")]
            for file in files:
                parts = file.relative_to(root.parent).with_suffix("").parts
                if parts[-1] == "__init__":
                    parts = parts[:-1]
                module = ".".join(parts)
                hidden = any(part.startswith("_") or part in ("testing", "src", "tests") for part in parts)
                if not hidden and not module.startswith(_UNCHANGED):
                    found.append(module)
        return list(dict.fromkeys(found))

    def _home(self, module: str) -> Path:
        """Return where a module is, without its suffix."""
        parts = module.split(".")
        site = next((each for each in self._sites if (each / parts[0]).is_dir()), self._sites[0])
        return site.joinpath(*parts)

    def _tree(self, module: str) -> ast.Module | None:
        if module not in self._trees:
            base = self._home(module)
            files = [base / "__init__.py", base / "__init__.pyi", base.with_suffix(".pyi"), base.with_suffix(".py")]
            file = next((each for each in files if each.is_file()), None)
            self._trees[module] = None if file is None else ast.parse(file.read_text(encoding="utf-8"))
        return self._trees[module]

    def _namespace(self, module: str) -> dict[str, _Definition | str]:
        """Return a module's names: what defines each, with the module where that is, or the path of a module."""
        found = {name: self._lookup(module, name) for name in self._bound(module)}
        return {name: each for name, each in found.items() if each is not None}

    def _lookup(self, module: str, name: str) -> _Definition | str | None:
        """Follow a name through the modules that import it."""
        for _ in range(20):
            bound = self._bound(module).get(name)
            if not isinstance(bound, _Imported):
                return bound
            if bound.name in self._bound(bound.module):
                module, name = bound.module, bound.name
            else:
                path = f"{bound.module}.{bound.name}"
                return path if self._tree(path) is not None else None
        return None

    def _bound(self, module: str) -> dict[str, _Definition | _Imported | str]:
        if module in self._names:
            return self._names[module]
        names: dict[str, _Definition | _Imported | str] = {}
        self._names[module] = names
        tree = self._tree(module)
        for statement in _statements([] if tree is None else tree.body):
            if isinstance(statement, ast.ClassDef | ast.FunctionDef | ast.AnnAssign | ast.Assign):
                if name := _name_of(statement):
                    names.setdefault(name, (module, statement))
            elif isinstance(statement, ast.Import):
                for alias in statement.names:
                    top = alias.name.split(".")[0]
                    names.setdefault(alias.asname or top, alias.name if alias.asname else top)
            elif isinstance(statement, ast.ImportFrom):
                self._import_from(module, statement, names)
        return names

    def _import_from(
        self, module: str, statement: ast.ImportFrom, names: dict[str, _Definition | _Imported | str]
    ) -> None:
        source = statement.module or ""
        if statement.level:
            package = module.split(".")
            is_package = self._home(module).is_dir()
            cut = statement.level - (1 if is_package else 0)
            package = package[: len(package) - cut] if cut else package
            source = ".".join([*package, *([source] if source else [])])
        if source.split(".")[0] not in PACKAGES:
            return
        for alias in statement.names:
            if alias.name == "*":
                for name in self._bound(source):
                    if not name.startswith("_"):
                        names.setdefault(name, _Imported(source, name))
            else:
                names.setdefault(alias.asname or alias.name, _Imported(source, alias.name))

    def _name_nested(self, node: ast.ClassDef, private: str, public: str) -> None:
        for inner in node.body:
            if isinstance(inner, ast.ClassDef):
                self._public.setdefault(f"{private}.{inner.name}", f"{public}.{inner.name}")
                self._name_nested(inner, f"{private}.{inner.name}", f"{public}.{inner.name}")

    def _entry(self, node: ast.AST, module: str, within: str) -> Entry:
        if isinstance(node, ast.ClassDef):
            inside = f"{within}{node.name}."
            found = Class([each for base in node.bases if (each := self._type(base, module, within))])
            for member in _statements(node.body):
                if isinstance(member, ast.FunctionDef):
                    self._add_function(found, member, module, inside)
                    if member.name == "__init__":
                        self._add_attributes(found, member, module, inside)
                elif isinstance(member, ast.ClassDef):
                    found.members[member.name] = self._entry(member, module, inside)
                elif isinstance(member, ast.AnnAssign) and isinstance(member.target, ast.Name):
                    found.members.setdefault(member.target.id, Value(self._type(member.annotation, module, inside)))
                elif isinstance(member, ast.Assign) and isinstance(member.targets[0], ast.Name):
                    found.members.setdefault(member.targets[0].id, Value(self._assigned(member.value, module, inside)))
            return found
        if isinstance(node, ast.FunctionDef):
            return Function(_parameters(node), self._type(node.returns, module, within))
        if isinstance(node, ast.AnnAssign):
            return Value(self._type(node.annotation, module, within))
        return Value()

    def _add_attributes(self, owner: Class, constructor: ast.FunctionDef, module: str, within: str) -> None:
        """Add the public attributes that a constructor assigns."""
        for each in ast.walk(constructor):
            if not isinstance(each, ast.Assign | ast.AnnAssign):
                continue
            target = each.target if isinstance(each, ast.AnnAssign) else each.targets[0]
            if not isinstance(target, ast.Attribute) or ast.unparse(target.value) != "self":
                continue
            if target.attr.startswith("_"):
                continue
            if isinstance(each, ast.AnnAssign):
                type_ = self._type(each.annotation, module, within)
            else:
                type_ = self._assigned(each.value, module, within)
            owner.members.setdefault(target.attr, Value(type_))

    def _assigned(self, value: ast.expr, module: str, within: str) -> str:
        return self._type(value.func, module, within) if isinstance(value, ast.Call) else ""

    def _add_function(self, owner: Class, node: ast.FunctionDef, module: str, within: str) -> None:
        decorators = {ast.unparse(each) for each in node.decorator_list}
        if any(each == "property" or each.endswith(".setter") for each in decorators):
            owner.members.setdefault(node.name, Value(self._type(node.returns, module, within)))
            return
        found = owner.members.setdefault(node.name, Function())
        if isinstance(found, Function):
            found.parameters += [each for each in _parameters(node) if each not in found.parameters]
            found.returns = found.returns or self._type(node.returns, module, within)

    def _type(self, node: ast.expr | None, module: str, within: str) -> str:
        """Return the public path of the class that an annotation names; `[path]` for a container of it."""
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            try:
                node = ast.parse(node.value, mode="eval").body
            except SyntaxError:
                return ""
        if isinstance(node, ast.BinOp):
            return self._type(node.left, module, within) or self._type(node.right, module, within)
        if isinstance(node, ast.Subscript):
            outer = ast.unparse(node.value).split(".")[-1]
            inner = [node.slice] if not isinstance(node.slice, ast.Tuple) else list(node.slice.elts)
            if outer in _CONTAINERS | {"ClassVar", "Final", "Type"}:
                found = next((each for item in inner if (each := self._type(item, module, within))), "")
                single = outer in ("Annotated", "Optional", "Union", "ClassVar", "Final")
                return found if single or not found else f"[{found}]"
            return self._type(node.value, module, within)
        if not isinstance(node, ast.Name | ast.Attribute):
            return ""
        path = ast.unparse(node)
        if path.split(".")[-1] in ("Self", "SelfType"):
            return "self"
        found = self._resolve(path, module, within)
        return "" if found.startswith("wpimath.units.") else found

    def _resolve(self, path: str, module: str, within: str) -> str:
        head, _, rest = path.partition(".")
        outer = within
        while True:
            if f"{module}.{outer}{path}" in self._public:
                return self._public[f"{module}.{outer}{path}"]
            if not outer:
                break
            outer = ".".join(outer.rstrip(".").split(".")[:-1])
            outer = outer + "." if outer else ""
        found = self._lookup(module, head)
        if isinstance(found, tuple):
            private = f"{found[0]}.{_name_of(found[1])}" + (f".{rest}" if rest else "")
            return self._public.get(private, "")
        if isinstance(found, str) and head == path.split(".")[0]:
            path = found + (f".{rest}" if rest else "")
        if path in self._public:
            return self._public[path]
        if path in self.aliases:
            return self.aliases[path]
        # A stub names what it means by the module where the class is defined, or where it is exported.
        owner, _, name = path.rpartition(".")
        while owner:
            theirs = self._lookup(owner, name.split(".")[0]) if self._tree(owner) is not None else None
            if isinstance(theirs, tuple):
                tail = name.partition(".")[2]
                return self._public.get(f"{theirs[0]}.{_name_of(theirs[1])}" + (f".{tail}" if tail else ""), "")
            owner, _, last = owner.rpartition(".")
            name = f"{last}.{name}"
        return path if path in self.entries else ""


def _statements(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Return the statements of a block, and those of its conditions where they are true."""
    for each in body:
        if isinstance(each, ast.Try | ast.If):
            yield from _statements(each.body)
        else:
            yield each


def _name_of(node: ast.AST) -> str:
    if isinstance(node, ast.ClassDef | ast.FunctionDef):
        return node.name
    target = (
        node.target if isinstance(node, ast.AnnAssign) else node.targets[0] if isinstance(node, ast.Assign) else None
    )
    return target.id if isinstance(target, ast.Name) else ""


def _parameters(node: ast.FunctionDef) -> list[str]:
    every = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    return [each.arg for each in every if each.arg not in ("self", "cls") and not each.arg.startswith("arg0")]
