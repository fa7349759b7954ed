"""What `mutations.py` changes: one place of a module at a time, in the way in which mistakes are made."""

from __future__ import annotations

import ast
import hashlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
#: What is changed, in `pyfrc_core`.
ROOMS = ("runtime", "hal", "processes", "deploy/agent")


@dataclass(frozen=True)
class Mutant:
    """One change: the text from `start` to `end` (bytes) of a file becomes `text`.

    :param statement: the line at which its statement begins
    :param scope: the function or class around it, such as ``Clock.run_until``; empty for the module
    """

    file: str
    line: int
    statement: int
    scope: str
    start: int
    end: int
    before: str
    text: str

    @property
    def lines(self) -> tuple[int, int]:
        """Its own line, which is not always executed as one, and that of its statement."""
        return self.line, self.statement

    def apply(self, source: bytes) -> bytes:
        return source[: self.start] + self.text.encode() + source[self.end :]

    def __str__(self) -> str:
        short = [" ".join(text.split())[:60] for text in (self.before, self.text)]
        return f"{self.file}:{self.line}  {short[0]}  =>  {short[1]}" if self.before else "(no change)"


_COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
_ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.FloorDiv,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.FloorDiv,
}
#: Assignments that say nothing about behaviour.
_NOT_BEHAVIOUR = {"__tracebackhide__", "__slots__", "__hash__"}


def changes_of(node: ast.AST) -> Iterator[ast.AST]:
    """What a node may become."""
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        for other in _COMPARISONS[type(node.ops[0])]:
            yield ast.Compare(node.left, [other()], node.comparators)
    elif isinstance(node, ast.BoolOp):
        yield ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield node.operand
    elif isinstance(node, ast.BinOp) and type(node.op) in _ARITHMETIC:
        yield ast.BinOp(node.left, _ARITHMETIC[type(node.op)](), node.right)
    elif isinstance(node, ast.Constant) and type(node.value) is bool:
        yield ast.Constant(not node.value)
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
        yield ast.Constant(node.value + 1)
        yield ast.Constant(node.value - 1)
    elif isinstance(node, ast.Call) and len(node.args) > 1 and not any(isinstance(a, ast.Starred) for a in node.args):
        yield ast.Call(node.func, [node.args[1], node.args[0], *node.args[2:]], node.keywords)
    elif isinstance(node, (ast.If, ast.While, ast.IfExp)):
        pass  # their conditions, below
    elif isinstance(node, ast.Return) and node.value is not None and not _is_none(node.value):
        yield ast.Return(ast.Constant(None))
    elif isinstance(node, (ast.Assign, ast.AugAssign, ast.Raise, ast.Delete, ast.Expr)):
        yield ast.Pass()


def mutants_of(file: str, source: bytes) -> Iterator[Mutant]:
    """All mutants of one file, in their order."""
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    tree = ast.parse(source)
    statements = {
        part: statement.lineno
        for statement in ast.walk(tree)  # which comes to inner statements later
        if isinstance(statement, ast.stmt)
        for part in ast.walk(statement)
    }

    scopes = {node: scope for scope, inner in _scopes(tree, "") for node in ast.walk(inner)}

    def mutant(node: ast.expr | ast.stmt, text: str) -> Mutant:
        start = starts[node.lineno - 1] + node.col_offset
        end = starts[(node.end_lineno or node.lineno) - 1] + (node.end_col_offset or 0)
        before = source[start:end].decode()
        if isinstance(node, ast.expr):
            text = f"({text}{_line_breaks(before, text)})"
        else:
            text += _line_breaks(before, text)
        return Mutant(file, node.lineno, statements[node], scopes[node], start, end, before, text)

    for node in _code(tree):
        if isinstance(node, (ast.If, ast.While, ast.IfExp)):
            yield mutant(node.test, f"not ({ast.unparse(node.test)})")
        for change in changes_of(node):
            yield mutant(node, ast.unparse(ast.fix_missing_locations(change)))  # type: ignore[arg-type]


def _scopes(node: ast.AST, name: str) -> Iterator[tuple[str, ast.AST]]:
    """The names of a tree's functions and classes, from the outermost to the innermost."""
    yield name, node
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            yield from _scopes(child, f"{name}.{child.name}".lstrip("."))
        elif isinstance(child, (ast.If, ast.Try, ast.With)):
            yield from _scopes(child, name)


def _line_breaks(before: str, text: str) -> str:
    """Return what keeps the numbers of the lines that follow."""
    return "\n" * (before.count("\n") - text.count("\n"))


def _code(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes that run, on Linux: no docstrings, annotations, imports for types, and no other systems' branches."""
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and not _is_left_out(child):
                yield child
                if isinstance(child, ast.If) and _is_of_another_system(child.test):
                    for other in child.orelse:
                        yield other
                        yield from _code(other)
                    continue
                yield from _code(child)


def _is_left_out(node: ast.AST) -> bool:
    if isinstance(node, ast.Expr):
        return isinstance(node.value, ast.Constant)
    if isinstance(node, ast.Assign):
        return isinstance(node.targets[0], ast.Name) and node.targets[0].id in _NOT_BEHAVIOUR
    if isinstance(node, ast.If):
        return isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
    return isinstance(node, ast.JoinedStr)  # the words of a message


def _is_of_another_system(test: ast.expr) -> bool:
    return ast.unparse(test) in ("sys.platform == 'win32'", "sys.platform == 'darwin'")


def _is_none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def draw(seed: int, count: int, only: str = "") -> list[Mutant]:
    """Return mutants in a random order, which the seed alone decides.

    A change of one function leaves those of others in their places: what is drawn does not depend on how many there
    are, nor on the numbers of lines.

    :param only: what the name of their file has in it
    """
    ranks: dict[bytes, Mutant] = {}
    for room in ROOMS:
        for file in sorted((REPOSITORY / "pyfrc_core" / room).rglob("*.py")):
            name = file.relative_to(REPOSITORY).as_posix()
            if only not in name:
                continue
            seen: Counter[str] = Counter()
            for mutant in mutants_of(name, file.read_bytes()):
                same = f"{name}|{mutant.scope}|{' '.join(mutant.before.split())}|{' '.join(mutant.text.split())}"
                seen[same] += 1
                ranks[hashlib.sha256(f"{seed}|{same}|{seen[same]}".encode()).digest()] = mutant
    return list(islice((ranks[rank] for rank in sorted(ranks) if _is_python(ranks[rank])), count))


def _is_python(mutant: Mutant) -> bool:
    """Return whether it can be compiled: a ``nonlocal`` wants the assignment that was removed."""
    try:
        compile(mutant.apply((REPOSITORY / mutant.file).read_bytes()), mutant.file, "exec", dont_inherit=True)
    except SyntaxError:
        return False
    return True
