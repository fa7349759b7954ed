"""Projects of odd style: names of the team's own stay, the code stays valid, a second run changes nothing."""

from __future__ import annotations

import ast
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

pytest.importorskip("libcst")

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pyfrc_core.migrate.migration import migrate

#: Ways to import, and what they call an encoder, a motor, and a rotation: a class each.
IMPORTS = [
    ("import wpilib\nimport wpimath.geometry", "wpilib.Encoder", "wpilib.PWMSparkMax", "wpimath.geometry.Rotation2d"),
    ("import wpilib as w, wpimath.geometry as g", "w.Encoder", "w.PWMSparkMax", "g.Rotation2d"),
    ("from wpilib import *\nfrom wpimath.geometry import *", "Encoder", "PWMSparkMax", "Rotation2d"),
    (
        "from wpilib import (\n    Encoder as E,  # counts\n    PWMSparkMax,\n)\nfrom wpimath import geometry",
        "E",
        "PWMSparkMax",
        "geometry.Rotation2d",
    ),
    (
        "try:\n    import wpilib\nexcept ImportError:\n    wpilib = None\nfrom wpimath.geometry import Rotation2d as R",
        "wpilib.Encoder",
        "wpilib.PWMSparkMax",
        "R",
    ),
    (
        "import os; import wpilib; from wpimath.geometry import Rotation2d",
        "wpilib.Encoder",
        "wpilib.PWMSparkMax",
        "Rotation2d",
    ),
]

#: Code of the team's own with WPILib's names, which must be found again line by line.
OWN = [
    "class Mine{n}:\n    def getRate(self): return 1\n    isFinished = property(getRate)\n    kRed = {{}}.get('kRed')",
    "def arcadeDrive{n}(xSpeed, *, zRotation=0):\n    getDistance = lambda getInstance: getInstance\n"
    "    return getDistance(xSpeed) + zRotation",
    "table{n} = {{'getRate': 1, 'set': 2}}\ntable{n}.get('getRate')\nlist(map(str, table{n}.values()))",
    "async def wait{n}(other):\n    async with other as getRate:\n        return [x.isEnabled async for x in getRate]",
    "own{n}: 'dict[str, int]' = dict(getRate=1)\nprint(f\"{{own{n}['getRate']!r:>{{10}}}} {{'nested'}}\")",
    "if (teleopPeriodic{n} := len('getRate')) > 3 and not teleopPeriodic{n} < 2: pass",
    "@staticmethod\ndef isTest{n}(): # type: () -> bool\n    return bool(\n        0\n    )",
    "match{n} = [*range(3), *(getRate for getRate in range(2))][::-1]; del match{n}",
    "def walk{n}(node):\n    node.name, node.parent.set = 1, 2\n    setattr(node, 'get' + 'R', 0)\n    yield from node",
    "class Meta{n}(type):\n    def __getattr__(cls, name):\n        return getattr(super(), name.upper())",
]

#: Code with WPILib's objects: what it is, and a line that it must contain afterwards.
THEIRS = [
    ("left{n} = {encoder}(0, 1)\nprint(left{n}.getRate())", "print(left{n}.get_rate())"),
    ("motor{n} = {motor}({n})\nmotor{n}.set(1)", "motor{n}.set_throttle(1)"),
    ("turn{n} = {rotation}.fromDegrees(90) + {rotation}()\nturn{n}.rotateBy(turn{n})", "turn{n}.rotate_by(turn{n})"),
    (
        "class Arm{n}:\n    def __init__(self, encoder: '{encoder} | None' = None):\n        self._e = encoder\n"
        "    @property\n    def far(self):\n        return self._e.getDistance() if self._e else 0",
        "return self._e.get_distance() if self._e else 0",
    ),
    (
        "pairs{n} = [({encoder}(k, k + 1), str(k)) for k in range(2)]\nfor each, _ in pairs{n}:\n    each.setMinRate",
        "for each, _ in pairs{n}:",
    ),
    ('print(f"{{{encoder}(4, 5).getDistance():.1f}}")', ".get_distance():.1f"),
]

blocks = st.lists(st.one_of(st.sampled_from(OWN), st.sampled_from(THEIRS)), min_size=1, max_size=8)


files = given(st.sampled_from(IMPORTS), blocks, st.sampled_from(["\n", "\r\n"]), st.sampled_from(["    ", "\t", "  "]))


def examples(count: int) -> settings:
    return settings(max_examples=count, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)


@examples(20)
@files
def test_odd_styles(
    style: tuple[str, str, str, str], parts: list[str | tuple[str, str]], newline: str, indent: str
) -> None:
    check_style(style, parts, newline, indent)


@pytest.mark.slow
@examples(200)
@files
def test_many_odd_styles(
    style: tuple[str, str, str, str], parts: list[str | tuple[str, str]], newline: str, indent: str
) -> None:
    check_style(style, parts, newline, indent)


def check_style(
    style: tuple[str, str, str, str], parts: list[str | tuple[str, str]], newline: str, indent: str
) -> None:
    imports, encoder, motor, rotation = style
    code, wanted = [imports], []
    for number, part in enumerate(parts):
        names = {"n": number, "encoder": encoder, "motor": motor, "rotation": rotation}
        text = part if isinstance(part, str) else part[0]
        block = text.format(**names)
        code.append(block)
        wanted += block.splitlines() if isinstance(part, str) else [part[1].format(**names)]

    def spaced(text: str) -> str:
        return text.replace("    ", indent)

    source = spaced("\n".join(code) + "\n")
    ast.parse(source)
    with TemporaryDirectory() as directory:
        file = Path(directory) / "robot.py"
        file.write_bytes(source.replace("\n", newline).encode())
        migrate(Path(directory)).write()
        after = file.read_bytes().decode()
        assert not migrate(Path(directory)).after
    ast.parse(after)
    assert after.count("\r") == (after.count("\n") if newline == "\r\n" else 0)
    lines = after.split(newline)
    for line in wanted:
        assert any(spaced(line) in each for each in lines), f"{line!r} is not in\n{after}"
