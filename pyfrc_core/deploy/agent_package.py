"""The agent's modules, and the program that loads them on the robot."""

from __future__ import annotations

import hashlib
import json
import re
import zlib
from functools import cache
from pathlib import Path

from .agent import wire
from .agent_stream import PYTHON

# The only program in the command line. It reads the hash of the agent's sources, and loads their code from the file in
# which an earlier agent has kept it (`agent.kept`). Without such a file, or if it is invalid, of another Python, or not
# this user's alone, it requests the sources. In both cases it reads the first message before it calls `main`.
_BOOTSTRAP = """
import hashlib,json,marshal,os,sys,types,zlib
if sys.version_info<(3,9):sys.exit("Python "+".".join(map(str,sys.version_info[:2]))+" is too old")
from importlib.util import MAGIC_NUMBER
r=open(0,"rb",0)
def g(n):
 b=b""
 while len(b)<n:
  c=r.read(n-len(b))
  if not c:sys.exit("the agent has not arrived")
  b+=c
 return b
h=g(64)+MAGIC_NUMBER
l=None
try:
 with open(os.open("/home/lvuser/.pyfrc/agent",os.O_RDONLY|os.O_NOFOLLOW|os.O_NONBLOCK),"rb") as f:
  s=os.fstat(f.fileno())
  if s.st_uid==os.geteuid() and s.st_mode&0o170022==0o100000:
   b=f.read(1<<20)
   if b[:32]==hashlib.sha256(b[32:]).digest() and b[32:100]==h:l=marshal.loads(b[100:])
except Exception:pass
if l is None:
 b=zlib.compress(json.dumps(dict(need="agent")).encode())
 os.write(1,len(b).to_bytes(4,"big")+b"J"+b)
 m=g(int(g(8)))
 l=[(n,compile(s,n,"exec")) for n,s in json.loads(zlib.decompress(g(int(g(8)))))]
 k=h+marshal.dumps(l)
else:
 m=k=b""
for n,c in l:
 t=sys.modules[n]=types.ModuleType(n)
 t.__package__="pyfrc_core.deploy.agent"
 exec(c,t.__dict__)
t.main(r,m or g(int(g(8))),k)
"""
COMMAND = f"{PYTHON} -X utf8 -u -c '{_BOOTSTRAP}'"
#: In the order of their imports. The bootstrap calls `main` of the last one.
_MODULES = (
    "__init__",
    "system",
    "wire",
    "disk",
    "imports",
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
    "kept",
    "start_monitor",
    "host",
    "program",
    "serve",
)
_DOCSTRING = re.compile(r'^( *)""".*?"""$', re.MULTILINE | re.DOTALL)
_COMMENT = re.compile(r"(?:^ *|  )#[: ].*", re.MULTILINE)
_INDENTATION = re.compile(r"^ +", re.MULTILINE)


@cache
def agent_hash() -> bytes:
    """Return the SHA-256 of the agent's sources in hexadecimal, which is faster than packing them."""
    digest = hashlib.sha256()
    for name in _MODULES:
        source = _source_of(name)
        digest.update(b"%s %d\n" % (name.encode(), len(source)) + source)
    return digest.hexdigest().encode()


@cache
def agent_package() -> bytes:
    """Return the agent's modules in the format that the bootstrap reads."""
    package = wire.__name__.rpartition(".")[0]
    names = {each: package if each == "__init__" else f"{package}.{each}" for each in _MODULES}
    modules = [[name, _minified(_source_of(each).decode())] for each, name in names.items()]
    packed = zlib.compress(json.dumps(modules).encode(), 9)
    return b"%08d" % len(packed) + packed


def _minified(source: str) -> str:
    """Return a module's source without docstrings and comments, and with one space for each level of indentation.

    This saves time on a slow link. Lines keep their numbers for tracebacks. Regular expressions are used because
    `ast.unparse` takes 0.1 s for the agent. They rely on a property of the agent's modules: only a docstring begins a
    line with three quotes.
    """
    source = _DOCSTRING.sub(lambda found: f'{found[1]}""' + "\n" * found[0].count("\n"), source)
    source = _COMMENT.sub("", source)
    return _INDENTATION.sub(lambda found: " " * (len(found[0]) // 4), source)


def _source_of(module: str) -> bytes:
    return Path(wire.__file__).with_name(f"{module}.py").read_bytes()
