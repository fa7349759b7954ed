"""Projects of odd Python, which `pyfrc migrate` must survive: made of pieces by a seed."""

from __future__ import annotations

import random
from pathlib import Path

# ruff: noqa: E501, RUF001 - one odd project is one line

#: Code that names the other modules of its project: circles of imports, of types and of values.
CIRCLES = [
    "from {a} import thing\nfrom {b} import other\nthing.getRate()\n",
    "from {a} import *\nfrom {b} import *\nthing.setDistancePerPulse(1)\n",
    "import {a}, {b}\nthing = {a}.thing\nother = {b}.other.thing.getRate\n",
    "from {a} import thing as other\nthing = other\nclass Part(other):\n    def getRate(self): return thing.getRate()\n",
    "import {a} as {b}\nfrom {a} import {b}\nfrom {b} import {a}\n",
    "from {a} import Alias\nfrom typing import Union\nAlias = Union[Alias, 'Alias', 'Other']\nOther = 'Alias'\n"
    "def show(one: Alias, two: 'Other') -> 'Alias':\n    return one.getRate()\n",
    "class A:\n    def __init__(self, b: 'B'): self.b = b\nclass B(A):\n    def b(self): return self.b.b.getRate()\n",
    "one = [two]\ntwo = {{1: one, **three}}\nthree = [one, two, *three]\nfor one in three: two = one\n",
    "def odd(n): return even(n)\ndef even(n): return odd(n - 1).getRate() if n else wpilib.Encoder(0, 1)\n",
    "class A(A): pass\nclass B(C): pass\nclass C(B):\n    def isFinished(self): return super().isFinished()\n",
    "each = lambda each: each(each)\neach(each).set(1)\nlist(map(lambda m: m.set(0), [wpilib.Talon(0), each]))\n",
]
#: Code that is nested deeply, or long.
DEEP = [
    "total = {sum}\n",
    "text = {texts}\n",
    "far = wpilib{dots}.getRate()\n",
    "chain = wpilib.Encoder(0, 1){calls}\n",
    "deep = {open}wpilib.Encoder(0, 1).getRate(){close}\n",
    "if 0: pass\n{elifs}",
    "{nested}",
    "{chained}",
]
#: Code with WPILib's names in odd layouts.
LAYOUT = [
    "wpilib.SmartDashboard.putNumber(  # shown\n    'a', 1  # one\n)\n",
    "now = (wpilib  # the library\n    .RobotController  # the class\n    .getFPGATime())\n",
    "now = wpilib.RobotController.getFPGATime; then = now(); print(then); import wpilib.drive as d\n",
    "speed = max(\n    wpilib.XboxController(0)\n    .getRawButton(\n        1\n    ), 0)\n",
    "from wpimath import (\n    applyDeadband,  # of sticks\n    units\n)\nx = applyDeadband(wpilib.XboxController(0)\n    .getLeftY(), 0.1)\n",
    "class Robot(wpilib.TimedRobot):\n    def robotInit(self): pass  # nothing\n    def teleopPeriodic(self): ...\n",
    "class Robot2(wpilib.TimedRobot):\n    def __init__(self): super().__init__(); self.x = 1\n"
    "    def robotInit(self):\n        # later\n        pass\n\n    @property\n    def getRate(self): return 1\n",
    "if True: import wpilib.shuffleboard, wpimath.geometry as geometry; print(geometry.Pose2d())\n",
    "try:\n    from wpilib import Relay, DriverStation as DS\nexcept* ImportError:\n    pass\nprint(DS.isEnabled())\n",
    "def f(a, /, b: 'wpilib.Encoder' = None, *c: wpilib.Talon, d=lambda m: m.get(), **e) -> 'list[wpilib.Encoder]':\n"
    "    global g; g = b\n    del a\n    return [b.getRate(), *(m.get() for m in c), d(*c), e['x'].set(1)]\n",
    "match wpilib.Encoder(0, 1):\n    case wpilib.Encoder(getRate=rate) as e if e.getRate(): print(e.getRate(), rate)\n    case _: pass\n",
    "print(f'{{wpilib.Encoder(0, 1).getRate()!r:>{{10}}}} {{{{}}}} {{(lambda: 1)()}}')\n",
    "async def go(self, e=wpilib.Encoder(0, 1)):\n    async with e as f, e as g: await f.getRate()\n    async for h in g: yield h\n",
    "e = wpilib.Encoder(0, 1); e.getRate() if (n := e.getDistance()) else e.reset(); x = not n; assert e, n\n",
    "with (open('a') as a, open('b') as b): wpilib.Encoder(*a, **{{'reverseDirection': b}}).getRate()\n",
    "\x0cdef page():\n\x0c    return wpilib.Encoder(0, 1).getRate() \\\n        + 1\n",
    "class Meta(type):\n    getRate: int\n    def __new__(cls, *a, **k): setattr(cls, 'set', a); return super().__new__(cls, *a, **k)\n",
    "wpilib = wpilib\nwpilib: wpilib = wpilib\nfor wpilib in [wpilib]: wpilib.Encoder(0, 1).getRate()\n",
    "pad = wpilib.XboxController(0)\nfor b in range(9): pad.getRawButton(b); pad.getRawButton(-b + 1 if b else 2)\n",
    "from unittest.mock import patch\nwith patch.object(wpilib.Encoder, 'getRate'), patch('wpilib.Encoder.getRate'): pass\n",
    "ä = wpilib.Encoder(0, 1)\nä.getRate()  # é €\nprint('𝕏', b'\\xff', r'\\d', '\\N{{BULLET}}')\n",
    "@wpilib.Encoder(0, 1).getRate\n@(lambda f: f)\ndef decorated(): return decorated.getRate\n",
    "self = wpilib.Encoder(0, 1)\ndef x(): return self.getRate() if self else (yield)\n(a, *b), c = [self, self], self; b[0].getRate()\n",
    "",
    "# only a comment",
]


def _values(rng: random.Random) -> dict[str, str]:
    count = rng.choice([3, 50, 900])
    few = min(count, 60)
    return {
        "sum": " + ".join(["wpilib.Encoder(0, 1).getRate()", *(["1"] * count)]),
        "texts": " ".join(["'getRate'"] * count),
        "dots": ".x" * min(count, 300),
        "calls": ".getRate()" * min(count, 90),
        "open": "(" * few,
        "close": ")" * few,
        "elifs": "".join(f"elif wpilib.Encoder(0, 1).getRate() > {each}: pass\n" for each in range(min(count, 300))),
        "nested": "".join(f"{'  ' * each}def f{each}(m=wpilib.Talon(0)):\n" for each in range(min(count, 18)))
        + "  " * min(count, 18)
        + "m.set(1)\n",
        "chained": "x0 = wpilib.Encoder(0, 1)\n"
        + "".join(f"x{each + 1} = x{each}\n" for each in range(count))
        + f"x{count}.getRate()\n",
    }


def make_project(root: Path, seed: int) -> None:
    """Write the odd project of a seed."""
    rng = random.Random(seed)
    modules = rng.sample(["a", "b", "pkg", "pkg.c", "pkg.inner.d", "telemetry", "robot"], rng.randint(1, 6))
    for module in {*modules, "robot"}:
        parts = ["import wpilib"]
        for pieces, most in ((CIRCLES, 3), (DEEP, 1), (LAYOUT, 4)):
            for piece in rng.sample(pieces, rng.randint(0, most)):
                names = {"a": rng.choice(modules), "b": rng.choice(modules), **_values(rng)}
                if "import" in piece.split("{b}")[0][-12:] or " as {b}" in piece:
                    names |= {key: value.rpartition(".")[2] for key, value in names.items() if key in "ab"}
                parts.append(piece.format(**names))
        text = "\n".join(parts) + rng.choice(["", "\n", "\n\n\n"])
        newline = rng.choice(["\n", "\n", "\r\n", "\r"])
        encoding = rng.choice(["utf-8", "utf-8", "utf-8-sig", "utf-16", "cp1252"])
        if encoding == "cp1252":
            cookie = rng.choice(["", "# -*- coding: cp1252 -*-\n", "# coding: nonsense\n"])
            text = cookie + text.encode("cp1252", "replace").decode("cp1252")
        is_package = any(each.startswith(f"{module}.") for each in modules)
        path = (
            root / module.replace(".", "/") / "__init__.py" if is_package else root / f"{module.replace('.', '/')}.py"
        )
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.replace("\n", newline).encode(encoding))
    (root / "note.ipynb").write_text('{"cells": ["import wpilib"]}')
    if rng.random() < 0.3:
        (root / "link").symlink_to(root if rng.random() < 0.5 else root.parent)
