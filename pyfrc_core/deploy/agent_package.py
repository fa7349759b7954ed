"""The agent's modules, and the program that loads them on the robot."""

from __future__ import annotations

import json
import zlib
from functools import cache
from pathlib import Path

from .agent import wire

# The only program in the command line. It reads the agent's modules from standard input and calls `main`.
_BOOTSTRAP = """
import json,sys,types,zlib
if sys.version_info<(3,9):sys.exit("Python "+".".join(map(str,sys.version_info[:2]))+" is too old")
r=open(0,"rb",0)
def g(n):
 b=b""
 while len(b)<n:
  c=r.read(n-len(b))
  if not c:sys.exit("the agent has not arrived")
  b+=c
 return b
for n,s in json.loads(zlib.decompress(g(int(g(8))))):
 t=sys.modules[n]=types.ModuleType(n)
 t.__package__="pyfrc_core.deploy.agent"
 exec(compile(s,n,"exec"),t.__dict__)
t.main(r)
"""
#: In the order of their imports. The bootstrap calls `main` of the last one.
_MODULES = (
    "__init__",
    "system",
    "wire",
    "disk",
    "imports",
    "layout",
    "robot_paths",
    "release_record",
    "virtual",
    "inventory",
    "activity",
    "carrying",
    "releases",
    "compiling",
    "content_index",
    "transaction",
    "console",
    "start_monitor",
    "host",
    "program",
    "serve",
)


def agent_command(python: str) -> str:
    """Return the command that loads the agent.

    :param python: the path of the robot's Python
    """
    return f"{python} -X utf8 -u -c '{_BOOTSTRAP}'"


@cache
def agent_package() -> bytes:
    """Return the agent's modules in the format that the bootstrap reads."""
    package = wire.__name__.rpartition(".")[0]
    directory = Path(wire.__file__).parent
    names = {each: package if each == "__init__" else f"{package}.{each}" for each in _MODULES}
    modules = [[name, (directory / f"{each}.py").read_text("utf-8")] for each, name in names.items()]
    packed = zlib.compress(json.dumps(modules).encode())
    return b"%08d" % len(packed) + packed
