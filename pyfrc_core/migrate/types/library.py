"""What Python's own functions, methods, annotations and operators do with the types of what they get."""

from __future__ import annotations

import libcst as cst

#: What an annotation puts around one type, or several.
SINGLE = {"Optional", "Union", "Final", "ClassVar", "Annotated", "Type", "type"}
#: Functions that give what is in their arguments.
SAME = {
    "list",
    "tuple",
    "set",
    "sorted",
    "reversed",
    "iter",
    "frozenset",
    "zip",
    "enumerate",
    "filter",
    "deepcopy",
    "copy",
}
#: Methods of a dictionary that give what is in it, one by one.
ITEMS = {"values", "items", "copy"}
#: Methods of a container that give one thing of it.
ITEM = {"get", "pop", "setdefault", "popleft"}

#: The methods of operators.
OPERATORS: dict[type[cst.CSTNode], str] = {
    cst.Add: "__add__",
    cst.Subtract: "__sub__",
    cst.Multiply: "__mul__",
    cst.Divide: "__truediv__",
    cst.BitAnd: "__and__",
    cst.BitOr: "__or__",
}
#: Methods that put their last argument into a container.
PUTS = {"add", "append", "appendleft", "insert", "setdefault"}
