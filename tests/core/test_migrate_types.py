"""Parts of `pyfrc migrate`, directly: what expressions can be, which names are bound where, and edits of a tree."""

from __future__ import annotations

from pathlib import Path

import pytest
from loops import for_each

pytest.importorskip("libcst")

import libcst as cst

from pyfrc_core.migrate.migration import migrate
from pyfrc_core.migrate.rewrite.edits import chain, fill, in_parentheses, standing_alone
from pyfrc_core.migrate.types.atoms import NOTHING, Many, Obj, Ref, dictionary, elements, items, many, of_type
from pyfrc_core.migrate.types.inference import Inference
from pyfrc_core.migrate.types.scopes import Module, import_source
from pyfrc_core.migrate.types.values import written_number
from pyfrc_core.season.names.table import table

ENCODER, TIMER = frozenset({Obj("wpilib.Encoder")}), frozenset({Obj("wpilib.Timer")})


def code_of(node: cst.CSTNode) -> str:
    return cst.Module([]).code_for_node(node)


def test_containers() -> None:
    of_both = dictionary(ENCODER, TIMER)
    assert (elements(of_both), items(of_both)) == (ENCODER, TIMER)  # a dictionary is iterated over by its keys
    assert (elements(many([ENCODER])), items(many([ENCODER]))) == (ENCODER, ENCODER)
    assert elements(ENCODER) == many([]) == dictionary(NOTHING, NOTHING) == NOTHING
    deep = ENCODER
    for _ in range(9):
        deep = many([deep])
    assert deep == NOTHING, "it has no end"


def test_types_as_the_table_writes_them() -> None:
    receiver = Obj("wpilib.Timer")
    assert of_type("", receiver) == NOTHING
    assert of_type("wpilib.Encoder", receiver) == ENCODER
    assert of_type("[wpilib.Encoder]", receiver) == {Many(ENCODER)}
    assert of_type("self", receiver) == TIMER
    assert of_type("self", receiver, values_only=True) == NOTHING
    assert of_type("self", Ref("wpilib.Timer")) == TIMER


def known(code: str) -> tuple[Inference, Module]:
    module = Module(Path("robot.py"), "robot", cst.parse_module(code))
    return Inference(table(), [module]), module


@for_each(
    "code, expected",
    [
        ("import wpilib\nx = wpilib.Encoder(0, 1)", "wpilib.Encoder"),
        ("from wpilib import Encoder as E\nx = [E(0, 1)][0]", "wpilib.Encoder"),
        ("import wpilib\nmade = {wpilib.Timer(): wpilib.Encoder(0, 1)}\nfor x in made: pass", "wpilib.Timer"),
        ("import wpilib\nmade = {1: wpilib.Encoder(0, 1)}\nfor _, x in made.items(): pass", "wpilib.Encoder"),
        ("import wpilib\ndef go(e, /, x=None): pass\ngo(1, wpilib.Timer())", ""),
        ("from wpimath.geometry import Rotation2d\nx = Rotation2d(1) * 2", "wpimath.geometry.Rotation2d"),
        ("import wpimath\ndef made() -> wpimath.Rotation2d: ...\nx = made()", "wpimath.geometry.Rotation2d"),
        ("from wpilib import *\nx = Encoder(0, 1)", "wpilib.Encoder"),
        ("x = x", ""),
        ("class A:\n    y = 1\n    def go(self):\n        return y\nx = A().go()", ""),
    ],
)
def test_what_a_name_can_be(code: str, expected: str) -> None:
    inference, module = known(code)
    found = {each.path for each in inference.named("x", module.scope) if isinstance(each, Obj)}
    assert found == ({expected} if expected else set())


def test_a_number_that_is_given_to_a_name_once() -> None:
    inference, module = known("A = 3\nB = 4\nB = 5\nclass C:\n    D = 6\n")
    numbers = [written_number(inference, cst.parse_expression(each), module.scope) for each in ("7", "A", "B", "C.D")]
    assert numbers == [7, 3, None, 6]


@for_each("code, expected", [("a", "a"), ("a.b()", "a.b()"), ("a + b", "(a + b)"), ("(a + b)", "(a + b)")])
def test_parentheses_where_an_operator_follows(code: str, expected: str) -> None:
    assert code_of(in_parentheses(cst.parse_expression(code))) == expected


def test_templates_are_filled() -> None:
    parts = {"0": cst.parse_expression("a + b"), "self": cst.parse_expression("c or d")}
    assert code_of(fill("int(1800 * {0})", parts)) == "int(1800 * (a + b))"
    assert code_of(fill("{self}.set({0})", parts)) == "(c or d).set(a + b)"
    call = cst.ensure_type(cst.parse_expression("f(1, b=2)"), cst.Call)
    assert code_of(fill("g.log({args})", {}, call)) == "g.log(1, b=2)"
    assert code_of(chain("a.b.c")) == "a.b.c"


def test_an_expression_of_several_lines_gets_parentheses() -> None:
    broken = cst.ensure_type(cst.parse_expression("(a\n  .b)"), cst.Attribute).with_changes(lpar=[], rpar=[])
    assert code_of(standing_alone(broken)) == "(a\n  .b)"
    assert code_of(standing_alone(cst.parse_expression("f(\n1)"))) == "f(\n1)"


def test_an_import_with_a_comment_is_not_joined_with_another(tmp_path: Path) -> None:
    before = "from wpimath.geometry import Pose2d  # where\nfrom wpimath.kinematics import ChassisSpeeds\n"
    (tmp_path / "robot.py").write_text(before + "print(Pose2d(), ChassisSpeeds())\n", "utf-8")
    migrate(tmp_path).write()
    assert (tmp_path / "robot.py").read_text("utf-8").splitlines()[:2] == [
        "from wpimath import Pose2d  # where",
        "from wpimath import ChassisVelocities",
    ]


def test_names_that_are_each_other_have_no_cause_without_end(tmp_path: Path) -> None:
    (tmp_path / "robot.py").write_text("def go(a):\n    b = a\n    c = b\n    b = c\n    c.getRate()\n", "utf-8")
    (remark,) = migrate(tmp_path).report.by_hand()
    assert remark.what.startswith("What a is, a parameter of go (robot.py:1), is not known")
    (tmp_path / "robot.py").write_text("b = 1\nc = b\nb = c\nc.getRate()\n", "utf-8")
    assert migrate(tmp_path).report.by_hand() == []


def test_an_encoding_that_is_named_in_lines_that_end_in_cr(tmp_path: Path) -> None:
    (tmp_path / "robot.py").write_bytes(b"# coding: cp1252\rimport wpilib.drive\rname = '\xe9'")
    done = migrate(tmp_path)
    assert (done.after["robot.py"], done.report.by_hand()) == (b"# coding: cp1252\rimport wpilib\rname = '\xe9'", [])


@for_each(
    "code, name, file, expected",
    [
        ("from wpimath.geometry._geometry import Pose2d", "robot", "robot.py", "wpimath.geometry"),
        ("from own._parts import Arm", "robot", "robot.py", "own._parts"),
        ("from .parts import Arm", "robot", "robot.py", "parts"),
        ("from .parts import Arm", "a.b.c", "c.py", "a.b.parts"),
        ("from ..parts.arm import Arm", "a.b.c", "c.py", "a.parts.arm"),
        ("from . import Arm", "a.b.c", "c.py", "a.b"),
        ("from . import Arm", "a.b", "__init__.py", "a.b"),
        ("from .. import Arm", "a.b", "__init__.py", "a"),
        ("from .arm import Arm", "a.b", "__init__.py", "a.b.arm"),
    ],
)
def test_the_module_that_an_import_names(code: str, name: str, file: str, expected: str) -> None:
    tree = cst.parse_module(code)
    statement = cst.ensure_type(tree.body[0], cst.SimpleStatementLine).body[0]
    assert import_source(cst.ensure_type(statement, cst.ImportFrom), Module(Path(file), name, tree)) == expected
