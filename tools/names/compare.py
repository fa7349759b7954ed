"""Compare the packages of two seasons, and return what changed as a table.

A name is found again if it is spelled alike without underscores, case and the `k` of constants: in the same class or
in one of its bases, else in the same package. What is found in no such way is gone, unless `corrections.toml` says
what replaces it.

The table, as JSON:

- `modules`: each module of the old season that robot code can import, and where its names are now ("" if mixed)
- `aliases`: second paths of a name
- `names`: each public name by its path. `table.Table` reads the text, which has these parts:
  the new path ("" if it has not changed, "-" if it is gone); for a class `(` its bases `)`; for a function or constant
  `:` and its type; `{old=new}`, the parameters that do not follow the rule; for a class `;` and its members, separated
  by spaces, each a name with the same parts. `=new` is the new name where it does not follow the rule (snake_case),
  `=-` a member that is gone, `=x!` a method that is a property now. A type in brackets is a container of it.
"""

from __future__ import annotations

from collections.abc import Mapping

from pyfrc_core.season.spelling import normalized, snake_case

from .packages import Class, Entry, Function, Packages, Value

_MOVED_PACKAGES = ("wpilib", "wpilib_drivers", "wpimath", "wpiutil", "wpilog")
_HID = "wpilib.GenericHID"
#: Methods of a gamepad that take its Button or Axis only, no numbers.
_OF_ENUMERATIONS = {"button", "axis_less_than", "axis_greater_than", "axis_magnitude_greater_than"}
_COMMAND_HID = "commands2.button.CommandGenericHID"


def compare(old: Packages, new: Packages, moved: Mapping[str, str]) -> dict[str, object]:
    """Return the table.

    :param moved: corrections: old path to new path, or to the new name of a member
    """
    return _Comparison(old, new, moved).table()


class _Comparison:
    def __init__(self, old: Packages, new: Packages, moved: Mapping[str, str]) -> None:
        self._old = old
        self._new = new
        self._moved = moved
        self._by_name: dict[str, list[str]] = {}
        for path in new.entries:
            self._by_name.setdefault(normalized(path.rpartition(".")[2]), []).append(path)

    def table(self) -> dict[str, object]:
        names = {}
        for path, entry in sorted(self._old.entries.items()):
            if ".version." not in path and (text := self._line(path, entry)):
                names[path] = text
        return {
            "modules": {each: self._module(each) for each in self._old.modules if not each.endswith(".version")},
            "aliases": {path: of for path, of in sorted(self._old.aliases.items()) if of in names},
            "names": names,
        }

    def _module(self, module: str) -> str:
        if module in self._new.modules:
            return module
        inside = [path for path in self._old.entries if path.rpartition(".")[0] == module]
        targets = {self._path(path).rpartition(".")[0] for path in inside} - {""}
        parts = module.split(".")
        parents = [".".join(parts[:end]) for end in range(len(parts) - 1, 0, -1)]
        return next((each for each in parents if each in targets), min(targets, default=""))

    def _path(self, path: str) -> str:
        """Return the new path of a class, function or constant of a module; "" if there is none."""
        if path in self._moved:
            return self._moved[path]
        module, _, name = path.rpartition(".")
        if path in self._new.aliases:
            return path
        if isinstance(self._old.entries.get(module), Class):
            return self._nested_path(module, name)
        package = path.split(".")[0]
        fitting = [
            each
            for each in [path, *self._by_name.get(normalized(name), [])]
            if each in self._new.entries
            and not isinstance(self._new.entries.get(each.rpartition(".")[0]), Class)
            and (each.split(".")[0] == package or {package, each.split(".")[0]} <= set(_MOVED_PACKAGES))
            and (each.startswith("wpilib.simulation.") == (module == "wpilib.simulation"))
        ]
        fitting.sort(
            key=lambda each: (
                each != path,
                each.rpartition(".")[0] != module,
                each.split(".")[0] != package,
                each.rpartition(".")[2] != name,
                each.count("."),
            )
        )
        return fitting[0] if fitting else ""

    def _new_entry(self, path: str) -> Entry | None:
        return self._new.entries.get(self._new.aliases.get(path, path))

    def _nested_path(self, outer: str, name: str) -> str:
        target = self._path(outer)
        while target:
            owner = self._new_entry(target)
            if not isinstance(owner, Class):
                return ""
            for each, member in owner.members.items():
                if isinstance(member, Class) and normalized(each) == normalized(name):
                    return f"{target}.{each}"
            target = owner.bases[0] if owner.bases else ""
        return ""

    def _line(self, path: str, entry: Entry) -> str:
        target = self._path(path)
        line = "" if target == path else target or "-"
        if isinstance(entry, Class):
            members = " ".join(self._members(path, target, entry))
            return f"{line}({' '.join(entry.bases)}){_parameters(entry, self._new_entry(target))};{members}"
        if isinstance(entry, Function):
            return f"{line}:{entry.returns}{_parameters(entry, self._new_entry(target))}"
        return f"{line}:{entry.type}" if line or entry.type else ""

    def _members(self, path: str, target: str, entry: Class) -> list[str]:
        found = []
        for name, member in entry.members.items():
            if isinstance(member, Class) or not (_matters(name, member) or f"{path}.{name}" in self._moved):
                continue
            counterpart, new = self._member(path, target, name)
            if isinstance(new, Function) and new.returns.startswith("rev.Signal_"):
                counterpart += "().get"  # REV's signals carry an error and a time; the value is one call away
            if isinstance(member, Function) and isinstance(new, Value):
                counterpart += "!"
            spelling = "" if counterpart == snake_case(name) else f"={counterpart}"
            type_ = member.returns if isinstance(member, Function) else member.type
            extra = _parameters(member, new)
            found.append(f"{name}{spelling}{f':{type_}' if type_ else ''}{extra}")
        return [*found, *self._inherited(path, target, entry)]

    def _inherited(self, path: str, target: str, entry: Class) -> list[str]:
        """Return the members of bases that the new class has not, or has under another name."""
        found = []
        for base, name, member in self._of_bases(entry):
            if name in entry.members or not _matters(name, member) or not target:
                continue
            theirs = self._member(base, self._path(base), name)[0]
            kept = self._in_class(self._new_entry(target), [theirs])[0]
            ours = kept or self._member(path, target, name)[0]
            if kept in _OF_ENUMERATIONS and self._has_hid(target) and "Joystick" not in target:
                ours = f"get_hid().{theirs}"  # which also takes numbers, as in 2026
            if ours != theirs and theirs != "-" and "." not in theirs:
                type_ = member.returns if isinstance(member, Function) else ""
                found.append(f"{name}={ours}{f':{type_}' if type_ else ''}")
        return found

    def _has_hid(self, target: str) -> bool:
        """Return whether a class is a controller, which is no GenericHID any more, but has one."""
        return bool(self._in_class(self._new_entry(target), ["get_hid"])[0])

    def _of_bases(self, entry: Class) -> list[tuple[str, str, Entry]]:
        found: list[tuple[str, str, Entry]] = []
        for base in entry.bases:
            theirs = self._old.entries.get(base)
            if isinstance(theirs, Class):
                found += [(base, name, member) for name, member in theirs.members.items()]
                found += self._of_bases(theirs)
        return list({name: (base, name, member) for base, name, member in reversed(found)}.values())

    def _member(self, path: str, target: str, name: str) -> tuple[str, Entry | None]:
        """Return the member's new name and what it is; "-" if the class and its bases have none."""
        if f"{path}.{name}" in self._moved:
            corrected = self._moved[f"{path}.{name}"]
            return corrected, self._in_class(self._new_entry(target), [corrected])[1]
        owner = self._new_entry(target)
        spellings = [snake_case(name), name]
        found = self._in_class(owner, spellings)
        if not found[0]:
            found = self._in_class(owner, [], normalized(name))
        if not found[0] and self._has_hid(target):
            hid = self._new.entries[_COMMAND_HID if target.startswith("commands2.") else _HID]
            through = self._in_class(hid, spellings, normalized(name))
            if through[0]:
                return f"get_hid().{through[0]}", through[1]
        return found if found[0] else ("-", None)

    def _in_class(self, owner: Entry | None, names: list[str], alike: str = "") -> tuple[str, Entry | None]:
        if not isinstance(owner, Class):
            return "", None
        for name in names:
            if name in owner.members:
                return name, owner.members[name]
        for name, member in owner.members.items():
            if normalized(name) == alike:
                return name, member
        for base in owner.bases:
            found = self._in_class(self._new_entry(base), names, alike)
            if found[0]:
                return found
        return "", None


def _matters(name: str, member: Entry) -> bool:
    if name.startswith("__"):
        return isinstance(member, Function) and bool(member.returns) and name not in ("__repr__", "__str__")
    return not name.startswith("_")


def _parameters(old: Entry, new: Entry | None) -> str:
    """Return the keyword names that do not follow the rule, as `{old=new}`."""
    if isinstance(old, Class) and isinstance(new, Class):
        old, new = old.members.get("__init__", old), new.members.get("__init__", new)
    if not isinstance(old, Function) or not isinstance(new, Function):
        return ""
    changed = []
    for position, name in enumerate(old.parameters):
        if snake_case(name) not in new.parameters:
            same = len(old.parameters) == len(new.parameters)
            changed.append(f"{name}={new.parameters[position] if same else '-'}")
    return "{" + ",".join(changed) + "}" if changed else ""
