"""Rewrite the lists of LEDs that patterns are applied to: `LEDPattern.apply_to` takes a buffer now."""

from __future__ import annotations

from collections.abc import Iterable

import libcst as cst

from ..types.atoms import Ref
from ..types.inference import Inference
from ..types.scopes import Module, Scope
from .edits import fill
from .file import FileRewriter

_LED = "wpilib.AddressableLED.LEDData"


def led_lists(inference: Inference, modules: Iterable[Module]) -> frozenset[cst.CSTNode]:
    """Return the lists of new LEDs in a project that applies patterns: `[LEDData() for _ in range(60)]`."""
    sites = [site for module in modules for site in module.sites]
    if not any(isinstance(node, cst.Attribute) and node.attr.value == "applyTo" for node, _ in sites):
        return frozenset()
    return frozenset(node for node, scope in sites if _led(inference, node, scope) is not None)


def rewrite_list(file: FileRewriter, node: cst.CSTNode, scope: Scope) -> None:
    """Make a buffer of a list of new LEDs."""
    led = _led(file.inference, node, scope)
    if led is None:
        return
    root = file.consume(led.func, scope)
    text = file.imports.fill_in("<wpilib.AddressableLEDBuffer>({0})", root, scope)

    def edit(updated: cst.ListComp | cst.BinaryOperation) -> cst.BaseExpression:
        length = updated.right if isinstance(updated, cst.BinaryOperation) else _range(updated)
        assert length is not None
        return fill(text, {"0": length})

    file.edit(node, edit)


def _led(inference: Inference, node: cst.CSTNode, scope: Scope) -> cst.Call | None:
    """Return the LED that a list is made of: `[LEDData() for _ in range(60)]`, or `[LEDData()] * 60`."""
    made: cst.CSTNode | None = None
    if isinstance(node, cst.ListComp) and _range(node) is not None:
        made = node.elt
        scope = scope.module.comprehensions.get(made, scope)
    elif isinstance(node, cst.BinaryOperation) and isinstance(node.operator, cst.Multiply):
        one = isinstance(node.left, cst.List) and len(node.left.elements) == 1
        made = cst.ensure_type(node.left, cst.List).elements[0].value if one else None
    if isinstance(made, cst.Call) and not made.args and Ref(_LED) in inference.infer(made.func, scope):
        return made
    return None


def _range(node: cst.ListComp) -> cst.BaseExpression | None:
    """Return how many a comprehension makes, if that is a plain `range`."""
    loop = node.for_in
    call = loop.iter
    plain = not loop.ifs and loop.inner_for_in is None
    if plain and isinstance(call, cst.Call) and len(call.args) == 1 and isinstance(call.func, cst.Name):
        return call.args[0].value if call.func.value == "range" else None
    return None
