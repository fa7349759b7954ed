"""The places in the functions of a file that `mutants.py` can change, and what they become."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from typing import NamedTuple

#: Operators, and what they become.
OTHER: dict[type[ast.AST], tuple[str, str]] = {
    ast.Lt: ("<", "<="), ast.LtE: ("<=", "<"), ast.Gt: (">", ">="), ast.GtE: (">=", ">"), ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="), ast.Is: ("is", "is not"), ast.IsNot: ("is not", "is"), ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"), ast.And: ("and", "or"), ast.Or: ("or", "and"), ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*"), ast.FloorDiv: ("//", "/"), ast.Mod: ("%", "*"),
    ast.BitOr: ("|", "&"), ast.BitAnd: ("&", "|"),
}  # fmt: skip


class Mutant(NamedTuple):
    """One change: in a file, the bytes from `start` to `end` become others.

    :param statement: the first line of the statement around it
    """

    file: str
    function: str
    kind: str
    line: int
    statement: int
    start: int
    end: int
    old: str
    new: str

    def __str__(self) -> str:
        old, new = (" ".join(each.split()) for each in (self.old, self.new))
        return f"{self.file}:{self.line} {self.function}, {self.kind}: {old} -> {new}"


def mutants_of(file: str, source: bytes) -> Iterator[Mutant]:
    """Yield every mutant of the functions of a file with this content."""
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def place(node: ast.expr | ast.stmt) -> tuple[int, int]:
        start, end = starts[node.lineno - 1] + node.col_offset, starts[(node.end_lineno or 0) - 1]
        return start, end + (node.end_col_offset or 0)

    def changes(node: ast.AST) -> Iterator[tuple[str, int, int, int, str]]:
        match node:
            case ast.Compare(left, [operator], [right]) | ast.BinOp(left, operator, right):
                yield from operators(left, operator, right)
            case ast.BoolOp(operator, [left, right, *_]):
                yield from operators(left, operator, right)
            case ast.Constant(bool(value)):
                yield "constant", node.lineno, *place(node), str(not value)
            case ast.Constant(int(value) | float(value)):
                yield "constant", node.lineno, *place(node), repr(value + 1)
            case ast.Constant(str(value)) if value and not re.search(r"\s", value):
                yield "constant", node.lineno, *place(node), repr(f"{value}X")
            case ast.If(test) | ast.While(test) | ast.IfExp(test) | ast.comprehension(ifs=[test, *_]):
                start, end = place(test)
                yield "condition", test.lineno, start, end, f"(not ({source[start:end].decode()}))"
            case ast.Return(ast.expr() as value) if not (isinstance(value, ast.Constant) and value.value is None):
                yield "return", node.lineno, *place(value), "None"
            case ast.Expr(ast.Call() | ast.Await()):
                yield "call", node.lineno, *place(node), "pass"

    def operators(left: ast.expr, operator: ast.AST, right: ast.expr) -> Iterator[tuple[str, int, int, int, str]]:
        if type(operator) in OTHER:
            old, new = OTHER[type(operator)]
            start, end = place(left)[1], place(right)[0]
            pattern = r"\s+".join(map(re.escape, old.split()))
            changed = re.sub(pattern, new, source[start:end].decode(), count=1)
            yield "operator", left.end_lineno or 0, start, end, changed

    def visit(node: ast.AST, names: tuple[str, ...], is_in_function: bool, statement: int) -> Iterator[Mutant]:
        # Texts for people and for type checkers, and what no test can call.
        is_type_checking = isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        is_text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        if is_type_checking or is_text or isinstance(node, ast.Assert | ast.Raise | ast.JoinedStr):
            return
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            for each in node.body:
                is_method = not isinstance(node, ast.ClassDef)
                yield from visit(each, (*names, node.name), is_in_function or is_method, each.lineno)
            return
        statement = node.lineno if isinstance(node, ast.stmt) else statement
        if is_in_function:
            for kind, line, start, end, new in changes(node):
                old = source[start:end].decode()
                yield Mutant(file, ".".join(names), kind, line, statement, start, end, old, new)
        for name, value in ast.iter_fields(node):
            for each in value if isinstance(value, list) else [value]:
                if isinstance(each, ast.AST) and name != "annotation":
                    yield from visit(each, names, is_in_function, statement)

    for node in ast.parse(source).body:
        yield from visit(node, (), False, 0)
