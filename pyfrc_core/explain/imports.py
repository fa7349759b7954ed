"""Imports that fail: a package that is not installed, a circle, another case, a module of an earlier season."""

from __future__ import annotations

import linecache
import pkgutil
import re
import sys
from collections.abc import Iterable
from difflib import get_close_matches
from importlib.util import find_spec
from pathlib import Path

from ..config.packages import PACKAGES, SUCCESSORS, how_to_install
from ..errors import nearest
from ..project.hidden_libraries import LIBRARIES
from ..project.robot_files import RobotFiles
from .explanation import Explanation
from .other_season import in_2027
from .places import frames_of, imported_name, users_frame

_REMOVE_IMPORT = (
    "Move what both need into a third file. If the name is for a type annotation only: write from __future__ import "
    "annotations as the first line, and this import under if TYPE_CHECKING:"
)


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    if isinstance(error, (ImportError, AttributeError)) and (circle := _circle(error, files)):
        return circle
    if isinstance(error, ModuleNotFoundError) and error.name:
        return _missing(error.name, Path(files.root))
    if isinstance(error, ImportError) and "relative import" in str(error):
        return _relative(error, files)
    if isinstance(error, NameError) and error.name in {*LIBRARIES, *sys.stdlib_module_names} - {"this"}:  # Java's self
        return Explanation(remedy=f"Is this line missing at the top: import {error.name}")
    return None


def _circle(error: ImportError | AttributeError, files: RobotFiles) -> Explanation | None:
    """Return an explanation if a file imports another one that is itself being imported."""
    if isinstance(error, AttributeError):
        name, file = error.name, getattr(error.obj, "__file__", None)
    else:
        name, file = imported_name(error), error.path
    importing = [frame.f_code.co_filename for frame in frames_of(error) if frame.f_code.co_name == "<module>"]
    importing = [each for each in importing if files.is_project_file(each)]
    if not name or file not in importing or importing[-1] == file:
        return None
    one, other = files.relative(file), files.relative(importing[-1])
    between = [files.relative(each) for each in importing[importing.index(file) + 1 : -1]]
    way = f" (by way of {', '.join(between)})" if between else ""
    return Explanation(
        f"a circle of imports: {other} imports {one}, which is importing {other}{way} and does not have {name} yet",
        _REMOVE_IMPORT,
    )


def _relative(error: ImportError, files: RobotFiles) -> Explanation | None:
    """Explain ``from .arm import Arm`` in a file that is in no package, such as robot.py."""
    where = users_frame(error, files)
    if where is None:
        return None
    line = linecache.getline(where[0].f_code.co_filename, where[1]).strip()
    found = re.match(r"from (\.+)(\w*(?:\.\w+)*) ?(import .*)", line)
    text = f"a dot before a module's name means: of the same package, and this file is in none\n    {line}"
    if found is None:
        return Explanation(text, "Write the module's name without the dot.")
    return Explanation(text, f"Write: {f'from {found[2]} ' if found[2] else ''}{found[3]}")


def _missing(module: str, root: Path) -> Explanation:
    text = f"there is no module {module}"
    if meant := _in_other_case(module, root):
        return Explanation(text, f"Upper and lower case matter: write {meant}, as the file or folder is called.")
    top = module.partition(".")[0]
    for each in (module, top):
        if each in SUCCESSORS:
            return Explanation(text, _use_instead(in_2027(SUCCESSORS[each]), root))
    parent, _, last = module.rpartition(".")
    beside = _modules_in(getattr(sys.modules.get(parent), "__path__", None) or ([str(root)] if not parent else []))
    if isinstance(getattr(sys.modules.get(parent), last, None), type):
        return Explanation(f"{last} is a class of {parent}, and no module", f"Write: from {parent} import {last}")
    if parent and beside:
        return Explanation(text, f"In {parent}: {nearest(last, beside)}")
    if (elsewhere := next(root.glob(f"*/{module}.py"), None)) is not None and elsewhere.parent.name != "tests":
        name = f"{elsewhere.parent.name}.{module}"
        return Explanation(text, f"It is in {elsewhere.parent.name}/: write from {name} import ..., or import {name}")
    if _in_requirements({top, PACKAGES.get(top, top)}, root / "requirements.txt"):
        return Explanation(text, "Install what requirements.txt names: python -m pip install -r requirements.txt")
    if top in PACKAGES:
        return Explanation(text, how_to_install(PACKAGES[top], root / "pyproject.toml"))
    if close := get_close_matches(top, [*beside, *PACKAGES, *LIBRARIES, *sys.stdlib_module_names], n=1, cutoff=0.75):
        return Explanation(text, f"Did you mean {close[0]}?")
    return Explanation(
        text, "Is the name right? A file of yours must be in the robot's directory; a package must be installed."
    )


def _in_requirements(names: set[str], file: Path) -> bool:
    """Return whether requirements.txt has one of these packages."""
    try:
        words = re.findall(r"^[\w.-]+", file.read_text("utf-8", "replace").lower(), re.MULTILINE)
    except OSError:
        return False
    # To pip, simple-pid and simple_pid are one name.
    return not {each.lower().replace("_", "-") for each in names}.isdisjoint(each.replace("_", "-") for each in words)


def _use_instead(successor: str, root: Path) -> str:
    modules = [each for each in PACKAGES if each in re.findall(r"\w+", successor)]
    wanted = [PACKAGES[each] for each in modules if find_spec(each) is None]
    return "\n  ".join([f"Instead: {successor}", *(how_to_install(each, root / "pyproject.toml") for each in wanted)])


def _in_other_case(module: str, root: Path) -> str:
    """Return the module's name as the project's files are called, if they differ in case only."""
    found, directory = [], root
    for part in module.split("."):
        known = _modules_in([str(directory)])
        same = next((each for each in known if each.lower() == part.lower()), None)
        if same is None:
            return ""
        found.append(same)
        directory /= same
    name = ".".join(found)
    return name if name != module else ""


def _modules_in(directories: Iterable[str]) -> list[str]:
    """Return the modules and packages in directories, and directories with sources, which are packages, too."""
    found = [each.name for each in pkgutil.iter_modules(list(directories))]
    for directory in directories:
        try:
            entries = [entry for entry in Path(directory).iterdir() if entry.is_dir() and entry.name.isidentifier()]
        except OSError:
            continue
        found += [entry.name for entry in entries if entry.name not in found and any(entry.glob("*.py"))]
    return found
